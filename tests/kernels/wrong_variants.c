/* SPDX-License-Identifier: Apache-2.0 */
/* Variants with typical small mistakes. */
#include "judge.h"

static void rounds_down(const uint16_t *const rows[T3R_BLUR_TAPS], uint32_t width, uint16_t *restrict out)
{
    t3r_blur_column_c(rows, width, out);
    if (width % 16 == 15 && out[width - 1] > 0) {
        out[width - 1]--;
    }
}

static void writes_whole_vectors(int16_t *restrict high, const int16_t *restrict low, size_t count)
{
    t3r_subtract_row_c(high, low, count);
    if (count % 8 == 7) {
        high[count] = 0;
    }
}

static void reads_whole_vectors(uint16_t *restrict fine, const uint16_t *restrict coarse, size_t count)
{
    volatile uint16_t unused = coarse[(count + 1) / 2];
    (void)unused;
    t3r_texture_spread_c(fine, coarse, count);
}

static void bends_the_opacity(t3r_tile *tile, const t3r_tile_splat *splat)
{
    t3r_tile_splat bent = *splat;
    bent.opacity_q16 = splat->opacity_q16 == 65534 ? 65535 : splat->opacity_q16;
    t3r_blend_c(tile, &bent);
}

static void takes_the_last(const t3r_centres *centres, const t3r_neighbours *neighbours, uint32_t points,
                           const int16_t (*feature_q11)[T3R_DIMENSIONS], uint16_t guess, uint16_t *nearest)
{
    t3r_nearest_c(centres, neighbours, points, feature_q11, guess, nearest);
    for (uint32_t i = 0; i < points; i++) {
        for (uint32_t k = nearest[i] + 1u; k < centres->count; k++) {
            bool same = centres->half_norm[k] == centres->half_norm[nearest[i]];
            for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
                same = same && centres->feature_q11[d][k] == centres->feature_q11[d][nearest[i]];
            }
            nearest[i] = same ? (uint16_t)k : nearest[i];
        }
    }
}

static void saturates(const t3r_convolution *layer, const t3r_block *block, void *out, uint32_t out_pitch)
{
    t3r_convolve_c(layer, block, out, out_pitch);
    if (layer->output_bits == 8 && *(int8_t *)out == INT8_MIN) {
        *(int8_t *)out = -127;
    }
}

void make_wrong_variants(wrong_variant variants[WRONG_VARIANTS])
{
    static const char *const entry[WRONG_VARIANTS] = {"blur_column", "subtract_row", "texture_spread",
                                                      "blend",       "nearest",      "convolve"};
    for (int i = 0; i < WRONG_VARIANTS; i++) {
        variants[i] = (wrong_variant){entry[i], t3r_kernels_c};
    }
    variants[0].kernels.blur_column = rounds_down;
    variants[1].kernels.subtract_row = writes_whole_vectors;
    variants[2].kernels.texture_spread = reads_whole_vectors;
    variants[3].kernels.blend = bends_the_opacity;
    variants[4].kernels.nearest = takes_the_last;
    variants[5].kernels.convolve = saturates;
}
