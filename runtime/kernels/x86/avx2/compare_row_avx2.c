/* SPDX-License-Identifier: Apache-2.0 */
/* Residuals of a tile's row, sixteen pixels at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "lanes_avx2.h"

#define PIXELS 16

/* Loads sixteen bytes, or every second one of 31. */
static inline T3R_AVX2 lanes levels_of(const uint8_t *shown, uint32_t spread)
{
    const quad first = load_quad(shown);
    if (spread == 0) {
        return _mm256_cvtepu8_epi16(first);
    }
    const quad halves[2] = {_mm_and_si128(first, _mm_set1_epi16(255)), _mm_srli_epi16(load_quad(shown + 15), 8)};
    return joined(halves);
}

/* Returns (level gain + 2^6) / 2^7, at most 255 in Q7, from both halves of the product. A high half of 64 or more gives
 * at least 2^15, which fits 16 bits. */
static inline T3R_AVX2 lanes levelled(lanes level, lanes gain_q14)
{
    const lanes low = _mm256_mullo_epi16(level, gain_q14), high = _mm256_mulhi_epu16(level, gain_q14);
    const lanes rounded = _mm256_avg_epu16(_mm256_srli_epi16(low, 6), all(0));
    const lanes above = _mm256_slli_epi16(_mm256_min_epu16(high, _mm256_set1_epi16(64)), 9);
    return _mm256_min_epu16(_mm256_add_epi16(above, rounded), _mm256_set1_epi16(255 * 128));
}

T3R_AVX2 void t3r_compare_row_avx2(const uint8_t *restrict shown, uint32_t spread, uint16_t gain_q14,
                                   const uint16_t *restrict drawn_q7, uint32_t count, int16_t *restrict residual_q4)
{
    if (count != PIXELS) {
        t3r_compare_row_c(shown, spread, gain_q14, drawn_q7, count, residual_q4);
        return;
    }
    const lanes is = levelled(levels_of(shown, spread), _mm256_set1_epi16((int16_t)gain_q14));
    const lanes drawn = _mm256_min_epu16(load(drawn_q7), _mm256_set1_epi16(255 * 128));
    const lanes rounding = _mm256_add_epi16(_mm256_sub_epi16(is, drawn), _mm256_set1_epi16(4));
    store(residual_q4, _mm256_srai_epi16(rounding, 3));
}

#else
typedef int t3r_no_compare_row_avx2; /* a file may not be empty */
#endif
