#include "blur.h"

#include "core/fixed.h"

/* 12 is half of 25: one rounding. 25 x 65535 fits 32 bits. */
static inline uint16_t blurred(uint32_t a, uint32_t b, uint32_t c, uint32_t d, uint32_t e)
{
    return (uint16_t)((a + 2 * b + 3 * c + 4 * d + 5 * e + 12) / 25);
}

static uint16_t blurred_at_end(const uint16_t *row, uint32_t x, uint32_t width)
{
    uint32_t sum = 12;
    for (int32_t tap = -T3R_BLUR_REACH; tap <= T3R_BLUR_REACH; tap++) {
        int32_t place = t3r_clamp32((int32_t)x + tap, 0, (int32_t)width - 1);
        sum += (uint32_t)(T3R_BLUR_REACH + 1 - t3r_abs32(tap)) * row[place];
    }
    return (uint16_t)(sum / 25);
}

void t3r_blur_column_c(const uint16_t *const rows[T3R_BLUR_TAPS], uint32_t width, uint16_t *restrict out)
{
    const uint16_t *r0 = rows[0], *r1 = rows[1], *r2 = rows[2], *r3 = rows[3], *r4 = rows[4];
    const uint16_t *r5 = rows[5], *r6 = rows[6], *r7 = rows[7], *r8 = rows[8];
    for (uint32_t x = 0; x < width; x++) {
        out[x] = blurred((uint32_t)r0[x] + r8[x], (uint32_t)r1[x] + r7[x], (uint32_t)r2[x] + r6[x],
                         (uint32_t)r3[x] + r5[x], r4[x]);
    }
}

void t3r_blur_row_c(const uint16_t *restrict row, uint32_t width, uint16_t *restrict out)
{
    const uint32_t end = T3R_MIN((uint32_t)T3R_BLUR_REACH, width), middle = width - T3R_MIN(2 * end, width);
    for (uint32_t x = 0; x < end; x++) {
        out[x] = blurred_at_end(row, x, width);
        out[width - 1 - x] = blurred_at_end(row, width - 1 - x, width);
    }
    const uint16_t *taps[T3R_BLUR_TAPS]; /* in the middle a row is nine columns that lie beside each other */
    for (uint32_t tap = 0; tap < T3R_BLUR_TAPS; tap++) {
        taps[tap] = row + T3R_MIN(tap, width - 1);
    }
    t3r_blur_column_c(taps, middle, out + end);
}
