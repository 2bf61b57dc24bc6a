/* Wavelet rows in plain C. Every sum fits 16 bits for the ranges that wavelet_level.h proves. */
#include "kernels/wavelet_rows.h"

#include "core/fixed.h"

void t3r_split_row_c(int16_t *restrict even, int16_t *restrict odd, const int16_t *restrict row, size_t count)
{
    for (size_t i = 0; i < count / 2; i++) {
        even[i] = row[2 * i];
        odd[i] = row[2 * i + 1];
    }
    if (count % 2 != 0) {
        even[count / 2] = row[count - 1];
    }
}

void t3r_luma_row_c(int16_t *restrict row, const uint8_t *restrict r, const uint8_t *restrict g,
                    const uint8_t *restrict b, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        /* at most 255 x 256 + 128: 16 bits */
        uint16_t sum = (uint16_t)(77 * r[i] + 150 * g[i] + 29 * b[i] + 128);
        row[i] = (int16_t)(((sum >> 8) - 128) * 16);
    }
}

static inline int16_t predicted(int16_t high, int16_t low)
{
    return (int16_t)(high - 2 * low + t3r_mulr_q15_small(low, T3R_DB2_PREDICT_Q15));
}

static inline int16_t updated(int16_t low, int16_t high, int16_t high_next)
{
    return (int16_t)(low + t3r_mulr_q15_small(high, T3R_DB2_UPDATE_Q15) -
                     t3r_mulr_q15_small(high_next, T3R_DB2_UPDATE_NEXT_Q15));
}

void t3r_db2_predict_c(int16_t *restrict high, const int16_t *restrict low, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        high[i] = predicted(high[i], low[i]);
    }
}

void t3r_db2_lift_c(int16_t *restrict low, int16_t *high, const int16_t *high_next,
                    const int16_t *restrict low_previous, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const int16_t before = high[i];
        low[i] = updated(low[i], before, high_next[i]);
        high[i] = (int16_t)(before + low_previous[i]);
    }
}

void t3r_db2_split_c(int16_t *restrict low, int16_t *restrict high, const int16_t *restrict row, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const int16_t first = row[2 * i];
        low[i] = first;
        high[i] = predicted(row[2 * i + 1], first);
    }
}

void t3r_db2_join_c(int16_t *restrict lows, int16_t *restrict highs, const int16_t *restrict low,
                    const int16_t *restrict high, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        lows[i + 1] = updated(low[i], high[i], high[i + 1]);
    }
    for (size_t i = 0; i < count; i++) {
        highs[i] = (int16_t)(high[i] + lows[i]);
    }
}

void t3r_subtract_row_c(int16_t *restrict high, const int16_t *restrict low, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        high[i] = (int16_t)(high[i] - low[i]);
    }
}

void t3r_haar_update_c(int16_t *restrict even, const int16_t *restrict odd, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        even[i] = (int16_t)(even[i] + t3r_round_shift32(odd[i], 1));
    }
}

void t3r_cdf53_predict_c(int16_t *restrict odd, const int16_t *even, const int16_t *even_next, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        odd[i] = (int16_t)(odd[i] - t3r_round_shift32(even[i] + even_next[i], 1));
    }
}

void t3r_cdf53_update_c(int16_t *restrict even, const int16_t *odd_previous, const int16_t *odd, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        even[i] = (int16_t)(even[i] + t3r_round_shift32(odd_previous[i] + odd[i], 2));
    }
}

static inline uint16_t absolute(int16_t x)
{
    return (uint16_t)(x < 0 ? -x : x);
}

void t3r_texture_finest_c(uint16_t *restrict texture, const int16_t *restrict h, const int16_t *restrict v,
                          const int16_t *restrict d, uint16_t d_gain_q16, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t product = (uint32_t)absolute(d[i]) * d_gain_q16;
        /* round-half-up of product / 2^16: see t3r_mulr_q15_small() */
        uint16_t high = (uint16_t)(product >> 16);
        uint16_t low = (uint16_t)product;
        texture[i] = (uint16_t)(absolute(h[i]) + absolute(v[i]) + high + (low >> 15));
    }
}

void t3r_texture_coarse_c(uint16_t *restrict texture, const int16_t *restrict h, const int16_t *restrict v,
                          const int16_t *restrict d, uint32_t gain_q8, uint32_t d_gain_q8, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        /* |h| + |v| < 2^14.4, |d| < 2^14.6 on levels above 1 (wavelet_texture.c); gains < 2^15.7 and 2^13.8: the
         * sum is below 2^31 */
        uint32_t sum = gain_q8 * (uint32_t)(absolute(h[i]) + absolute(v[i])) + d_gain_q8 * absolute(d[i]);
        texture[i] = (uint16_t)T3R_MIN((sum + 128) >> 8, 65535u);
    }
}

static inline uint16_t add_saturated(uint16_t a, uint16_t b)
{
    uint16_t room = (uint16_t)(65535u - b);
    return (uint16_t)(T3R_MIN(a, room) + b);
}

void t3r_texture_add_c(uint16_t *restrict fine, const uint16_t *restrict coarse, size_t count)
{
    for (size_t i = 0; i < count / 2; i++) {
        fine[2 * i] = add_saturated(fine[2 * i], coarse[i]);
        fine[2 * i + 1] = add_saturated(fine[2 * i + 1], coarse[i]);
    }
    if (count % 2 != 0) {
        fine[count - 1] = add_saturated(fine[count - 1], coarse[count / 2]);
    }
}

void t3r_texture_spread_c(uint16_t *restrict fine, const uint16_t *restrict coarse, size_t count)
{
    for (size_t i = 0; i < count / 2; i++) {
        fine[2 * i] = coarse[i];
        fine[2 * i + 1] = coarse[i];
    }
    if (count % 2 != 0) {
        fine[count - 1] = coarse[count / 2];
    }
}
