/* SPDX-License-Identifier: Apache-2.0 */
#include "view_levels.h"

#include "core/fixed.h"

#define MIDDLE_Q4 (128 << 4)
#define OFFSET_MOST_Q8 (32 << 8)
#define SLOPE_MOST_Q14 (1 << 12)
#define NOISE_Q16 (25 << 16) /* levels^2: a view with less contrast doesn't determine the slope */
#define RESIDUAL_MOST_Q4 (255 << 4)

/* Returns the target minus 128 levels, from residual and drawn colour, clamped to 128 levels either way. */
static int32_t target_q4(const t3r_wanted *tile, int c, uint32_t j, uint32_t i)
{
    const int32_t drawn_q4 = t3r_round_shift32(T3R_MIN((int32_t)tile->pixels.colour_q7[c][j][i], 255 << 7), 3);
    return t3r_clamp32(tile->residual_q4[c][j][i] + drawn_q4 - MIDDLE_Q4, -MIDDLE_Q4, MIDDLE_Q4);
}

static int32_t missing_q4(int32_t residual_q4, int32_t t_q4, int32_t offset_q8, int32_t slope_q14)
{
    return residual_q4 - t3r_round_shift32(offset_q8 * (1 << 10) + slope_q14 * t_q4, 14); /* below 2^24 */
}

void t3r_add_levels(const t3r_wanted *tile, const t3r_view_levels *levels, t3r_level_sums *sums)
{
    for (int c = 0; c < 3; c++) {
        for (uint32_t j = 0; j < T3R_TILE_SIDE; j++) {
            int32_t target = 0, squares = 0, missing = 0, products = 0; /* sums over 16 pixels: below 2^29 */
            for (uint32_t i = 0; i < T3R_TILE_SIDE; i++) {
                const int32_t counts = tile->counts[j][i] != 0, t = target_q4(tile, c, j, i) * counts;
                const int32_t r =
                    missing_q4(tile->residual_q4[c][j][i], t, levels->offset_q8[c], levels->slope_q14[c]) * counts;
                target += t;
                squares += t * t;
                missing += r;
                products += r * t;
                sums->pixels += c == 0 ? (uint32_t)counts : 0;
            }
            sums->target_q4[c] += target;
            sums->squares_q8[c] += squares;
            sums->missing_q4[c] += missing;
            sums->products_q8[c] += products;
        }
    }
}

void t3r_join_levels(t3r_level_sums *sums, const t3r_level_sums *others)
{
    sums->pixels += others->pixels;
    for (int c = 0; c < 3; c++) {
        sums->target_q4[c] += others->target_q4[c];
        sums->squares_q8[c] += others->squares_q8[c];
        sums->missing_q4[c] += others->missing_q4[c];
        sums->products_q8[c] += others->products_q8[c];
    }
}

t3r_view_levels t3r_fit_levels(const t3r_level_sums *sums)
{
    t3r_view_levels line = {{0}, {0}};
    const int64_t n = sums->pixels;
    for (int c = 0; c < 3 && n > 0; c++) {
        const int64_t t_q8 = t3r_round_div64(sums->target_q4[c] * 16, n);
        const int64_t r_q8 = t3r_round_div64(sums->missing_q4[c] * 16, n);
        const int64_t square_q16 = t3r_round_div64(sums->squares_q8[c] * 256, n) - t_q8 * t_q8; /* below 2^31 */
        const int64_t product_q16 = t3r_round_div64(sums->products_q8[c] * 256, n) - t_q8 * r_q8;
        const int64_t slope = t3r_round_div64(product_q16 * (1 << 14), T3R_MAX(square_q16, 0) + NOISE_Q16);
        line.slope_q14[c] = (int16_t)t3r_clamp64(slope, -SLOPE_MOST_Q14, SLOPE_MOST_Q14);
        const int64_t offset = r_q8 - t3r_round_shift64(line.slope_q14[c] * t_q8, 14);
        line.offset_q8[c] = (int16_t)t3r_clamp64(offset, -OFFSET_MOST_Q8, OFFSET_MOST_Q8);
    }
    return line;
}

void t3r_center_levels(t3r_view_levels *lines, uint32_t count)
{
    for (int c = 0; c < 3; c++) {
        int32_t offset = lines[0].offset_q8[c], slope = lines[0].slope_q14[c];
        for (uint32_t v = 1; v < count; v++) {
            offset += lines[v].offset_q8[c];
            slope += lines[v].slope_q14[c];
        }
        offset = t3r_round_div32(offset, (int32_t)count);
        slope = t3r_round_div32(slope, (int32_t)count);
        for (uint32_t v = 0; v < count; v++) {
            lines[v].offset_q8[c] = (int16_t)(lines[v].offset_q8[c] - offset); /* at most twice the bound */
            lines[v].slope_q14[c] = (int16_t)(lines[v].slope_q14[c] - slope);
        }
    }
}

void t3r_move_levels(t3r_view_levels *levels, const t3r_view_levels *line)
{
    for (int c = 0; c < 3; c++) {
        const int32_t offset = levels->offset_q8[c] + line->offset_q8[c],
                      slope = levels->slope_q14[c] + line->slope_q14[c];
        levels->offset_q8[c] = (int16_t)t3r_clamp32(offset, -OFFSET_MOST_Q8, OFFSET_MOST_Q8);
        levels->slope_q14[c] = (int16_t)t3r_clamp32(slope, -SLOPE_MOST_Q14, SLOPE_MOST_Q14);
    }
}

void t3r_level_residuals(t3r_wanted *tile, const t3r_view_levels *levels)
{
    for (int c = 0; c < 3; c++) {
        const int32_t offset_q8 = levels->offset_q8[c], slope_q14 = levels->slope_q14[c];
        for (uint32_t j = 0; j < T3R_TILE_SIDE; j++) {
            for (uint32_t i = 0; i < T3R_TILE_SIDE; i++) {
                const int32_t r =
                    missing_q4(tile->residual_q4[c][j][i], target_q4(tile, c, j, i), offset_q8, slope_q14);
                tile->residual_q4[c][j][i] = (int16_t)t3r_clamp32(r, -RESIDUAL_MOST_Q4, RESIDUAL_MOST_Q4);
            }
        }
    }
}
