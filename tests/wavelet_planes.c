/* SPDX-License-Identifier: Apache-2.0 */
#include "wavelet_planes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "kernels/wavelet_rows.h"
#include "wavelet/wavelet.h"
#include "wavelet/wavelet_level.h"

static void *allocated(size_t bytes)
{
    void *memory = malloc(bytes);
    if (memory == NULL) {
        fprintf(stderr, "out of memory\n");
        exit(EXIT_FAILURE);
    }
    return memory;
}

/* ---- forward ---------------------------------------------------------------------------------------------- */

static void order_rows(const t3r_level *level)
{
    size_t width = level->width;
    uint32_t lows = (level->height + 1) / 2;
    int16_t *ordered = allocated(width * level->height * sizeof *ordered);

    for (uint32_t y = 0; y < level->height; y++) {
        const int16_t *row = y < lows ? t3r_low_row(level, y) : t3r_high_row(level, y - lows);
        memcpy(ordered + y * width, row, width * sizeof *row);
    }
    for (uint32_t y = 0; y < level->height; y++) {
        memcpy(level->plane + y * level->stride, ordered + y * width, width * sizeof *ordered);
    }
    free(ordered);
}

void wavelet_forward(int16_t *plane, uint32_t width, uint32_t height, uint32_t levels, t3r_wavelet kind)
{
    int16_t *work = allocated(T3R_WAVELET_ROW_BYTES(width));

    for (uint32_t l = 0; l < levels; l++) {
        t3r_level level = t3r_level_of(plane, width, height, l, kind, work);
        level.kernels = &t3r_kernels_c;
        t3r_wavelet_level_forward(&level);
        order_rows(&level);
    }
    free(work);
}

/* ---- inverse: x has the lows, then the highs, and gets n samples; `line` has room for n ------------------- */

/* Computes t3r_mulr_q15() by its definition. */
static int32_t scaled(int16_t sample, int32_t factor_q15)
{
    return (sample * factor_q15 + (1 << 14)) >> 15;
}

static void inverse_db2_pair(int16_t x[2])
{
    int16_t d1 = (int16_t)(x[1] - x[0]);
    x[0] = (int16_t)(x[0] - scaled(d1, T3R_DB2_UPDATE_PAIR_Q15));
    x[1] = (int16_t)(d1 + 2 * x[0] - scaled(x[0], T3R_DB2_PREDICT_Q15));
}

static void inverse_db2(int16_t *x, uint32_t n, int16_t *line)
{
    uint32_t pairs = (n - 1) / 2;
    const int16_t *low = x, *high = x + (n + 1) / 2;

    for (uint32_t k = 1; k <= pairs; k++) {
        uint32_t next = T3R_MIN(k + 1, pairs);
        int16_t d1 = (int16_t)(high[k - 1] - low[k - 1]), d1_next = (int16_t)(high[next - 1] - low[next - 1]);
        int32_t update = scaled(d1, T3R_DB2_UPDATE_Q15) - scaled(d1_next, T3R_DB2_UPDATE_NEXT_Q15);
        line[2 * k - 1] = (int16_t)(low[k] - update);
        line[2 * k] = (int16_t)(d1 + 2 * line[2 * k - 1] - scaled(line[2 * k - 1], T3R_DB2_PREDICT_Q15));
    }
    line[0] = (int16_t)(low[0] + scaled(line[1], T3R_DB2_PREDICT_Q15));
    if (n % 2 == 0) {
        line[n - 1] = (int16_t)(high[pairs] + 2 * line[n - 2] - line[n - 3]);
    }
    memcpy(x, line, n * sizeof *x);
}

static void inverse_haar(int16_t *x, uint32_t n, int16_t *line)
{
    const int16_t *low = x, *high = x + (n + 1) / 2;

    for (uint32_t k = 0; k < n / 2; k++) {
        line[2 * k] = (int16_t)(low[k] - ((high[k] + 1) >> 1));
        line[2 * k + 1] = (int16_t)(high[k] + line[2 * k]);
    }
    if (n % 2 != 0) {
        line[n - 1] = low[n / 2];
    }
    memcpy(x, line, n * sizeof *x);
}

