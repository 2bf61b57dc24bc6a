/* SPDX-License-Identifier: Apache-2.0 */
#include "kernels/radix.h"

void t3r_radix_count_c(const uint32_t *restrict keys, uint32_t count, uint32_t histogram[T3R_RADIX_DIGITS * T3R_RADIX])
{
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t digit = 0; digit < T3R_RADIX_DIGITS; digit++) {
            histogram[digit * T3R_RADIX + ((keys[i] >> (8 * digit)) & 255)]++;
        }
    }
}

void t3r_radix_pass_c(const uint32_t *restrict keys, const uint32_t *restrict indices, uint32_t count, uint32_t digit,
                      uint32_t start[T3R_RADIX], uint32_t *restrict to_keys, uint32_t *restrict to_indices)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t key = keys[i];
        uint32_t place = start[(key >> (8 * digit)) & 255]++;
        to_keys[place] = key;
        to_indices[place] = indices[i];
    }
}
