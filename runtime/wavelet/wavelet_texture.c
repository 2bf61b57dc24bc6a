/* SPDX-License-Identifier: Apache-2.0 */
/* Texture energy: a transform whose rows stay in place, then the sum of absolute coefficients over all levels.
 *
 * 16 and 32 bits suffice, by the table in wavelet_level.h: |h| + |v| <= 2 x 10,430 on every level; 0.268 |d| <= 8,750
 * on level 1, so their sum is below 2^15; |d| <= 23,620 on the others. */
#include "wavelet_level.h"

#include "core/memory.h"
#include "kernels/wavelet_rows.h"

/* Ratio of orthonormal to lifted coefficients. db2: low 1.93185, high 0.51764, so h and v 1, d 2 - sqrt 3, and times 2
 * + sqrt 3 for each further level. Haar, and 5/3 treated alike: low sqrt 2, high 1 / sqrt 2, so 1, 1/2, and times 2 for
 * each further level. */
static const uint16_t finest_d_gain_q16[T3R_WAVELET_COUNT] = {17560, 32768, 32768};
static const uint16_t gain_q8[T3R_WAVELET_COUNT][T3R_MAX_LEVELS] = {
    {256, 955, 3566, 13307, 49662}, {256, 512, 1024, 2048, 4096}, {256, 512, 1024, 2048, 4096}};

static uint16_t texture_of_one(int16_t coefficient, uint32_t gain)
{
    return (uint16_t)T3R_MIN((gain * (uint32_t)t3r_abs32(coefficient) + 128) >> 8, 65535u);
}

/* Computes the texture of low row n and high row n of level `index` (from 0). Coefficients that odd sides lack count
 * 0. */
static void texture_row(const t3r_level *x, uint32_t index, uint32_t n, uint16_t *out)
{
    uint32_t lows = (x->width + 1) / 2, highs = x->width / 2;
    uint32_t gain = gain_q8[t3r_kind_of(x)][index];
    const int16_t *h = t3r_low_row(x, n) + lows;

    if (n == x->height / 2) {
        /* the last low row of an odd height has no high row */
        for (uint32_t i = 0; i < highs; i++) {
            out[i] = texture_of_one(h[i], gain);
        }
        if (lows > highs) {
            out[highs] = 0;
        }
        return;
    }
    const int16_t *v = t3r_high_row(x, n), *d = v + lows;
    if (index == 0) {
        x->kernels->texture_finest(out, h, v, d, finest_d_gain_q16[t3r_kind_of(x)], highs);
    } else {
        x->kernels->texture_coarse(out, h, v, d, gain, gain_q8[t3r_kind_of(x)][index - 1], highs);
    }
    if (lows > highs) {
        out[highs] = texture_of_one(v[highs], gain);
    }
}

/* Goes down the image. A row of a level is computed when the image reaches it, and then holds the sum of its own level
 * and the coarser ones. */
static void texture_plane(const t3r_level *level, uint32_t levels, uint16_t *texture_q4, uint16_t *work)
{
    uint32_t width = level[0].width, height = level[0].height;
    uint16_t *rows[T3R_MAX_LEVELS];

    for (uint32_t l = 0; l < levels; l++) {
        rows[l] = work;
        work += (level[l].width + 1) / 2;
    }
    for (uint32_t y = 0; y < height; y += 2) {
        for (uint32_t l = levels; l-- > 0;) {
            if (y % (2u << l) != 0) {
                continue;
            }
            texture_row(&level[l], l, y / (2u << l), rows[l]);
            if (l + 1 < levels) {
                level[l].kernels->texture_add(rows[l], rows[l + 1], level[l + 1].width);
            }
        }
        uint16_t *out = texture_q4 + (size_t)y * width;
        level[0].kernels->texture_spread(out, rows[0], width);
        if (y + 1 < height) {
            level[0].kernels->texture_spread(out + width, rows[0],
                                             width); /* a copy would wait for the preceding stores */
        }
    }
}

void t3r_wavelet_texture(const t3r_kernels *kernels, const uint8_t *const colour[3], uint32_t width, uint32_t height,
                         uint32_t levels, t3r_wavelet kind, uint16_t *texture_q4, int16_t *plane, int16_t *work)
{
    t3r_level level[T3R_MAX_LEVELS];

    if (levels == 0) {
        memset(texture_q4, 0, (size_t)width * height * sizeof(uint16_t));
        return;
    }
    uint32_t l = 0;
    do {
        level[l] = t3r_level_of(plane, width, height, l, kind, work);
        level[l].kernels = kernels;
        level[l].in_place = l;
        level[l].colour = l == 0 ? colour : NULL;
        t3r_wavelet_level_forward(&level[l]);
    } while (++l < levels);
    texture_plane(level, levels, texture_q4, (uint16_t *)work);
}
