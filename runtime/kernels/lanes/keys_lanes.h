/* SPDX-License-Identifier: Apache-2.0 */
/* Keys, LANES at a time, with the steps of keys.c. Included after a header of lanes, in a file that names the
 * functions WANTED_ROW and KEY_ROW. */
#ifndef T3R_KERNELS_LANES_KEYS_LANES_H
#define T3R_KERNELS_LANES_KEYS_LANES_H

#include "kernels/keys.h"
#include "kernels/lanes/vectors/logarithm_lanes.h"

T3R_LANES_TARGET void WANTED_ROW(const uint16_t *restrict texture_q4, uint32_t count, uint32_t gamma_q8,
                                 uint16_t *restrict wanted_q10)
{
    const lanes gamma = all((int32_t)gamma_q8), half = all(1 << 13);
    uint32_t i = 0;
    for (; i + LANES <= count; i += LANES) {
        const lanes log = log_q16(add(load_16(texture_q4 + i), all(T3R_TEXTURE_FLOOR_Q4)), 16);
        store_16(wanted_q10 + i, OF_LANES(srli_epi32)(add(multiply(log, gamma), half), 14));
    }
    t3r_wanted_row_c(texture_q4 + i, count - i, gamma_q8, wanted_q10 + i);
}

/* Returns t3r_mix32() of each lane. */
static inline T3R_LANES_TARGET lanes mixed(lanes x)
{
    x = multiply(different(x, OF_LANES(srli_epi32)(x, 16)), all(0x7feb352d));
    x = multiply(different(x, OF_LANES(srli_epi32)(x, 15)), all((int32_t)0x846ca68bu));
    return different(x, OF_LANES(srli_epi32)(x, 16));
}

T3R_LANES_TARGET void KEY_ROW(uint32_t place, uint32_t seed, const uint16_t *rank, const uint16_t *restrict wanted_q10,
                              uint32_t count, uint16_t *restrict key)
{
    static const int32_t numbers[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    const lanes number = load(numbers);
    uint32_t i = 0;
    for (; i + LANES <= count; i += LANES) {
        const lanes noise = mixed(different(number, all((int32_t)((place ^ i) ^ seed))));
        const lanes threshold = rank != NULL
                                    ? add(OF_LANES(slli_epi32)(load_16(rank + i), 4), OF_LANES(srli_epi32)(noise, 28))
                                    : OF_LANES(srli_epi32)(noise, 16);
        const lanes odd = add(add(threshold, threshold), all(1));
        const lanes log_q10 = OF_LANES(srli_epi32)(add(log_q16(odd, 16), all(32)), 6);
        const lanes difference_q10 = subtract(add(log_q10, all(T3R_KEY_ZERO - (17 << 10))), load_16(wanted_q10 + i));
        const lanes relative = OF_LANES(min_epi32)(OF_LANES(max_epi32)(difference_q10, all(16)), all(UINT16_MAX));
        const lanes is_sure = greater(all(T3R_SURE_THRESHOLD), threshold);
        store_16(key + i, chosen(is_sure, OF_LANES(srli_epi32)(threshold, 4), relative));
    }
    t3r_key_row_c(place ^ i, seed, rank != NULL ? rank + i : NULL, wanted_q10 + i, count - i, key + i);
}

#endif
