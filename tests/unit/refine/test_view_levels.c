/* SPDX-License-Identifier: Apache-2.0 */
/* Levels of views: found as made, their mean left to the scene, removed from the residuals, within their bounds at all
 * extremes. */
#include "unit/unit.h"

#include "refine/view_levels.h"

enum { SIDE = T3R_TILE_SIDE, TILES = 9 };

static const t3r_view_levels none;

/* Makes a view that shows `offset + (1 + slope) x` for a rendered x, in levels, with noise. */
static void make_tile(uint64_t *seed, double offset, double slope, t3r_wanted *tile)
{
    memset(tile, 0, sizeof *tile);
    for (int j = 0; j < SIDE; j++) {
        for (int i = 0; i < SIDE; i++) {
            tile->counts[j][i] = unit_random(seed) % 4 == 0 ? 0 : UINT16_MAX;
            for (int c = 0; c < 3; c++) {
                const uint32_t drawn_q7 = (uint32_t)unit_between(seed, 40 << 7, 200 << 7);
                tile->pixels.colour_q7[c][j][i] = (uint16_t)drawn_q7;
                const double missing = offset + slope * (drawn_q7 / 128.0 - 128);
                const double noise = (double)unit_between(seed, 0, 4000) / 1000 - 2;
                tile->residual_q4[c][j][i] = (int16_t)(tile->counts[j][i] != 0 ? lround(16 * (missing + noise)) : 4000);
            }
        }
    }
}

static t3r_level_sums sums_of(uint64_t seed, double offset, double slope, const t3r_view_levels *levels)
{
    t3r_level_sums sums = {0}, other = {0};
    for (int n = 0; n < TILES; n++) {
        t3r_wanted tile;
        make_tile(&seed, offset, slope, &tile);
        t3r_add_levels(&tile, levels, n % 2 ? &other : &sums);
    }
    t3r_join_levels(&sums, &other);
    return sums;
}

TEST(found_as_they_were_made)
{
    static const double made[2][2] = {{6, 0.1}, {-10, -0.06}};
    t3r_view_levels levels[2] = {{{0}, {0}}, {{0}, {0}}};
    for (int turn = 0; turn < 2; turn++) {
        t3r_view_levels lines[2];
        for (int v = 0; v < 2; v++) {
            const t3r_level_sums sums = sums_of(5 + (uint64_t)v, made[v][0], made[v][1], &levels[v]);
            lines[v] = t3r_fit_levels(&sums);
        }
        t3r_center_levels(lines, 2);
        t3r_move_levels(&levels[0], &lines[0]);
        t3r_move_levels(&levels[1], &lines[1]);
        for (int c = 0; c < 3; c++) {
            /* relative to the mean of both, and the target for the drawn level: 0.08 / (1 + 0.02) */
            assert_in_range(levels[0].offset_q8[c] + 10000, 10000 + 7.6 * 256, 10000 + 8.6 * 256);
            assert_in_range(levels[0].slope_q14[c] + 10000, 10000 + 0.073 * 16384, 10000 + 0.083 * 16384);
            assert_true(abs(levels[0].offset_q8[c] + levels[1].offset_q8[c]) <= 2);
            assert_true(abs(levels[0].slope_q14[c] + levels[1].slope_q14[c]) <= 2);
        }
    }
}

TEST(taken_off)
{
    uint64_t seed = 3;
    t3r_wanted tile;
    make_tile(&seed, 10, 0, &tile);
    const t3r_wanted before = tile;
    const t3r_view_levels levels = {{10 << 8, -(1 << 8), 0}, {0, 0, 1 << 12}};
    t3r_level_residuals(&tile, &levels);
    for (int j = 0; j < SIDE; j++) {
        for (int i = 0; i < SIDE; i++) {
            if (tile.counts[j][i] == 0) {
                continue;
            }
            const double target = (before.pixels.colour_q7[2][j][i] / 128.0 + before.residual_q4[2][j][i] / 16.0);
            const double wanted = before.residual_q4[2][j][i] - (target - 128) * 4;
            assert_int_equal(tile.residual_q4[0][j][i], before.residual_q4[0][j][i] - 160);
            assert_int_equal(tile.residual_q4[1][j][i], before.residual_q4[1][j][i] + 16);
            assert_true(fabs(tile.residual_q4[2][j][i] - wanted) < 1);
        }
    }
}

TEST(extremes)
{
    const t3r_level_sums nothing = {0};
    t3r_view_levels line = t3r_fit_levels(&nothing);
    assert_memory_equal(&line, &none, sizeof line);
    static const int16_t missing[] = {-4080, 4080};
    static const uint16_t drawn[] = {0, UINT16_MAX};
    for (int pattern = 0; pattern < 16; pattern++) {
        t3r_wanted tile;
        t3r_level_sums sums = {0};
        memset(&tile, 0xff, sizeof tile);
        for (int i = 0; i < 3 * SIDE * SIDE; i++) {
            const int c = i % 3, y = i / 3 / SIDE, x = i / 3 % SIDE;
            tile.residual_q4[c][y][x] = missing[pattern >> (x % 2) & 1];
            tile.pixels.colour_q7[c][y][x] = drawn[pattern >> (2 + x % 2) & 1];
        }
        t3r_add_levels(&tile, &none, &sums);
        for (int n = 0; n < 16; n++) { /* 2^24 pixels */
            const t3r_level_sums more = sums;
            t3r_join_levels(&sums, &more);
        }
        line = t3r_fit_levels(&sums);
        t3r_view_levels levels = {{8192, -8192, 8192}, {4096, -4096, -4096}}, lines[2] = {line, none};
        t3r_center_levels(lines, 2);
        t3r_move_levels(&levels, &lines[pattern & 1]);
        for (int c = 0; c < 3; c++) {
            assert_true(abs(levels.offset_q8[c]) <= 8192 && abs(levels.slope_q14[c]) <= 4096);
        }
        t3r_level_residuals(&tile, &levels);
        for (int i = 0; i < 3 * SIDE * SIDE; i++) {
            assert_true(abs(tile.residual_q4[i % 3][i / 3 / SIDE][i / 3 % SIDE]) <= 4080);
        }
    }
}
