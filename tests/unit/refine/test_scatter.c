/* SPDX-License-Identifier: Apache-2.0 */
/* Splats removed from a tile: the colours behind the first equal the picture drawn before it; the largest possible
 * values fit; and the same splats at another brightness, or a tile further, give consistent sums. */
#include "unit/unit.h"

#include "kernels/scatter_bits.h"

enum { SIDE = T3R_TILE_SIDE, SPLATS = 40 };

static t3r_tile_splat any_splat(uint64_t *seed)
{
    t3r_tile_splat s = {.group = {{.q = (int32_t)unit_between(seed, 0, 6 << 17),
                                   .gx = (int32_t)unit_between(seed, -(1 << 15), 1 << 15),
                                   .gy = (int32_t)unit_between(seed, -(1 << 15), 1 << 15)}},
                        .groups = (uint8_t)unit_between(seed, 1, 2),
                        .a = (int32_t)unit_between(seed, 0, 1 << 12),
                        .c = (int32_t)unit_between(seed, 0, 1 << 12),
                        .opacity_q16 = (uint16_t)unit_between(seed, 300, 65535)};
    s.group[1] = s.group[0];
    s.drawn = (uint8_t)((1 << s.groups) - 1);
    s.column = (uint8_t)(s.groups == 2 ? 0 : unit_between(seed, 0, 8));
    s.first = (uint8_t)unit_between(seed, 0, 15);
    s.last = (uint8_t)unit_between(seed, s.first, 15);
    for (int c = 0; c < 3; c++) {
        s.colour_q7[c] = (uint16_t)(unit_random(seed) % 8 == 0 ? 32640 : unit_between(seed, 0, 32640));
    }
    return s;
}

static void clear(t3r_tile *tile)
{
    memset(tile, 0, sizeof *tile);
    memset(tile->transmittance_q16, 0xff, sizeof tile->transmittance_q16);
}

static t3r_scatter_splat scatter_of(const t3r_tile_splat *span, const t3r_blended_row *rows, uint16_t bits)
{
    return (t3r_scatter_splat){.span = span,
                               .rows = rows,
                               .scale = 15 - t3r_msb32(bits),
                               .right_q13 = {700, 0},
                               .down_q13 = {0, 700},
                               .origin_q13 = {-5600, -5600},
                               .pixels = 256};
}

/* Every layer's colour is mixed over the colour behind it, so without all layers the whole picture is left. */
TEST(behind_all_is_the_picture)
{
    uint64_t seed = 3;
    static t3r_wanted tile;
    static t3r_blended_row rows[SPLATS][T3R_BLENDED_ROWS_MOST];
    for (int round = 0; round < 200; round++) {
        t3r_tile_splat splats[SPLATS];
        uint16_t bits[SPLATS];
        clear(&tile.pixels);
        for (int n = 0; n < SPLATS; n++) {
            splats[n] = any_splat(&seed);
            bits[n] = t3r_blend_keep_c(&tile.pixels, &splats[n], rows[n]);
        }
        const t3r_tile drawn = tile.pixels;
        memset(tile.pixels.colour_q7, 0, sizeof tile.pixels.colour_q7);
        for (int n = SPLATS; n-- > 0;) {
            const t3r_scatter_splat off = scatter_of(&splats[n], rows[n], (uint16_t)(bits[n] | 1));
            t3r_scatter_c(&tile, &off, NULL);
        }
        for (uint32_t k = 0; k < 3 * SIDE * SIDE; k++) {
            const int32_t want_q7 = drawn.colour_q7[k / (SIDE * SIDE)][k / SIDE % SIDE][k % SIDE];
            const int32_t got_q7 = tile.pixels.colour_q7[k / (SIDE * SIDE)][k / SIDE % SIDE][k % SIDE];
            assert_in_range(got_q7 - want_q7 + 128, 128 - 32, 128 + 64); /* -1/4 to 1/2 level */
        }
    }
}

