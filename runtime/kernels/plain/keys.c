/* SPDX-License-Identifier: Apache-2.0 */
#include "kernels/keys.h"

#include <stddef.h>

#include "core/logarithm.h"

void t3r_wanted_row_c(const uint16_t *restrict texture_q4, uint32_t count, uint32_t gamma_q8,
                      uint16_t *restrict wanted_q10)
{
    for (uint32_t i = 0; i < count; i++) {
        /* 17 x 2^16 x 2^9: below 2^30 */
        const int32_t log_q16 = t3r_log2_inline_q16(texture_q4[i] + T3R_TEXTURE_FLOOR_Q4);
        wanted_q10[i] = (uint16_t)(((uint32_t)log_q16 * gamma_q8 + (1u << 13)) >> 14);
    }
}

void t3r_key_row_c(uint32_t place, uint32_t seed, const uint16_t *rank, const uint16_t *restrict wanted_q10,
                   uint32_t count, uint16_t *restrict key)
{
    static const uint16_t none[T3R_KEY_RUN];
    const uint16_t *ranks = rank != NULL ? rank : none;
    const uint32_t shift = rank != NULL ? 28 : 16;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t threshold = ranks[i] * 16u + (t3r_mix32((place ^ i) ^ seed) >> shift);
        /* log2((2 t + 1) / 2^17) in [-17, 0] */
        const int32_t log_q10 = ((t3r_log2_inline_q16(2 * threshold + 1) + 32) >> 6) - (17 << 10);
        const int32_t relative = t3r_clamp32(T3R_KEY_ZERO + log_q10 - wanted_q10[i], 16, UINT16_MAX);
        key[i] =
            (uint16_t)(threshold < T3R_SURE_THRESHOLD ? threshold >> 4 : (uint32_t)relative); /* sure: at most 12 */
    }
}
