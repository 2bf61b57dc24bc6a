/* SPDX-License-Identifier: Apache-2.0 */
/* The structural loss: equal to doubles for tiles of all contrasts with pixels that do not count, and within bounds. */
#include "unit/unit.h"

#include "core/fixed.h"
#include "refine/structural.h"

enum { SIDE = T3R_TILE_SIDE };

static void make_tile(uint64_t *seed, int contrast, int missing, t3r_wanted *tile)
{
    memset(tile, 0, sizeof *tile);
    const int level = (int)unit_between(seed, 0, 255 * 128);
    for (int j = 0; j < SIDE; j++) {
        for (int i = 0; i < SIDE; i++) {
            tile->counts[j][i] = unit_random(seed) % 5 == 0 ? 0 : UINT16_MAX;
            for (int c = 0; c < 3; c++) {
                const int drawn = level + (int)unit_between(seed, 0, (uint32_t)contrast * 2) - contrast;
                tile->pixels.colour_q7[c][j][i] = (uint16_t)t3r_clamp32(drawn, 0, 255 * 128 + 100);
                const int q4 = t3r_round_shift32(T3R_MIN(tile->pixels.colour_q7[c][j][i], 255 * 128), 3);
                const int residual = (int)unit_between(seed, 0, (uint32_t)missing * 2) - missing;
                tile->residual_q4[c][j][i] = (int16_t)(t3r_clamp32(q4 + residual, 0, 4080) - q4);
            }
        }
    }
}

typedef struct window {
    double weight, mean;
    int count;
} window;

static window window_at(const t3r_wanted *tile, int c, int y, int x)
{
    window w = {0};
    double drawn = 0, target = 0, squares = 0;
    for (int j = T3R_MAX(y - 1, 0); j <= T3R_MIN(y + 1, SIDE - 1); j++) {
        for (int i = T3R_MAX(x - 1, 0); i <= T3R_MIN(x + 1, SIDE - 1); i++) {
            if (tile->counts[j][i] != 0) {
                const double d = t3r_round_shift32(T3R_MIN(tile->pixels.colour_q7[c][j][i], 255 * 128), 3) / 16.0;
                const double t = d + tile->residual_q4[c][j][i] / 16.0;
                drawn += d, target += t, squares += d * d + t * t;
                w.count++;
            }
        }
    }
    if (w.count > 0) {
        drawn /= w.count, target /= w.count;
        w.weight = 256 / (squares / w.count - drawn * drawn - target * target + 64);
        w.mean = target - drawn;
    }
    return w;
}

static double asked_of(const t3r_wanted *tile, int c, int y, int x)
{
    double sum = 0;
    int count = 0;
    const double r = tile->residual_q4[c][y][x] / 16.0;
    for (int j = T3R_MAX(y - 1, 0); j <= T3R_MIN(y + 1, SIDE - 1); j++) {
        for (int i = T3R_MAX(x - 1, 0); i <= T3R_MIN(x + 1, SIDE - 1); i++) {
            const window w = window_at(tile, c, j, i);
            sum += w.weight * (r - w.mean);
            count += tile->counts[j][i] != 0;
        }
    }
    return (11 * r + 5 * sum / count) / 16;
}

TEST(as_in_double)
{
    uint64_t seed = 7;
    double worst = 0;
    for (int turn = 0; turn < 60; turn++) {
        t3r_wanted tile;
        make_tile(&seed, 1 << (turn % 15), 1 << (turn % 12), &tile);
        const t3r_wanted before = tile;
        t3r_structural_residuals(&tile);
        for (int c = 0; c < 3; c++) {
            for (int j = 0; j < SIDE; j++) {
                for (int i = 0; i < SIDE; i++) {
                    if (tile.counts[j][i] != 0) {
                        const double asked = fmin(fmax(asked_of(&before, c, j, i), -255), 255);
                        worst = fmax(worst, fabs(tile.residual_q4[c][j][i] / 16.0 - asked) - fabs(asked) / 200);
                    }
                }
            }
        }
    }
    print_message("worst %.3f levels\n", worst);
    assert_true(worst < 0.25);
}

/* A level that is missing in a whole tile is no structure; a residual of a weak contrast counts more than of a strong
 * one; pixels that do not count change nothing in others. */
TEST(structure_alone)
{
    t3r_wanted tile = {0};
    memset(tile.counts, 0xff, sizeof tile.counts);
    for (int i = 0; i < SIDE * SIDE; i++) {
        tile.pixels.colour_q7[0][i / SIDE][i % SIDE] = 100 << 7;
        tile.residual_q4[0][i / SIDE][i % SIDE] = 160;
    }
    t3r_wanted twice = tile;
    for (int j = 0; j < SIDE; j++) {
        for (int i = 0; i < SIDE; i++) {
            const int odd = (i + j) % 2 ? 1 : -1;
            tile.residual_q4[1][j][i] = (int16_t)(16 * odd);
            tile.pixels.colour_q7[1][j][i] = 100 << 7;
            tile.residual_q4[2][j][i] = (int16_t)(16 * odd);
            tile.pixels.colour_q7[2][j][i] = (uint16_t)((100 + 50 * odd) << 7);
        }
    }
    t3r_structural_residuals(&tile);
    for (int j = 0; j < SIDE; j++) {
        for (int i = 0; i < SIDE; i++) {
            assert_int_equal(tile.residual_q4[0][j][i], 110);
            assert_true(abs(tile.residual_q4[1][j][i]) > 24);
            assert_true(abs(tile.residual_q4[2][j][i]) < 13);
        }
    }
    twice.counts[5][5] = 0;
    twice.residual_q4[0][5][5] = 4080;
    twice.pixels.colour_q7[0][5][5] = 0;
    t3r_structural_residuals(&twice);
    assert_int_equal(twice.residual_q4[0][5][6], 110);
    assert_int_equal(twice.residual_q4[0][4][4], 110);
}

TEST(extremes)
{
    for (int pattern = 0; pattern < 512; pattern++) {
        t3r_wanted tile = {0};
        for (int i = 0; i < SIDE * SIDE; i++) {
            const int x = i % SIDE, y = i / SIDE, bit = pattern >> (x % 3 + y % 3 * 3) & 1;
            tile.counts[y][x] = pattern % 7 == 6 ? 0 : UINT16_MAX;
            for (int c = 0; c < 3; c++) {
                tile.pixels.colour_q7[c][y][x] = bit ? UINT16_MAX : 0;
                tile.residual_q4[c][y][x] = bit ? -4080 : 4080;
            }
        }
        t3r_structural_residuals(&tile);
        for (int i = 0; i < 3 * SIDE * SIDE; i++) {
            assert_true(abs(tile.residual_q4[i % 3][i / 3 / SIDE][i / 3 % SIDE]) <= 4080);
        }
    }
}