/* White on black with full weights and the largest residual: the sums are exact. */
TEST(the_most_there_can_be_fits)
{
    static t3r_wanted tile;
    static t3r_blended_row rows[T3R_BLENDED_ROWS_MOST];
    const t3r_tile_splat white = {.groups = 2, .last = SIDE - 1, .colour_q7 = {32640, 32640, 32640}};
    for (int sign = -1; sign <= 1; sign += 2) {
        memset(&tile, 0, sizeof tile);
        memset(tile.counts, 0xff, sizeof tile.counts);
        for (uint32_t k = 0; k < 3 * SIDE * SIDE; k++) {
            tile.residual_q4[k / (SIDE * SIDE)][k / SIDE % SIDE][k % SIDE] = (int16_t)(sign * 4080);
        }
        for (uint32_t k = 0; k < T3R_BLENDED_ROWS_MOST * T3R_LANES; k++) {
            rows[k / T3R_LANES].weight_q16[k % T3R_LANES] = 65535;
            rows[k / T3R_LANES].alpha_q15[k % T3R_LANES] = T3R_ALPHA_MOST_Q16 >> 1;
        }
        t3r_refine_sums sums = {.area = 256};
        const t3r_scatter_splat splat = {.span = &white, .rows = rows, .origin_q13 = {8192, 8192}, .pixels = 256};
        t3r_scatter_c(&tile, &splat, &sums);
        /* 256 pixels, a quarter of them counted (area), each 255^2 x 3 levels^2 up to rounding, at x = y = 1 */
        const double most = 64.0 * 3 * 255 * 255 * 128;
        for (int k = 0; k < T3R_REFINE_MOMENTS_4; k++) {
            assert_true(fabs(sums.curvature[k] / most - 1) < 0.03);
            assert_true(k >= T3R_REFINE_MOMENTS_2 || fabs(sums.gradient[k] / most * sign - 1) < 0.03);
        }
        assert_true(fabs(sums.weight / (64 * 32768.0) - 1) < 0.002);
        for (int c = 0; c < 3; c++) {
            assert_true(fabs(sums.colour[c] / (64.0 * 255 * 2048) * sign - 1) < 0.002);
        }
    }
}

/* Weights of an eighth give an eighth of the linear sums, and a 64th of the square ones. */
TEST(faint_splats_keep_their_bits)
{
    uint64_t seed = 6;
    static t3r_wanted tile;
    static t3r_blended_row rows[T3R_BLENDED_ROWS_MOST], faint[T3R_BLENDED_ROWS_MOST];
    for (int round = 0; round < 200; round++) {
        const t3r_tile_splat s = any_splat(&seed);
        memset(faint, 0, sizeof faint);
        memset(rows, 0, sizeof rows);
        uint16_t bits = 0;
        for (uint32_t k = 0; k < t3r_rows_of(&s) * T3R_LANES; k++) {
            const uint16_t w = (uint16_t)unit_between(&seed, 0, 4095);
            rows[k / T3R_LANES].weight_q16[k % T3R_LANES] = (uint16_t)(w * 16);
            faint[k / T3R_LANES].weight_q16[k % T3R_LANES] = (uint16_t)(w * 2);
            bits |= (uint16_t)(w * 16);
        }
        memset(&tile, 0, sizeof tile);
        memset(tile.counts, 0xff, sizeof tile.counts);
        for (uint32_t k = 0; k < 3 * SIDE * SIDE; k++) {
            tile.residual_q4[k / (SIDE * SIDE)][k / SIDE % SIDE][k % SIDE] = (int16_t)unit_between(&seed, -4080, 4080);
        }
        t3r_refine_sums sums = {.area = 256}, less = {.area = 256};
        t3r_scatter_splat splat = scatter_of(&s, rows, bits);
        t3r_scatter_c(&tile, &splat, &sums);
        splat.rows = faint;
        splat.scale += 3;
        t3r_scatter_c(&tile, &splat, &less);
        for (int k = 0; k < T3R_REFINE_MOMENTS_4; k++) {
            assert_true(fabs(less.curvature[k] - sums.curvature[k] / 64.0) <= 1);
            assert_true(k >= T3R_REFINE_MOMENTS_2 || fabs(less.gradient[k] - sums.gradient[k] / 8.0) <= 1);
        }
    }
}
