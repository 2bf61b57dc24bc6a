/* The lifting steps of the wavelets over rows of int16; plain C defines them. A row is a plane's row (vertical lifting)
 * or one half of a split row (horizontal lifting). Rows are aligned to 2 bytes and of any length; nothing beyond
 * `count` samples is read or written. Two inputs that are not `restrict` may be the same row or overlap. */
#ifndef T3R_WAVELET_ROWS_H
#define T3R_WAVELET_ROWS_H

#include <stddef.h>
#include <stdint.h>

/* Q15, all below one half: 2 - sqrt 3, sqrt 3 / 4, (2 - sqrt 3) / 4, (sqrt 3 - 1) / 2. */
#define T3R_DB2_PREDICT_Q15 8780
#define T3R_DB2_UPDATE_Q15 14189
#define T3R_DB2_UPDATE_NEXT_Q15 2195
#define T3R_DB2_UPDATE_PAIR_Q15 11994

/* Returns t3r_mulr_q15(a, c) for 0 <= c < 2^14, in 16-bit lanes: with 2 a c = high 2^16 + low, adding half and shifting
 * gives high plus the top bit of low. */
static inline int16_t t3r_mulr_q15_small(int16_t a, int16_t c)
{
    int16_t twice = (int16_t)(2 * c);
    int16_t high = (int16_t)(((int32_t)a * twice) >> 16);
    uint16_t low = (uint16_t)((uint32_t)(uint16_t)a * (uint32_t)(uint16_t)twice);
    return (int16_t)(high + (low >> 15));
}

/* Splits a row: even[i] = row[2 i], odd[i] = row[2 i + 1]; an odd count has one more even. */
typedef void t3r_split_row_kernel(int16_t *restrict even, int16_t *restrict odd, const int16_t *restrict row,
                                  size_t count);

/* Computes (luma - 128) x 16 of count pixels. */
typedef void t3r_luma_row_kernel(int16_t *restrict row, const uint8_t *restrict r, const uint8_t *restrict g,
                                 const uint8_t *restrict b, size_t count);

/* db2 down the rows, step 1: high -= sqrt(3) low, as 2 low - mulr(low, 2 - sqrt 3). */
typedef void t3r_db2_predict_kernel(int16_t *restrict high, const int16_t *restrict low, size_t count);
/* Step 2: low += mulr(high, sqrt 3 / 4) - mulr(next high, (2 - sqrt 3) / 4). Step 3: high += previous low, which is
 * none of the other rows. The next high may be the high itself. */
typedef void t3r_db2_lift_kernel(int16_t *restrict low, int16_t *high, const int16_t *high_next,
                                 const int16_t *restrict low_previous, size_t count);
/* db2 along a row, split_row and step 1: low[i] = row[2 i], high[i] = row[2 i + 1] less sqrt(3) low[i]. */
typedef void t3r_db2_split_kernel(int16_t *restrict low, int16_t *restrict high, const int16_t *restrict row,
                                  size_t count);
/* Steps 2 and 3: lows[i + 1] from low[i], high[i] and high[i + 1]; then highs[i] = high[i] + lows[i]. lows[0] is
 * given. */
typedef void t3r_db2_join_kernel(int16_t *restrict lows, int16_t *restrict highs, const int16_t *restrict low,
                                 const int16_t *restrict high, size_t count);
typedef void t3r_subtract_row_kernel(int16_t *restrict high, const int16_t *restrict low, size_t count);
/* db2, the first sample, which has no partner: x0 -= mulr(x1, 2 - sqrt 3). Rarely called, so not in the table, like the
 * next two. */
void t3r_row_db2_first(int16_t *restrict x0, const int16_t *restrict x1, size_t count);
/* db2, the last sample of an even length, which has no partner either: last += before_that - 2 before. */
void t3r_row_db2_last(int16_t *restrict last, const int16_t *restrict before, const int16_t *restrict before_that,
                      size_t count);
/* db2, a line of two samples: step 1; low += mulr(high, (sqrt 3 - 1) / 2); high += low. */
void t3r_row_db2_pair(int16_t *restrict low, int16_t *restrict high, size_t count);

/* Haar: odd -= even (subtract_row); even += (odd + 1) >> 1 */
typedef void t3r_haar_update_kernel(int16_t *restrict even, const int16_t *restrict odd, size_t count);

/* CDF 5/3: odd -= (even + next even + 1) >> 1; even += (previous odd + odd + 2) >> 2 */
typedef void t3r_cdf53_predict_kernel(int16_t *restrict odd, const int16_t *even, const int16_t *even_next,
                                      size_t count);
typedef void t3r_cdf53_update_kernel(int16_t *restrict even, const int16_t *odd_previous, const int16_t *odd,
                                     size_t count);

/* Computes the texture of a level-1 row: |h| + |v| + mulr(|d|, d_gain), Q4; the sum is below 2^15
 * (wavelet_texture.c). */
typedef void t3r_texture_finest_kernel(uint16_t *restrict texture, const int16_t *restrict h, const int16_t *restrict v,
                                       const int16_t *restrict d, uint16_t d_gain_q16, size_t count);
/* Computes the texture of a coarser level: (gain (|h| + |v|) + d_gain |d|) with Q8 gains, one rounding, at most
 * 65535. */
typedef void t3r_texture_coarse_kernel(uint16_t *restrict texture, const int16_t *restrict h, const int16_t *restrict v,
                                       const int16_t *restrict d, uint32_t gain_q8, uint32_t d_gain_q8, size_t count);
/* Computes fine[i] += coarse[i / 2], at most 65535. */
typedef void t3r_texture_add_kernel(uint16_t *restrict fine, const uint16_t *restrict coarse, size_t count);
/* Computes fine[i] = coarse[i / 2]. */
typedef void t3r_texture_spread_kernel(uint16_t *restrict fine, const uint16_t *restrict coarse, size_t count);

t3r_split_row_kernel t3r_split_row_c;
t3r_luma_row_kernel t3r_luma_row_c;
t3r_db2_predict_kernel t3r_db2_predict_c;
t3r_db2_lift_kernel t3r_db2_lift_c;
t3r_db2_split_kernel t3r_db2_split_c;
t3r_db2_join_kernel t3r_db2_join_c;
t3r_subtract_row_kernel t3r_subtract_row_c;
t3r_haar_update_kernel t3r_haar_update_c;
t3r_cdf53_predict_kernel t3r_cdf53_predict_c;
t3r_cdf53_update_kernel t3r_cdf53_update_c;
t3r_texture_finest_kernel t3r_texture_finest_c;
t3r_texture_coarse_kernel t3r_texture_coarse_c;
t3r_texture_add_kernel t3r_texture_add_c;
t3r_texture_spread_kernel t3r_texture_spread_c;

#endif
