/* SPDX-License-Identifier: Apache-2.0 */
#include "kernels/blur.h"

#include "core/fixed.h"

static inline uint32_t weight(int32_t tap)
{
    return (uint32_t)(T3R_BLUR_REACH + 1 - t3r_abs32(tap - T3R_BLUR_REACH));
}

/* 12 is half of 25: one rounding. 25 x 65535 fits 32 bits. */
static void blur_end(const uint16_t *row, int32_t from, int32_t to, int32_t width, uint16_t *out)
{
    for (int32_t x = from; x < to; x++) {
        uint32_t sum = 12;
        for (int32_t tap = 0; tap < T3R_BLUR_TAPS; tap++) {
            sum += weight(tap) * row[t3r_clamp32(x + tap - T3R_BLUR_REACH, 0, width - 1)];
        }
        out[x] = (uint16_t)(sum / 25);
    }
}

void t3r_blur_column_c(const uint16_t *const rows[T3R_BLUR_TAPS], uint32_t width, uint16_t *restrict out)
{
    for (uint32_t x = 0; x < width; x++) {
        uint32_t sum = 12;
        for (int32_t tap = 0; tap < T3R_BLUR_TAPS; tap++) {
            sum += weight(tap) * rows[tap][x];
        }
        out[x] = (uint16_t)(sum / 25);
    }
}

/* In the middle no sample is clamped: the nine rows are one row, each shifted by a sample. */
void t3r_blur_row_c(const uint16_t *restrict row, uint32_t width, uint16_t *restrict out)
{
    const int32_t last = (int32_t)width, from = T3R_MIN(T3R_BLUR_REACH, last),
                  to = T3R_MAX(from, last - T3R_BLUR_REACH);
    blur_end(row, 0, from, last, out);
    if (from < to) {
        const uint16_t *rows[T3R_BLUR_TAPS];
        for (uint32_t tap = 0; tap < T3R_BLUR_TAPS; tap++) {
            rows[tap] = row + tap;
        }
        t3r_blur_column_c(rows, (uint32_t)(to - from), out + from);
    }
    blur_end(row, to, last, last, out);
}