static void inverse_cdf53(int16_t *x, uint32_t n, int16_t *line)
{
    uint32_t lows = (n + 1) / 2, highs = n / 2;
    const int16_t *low = x, *high = x + lows;

    for (uint32_t k = 0; k < lows; k++) {
        int32_t before = high[k > 0 ? k - 1 : 0], behind = high[T3R_MIN(k, highs - 1)];
        line[2 * k] = (int16_t)(low[k] - ((before + behind + 2) >> 2));
    }
    for (uint32_t k = 0; k < highs; k++) {
        int32_t before = line[2 * k], behind = line[2 * T3R_MIN(k + 1, lows - 1)];
        line[2 * k + 1] = (int16_t)(high[k] + ((before + behind + 1) >> 1));
    }
    memcpy(x, line, n * sizeof *x);
}

static void inverse_line(int16_t *x, uint32_t n, t3r_wavelet kind, int16_t *line)
{
    if (n < 2) {
        return;
    }
    if (kind == T3R_WAVELET_HAAR) {
        inverse_haar(x, n, line);
    } else if (kind == T3R_WAVELET_CDF53) {
        inverse_cdf53(x, n, line);
    } else if (n == 2) {
        inverse_db2_pair(x);
    } else {
        inverse_db2(x, n, line);
    }
}

static void inverse_level(int16_t *plane, uint32_t stride, uint32_t width, uint32_t height, t3r_wavelet kind)
{
    int16_t *column = allocated(height * sizeof *column), *line = allocated((width + height) * sizeof *line);

    for (uint32_t x = 0; x < width; x++) {
        for (uint32_t y = 0; y < height; y++) {
            column[y] = plane[(size_t)y * stride + x];
        }
        inverse_line(column, height, kind, line);
        for (uint32_t y = 0; y < height; y++) {
            plane[(size_t)y * stride + x] = column[y];
        }
    }
    for (uint32_t y = 0; y < height; y++) {
        inverse_line(plane + (size_t)y * stride, width, kind, line);
    }
    free(column);
    free(line);
}

void wavelet_inverse(int16_t *plane, uint32_t width, uint32_t height, uint32_t levels, t3r_wavelet kind)
{
    for (uint32_t l = levels; l-- > 0;) {
        inverse_level(plane, width, t3r_halved(width, l), t3r_halved(height, l), kind);
    }
}

/* ---- images that wrap --------------------------------------------------------------------------------------- */

/* The image is repeated around itself by 8 coefficients of the coarsest level. A border reaches at most 4 coefficients
 * into any level: b of one level become (b + 3) / 2 + 1 of the next. So it does not affect the inside. */
void wavelet_texture_wrapped(const uint8_t *const colour[3], uint32_t width, uint32_t height, uint32_t levels,
                             t3r_wavelet kind, uint16_t *texture_q4)
{
    uint32_t around = 8u << levels, wide = width + 2 * around, high = height + 2 * around;
    size_t pixels = (size_t)wide * high;
    uint8_t *repeated = allocated(3 * pixels);
    int16_t *plane = allocated(pixels * sizeof *plane), *work = allocated(T3R_WAVELET_ROW_BYTES(wide));
    uint16_t *texture = allocated(pixels * sizeof *texture);
    const uint8_t *const planes[3] = {repeated, repeated + pixels, repeated + 2 * pixels};

    for (uint32_t y = 0; y < high; y++) {
        for (uint32_t x = 0; x < wide; x++) {
            /* width - around % width + x: `around` pixels back from x, and never below 0 */
            size_t from_y = (y + height - around % height) % height, from_x = (x + width - around % width) % width;
            for (uint32_t c = 0; c < 3; c++) {
                repeated[c * pixels + (size_t)y * wide + x] = colour[c][from_y * width + from_x];
            }
        }
    }
    t3r_wavelet_texture(&t3r_kernels_c, planes, wide, high, levels, kind, texture, plane, work);
    for (uint32_t y = 0; y < height; y++) {
        memcpy(texture_q4 + (size_t)y * width, texture + (size_t)(y + around) * wide + around,
               width * sizeof *texture_q4);
    }
    free(repeated);
    free(plane);
    free(work);
    free(texture);
}
