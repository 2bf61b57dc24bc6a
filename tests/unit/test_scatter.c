/* Refinement's inner loops: reciprocals over their whole range, blending again by weights, and what eight columns
 * add to a splat's sums against the same in double, up to the largest values there can be. */
#include "unit.h"

#include "kernels/scatter_columns.h"

enum { SIDE = T3R_TILE_SIDE };

static void reciprocals_are_a_little_small(void **state)
{
    (void)state;
    for (uint32_t n = 1 << 15; n < 1 << 16; n++) {
        uint32_t y = t3r_reciprocal_q31((uint16_t)n);
        assert_true((uint64_t)n * y < UINT64_C(1) << 31);
        assert_true((double)y >= 2147483648.0 / n * (1 - 1.0 / 8192));
    }
}

static t3r_tile_splat any_splat(uint64_t *seed)
{
    t3r_tile_splat lane = {.group = {{.q = (int32_t)unit_between(seed, 0, 6 << 17),
                                      .gx = (int32_t)unit_between(seed, -(1 << 15), 1 << 15),
                                      .gy = (int32_t)unit_between(seed, -(1 << 15), 1 << 15)}},
                           .groups = 1,
                           .drawn = 1,
                           .a = (int32_t)unit_between(seed, 0, 1 << 12),
                           .c = (int32_t)unit_between(seed, 0, 1 << 12),
                           .opacity_q16 = (uint16_t)unit_between(seed, 300, 65535)};
    for (int c = 0; c < 3; c++) {
        lane.colour_q7[c] = (uint16_t)(unit_random(seed) % 8 == 0 ? 32640 : unit_between(seed, 0, 32640));
    }
    return lane;
}

static void clear(t3r_tile *tile)
{
    memset(tile, 0, sizeof *tile);
    memset(tile->transmittance_q16, 0xff, sizeof tile->transmittance_q16);
}

static void weights_blend_to_the_same_bits(void **state)
{
    (void)state;
    uint64_t seed = 3;
    for (int round = 0; round < 200; round++) {
        t3r_tile drawn, again;
        clear(&drawn);
        clear(&again);
        for (int i = 0; i < 40; i++) {
            t3r_tile_splat lane = any_splat(&seed);
            lane.groups = (uint8_t)unit_between(&seed, 1, 2);
            lane.group[1] = lane.group[0];
            lane.drawn = (uint8_t)unit_between(&seed, 0, (1 << lane.groups) - 1);
            lane.column = (uint8_t)(lane.groups == 2 ? 0 : unit_between(&seed, 0, 8));
            lane.first = (uint8_t)unit_between(&seed, 0, 15);
            lane.last = (uint8_t)unit_between(&seed, lane.first, 15);
            size_t rows = (size_t)lane.groups * (lane.last - lane.first + 1u);
            t3r_blend_weights *weights = unit_array(rows, sizeof *weights);
            t3r_blend_c(&drawn, &lane, weights);
            t3r_blend_again_c(&again, &lane, weights);
            free(weights);
            assert_memory_equal(&drawn, &again, sizeof drawn);
        }
    }
}

static void masks_what_does_not_count(void **state)
{
    (void)state;
    uint64_t seed = 4;
    static t3r_wanted want;
    for (int round = 0; round < 1000; round++) {
        uint32_t column = (uint32_t)unit_between(&seed, 0, 8), first = (uint32_t)unit_between(&seed, 0, 15);
        uint32_t last = (uint32_t)unit_between(&seed, first, 15), top = (uint32_t)unit_between(&seed, 0, 65535);
        uint16_t inside[T3R_LANES], all = 0;
        t3r_blend_weights weights[SIDE], masked[SIDE];
        for (uint32_t i = 0; i < T3R_LANES; i++) {
            inside[i] = unit_random(&seed) % 2 ? UINT16_MAX : 0;
            for (uint32_t j = first; j <= last; j++) {
                weights[j - first].q16[i] = (uint16_t)unit_between(&seed, 0, top);
                want.counts[j][column + i] = unit_random(&seed) % 2 ? UINT16_MAX : 0;
            }
        }
        uint16_t bits = t3r_mask_weights(&want, inside, column, first, last, weights, masked);
        for (uint32_t i = 0; i < T3R_LANES; i++) {
            for (uint32_t j = first; j <= last; j++) {
                uint16_t w = inside[i] && want.counts[j][column + i] ? weights[j - first].q16[i] : 0;
                assert_int_equal(masked[j].q16[i], w);
                all |= w;
            }
        }
        assert_int_equal(bits, all);
    }
}

/* C(n + l, l) */
static double choose(uint32_t n, int l)
{
    double c = 1;
    for (int i = 1; i <= l; i++) {
        c = c * (n + (uint32_t)i) / i;
    }
    return c;
}

static void near(double got, double want, double by)
{
    if (!(fabs(got - want) <= by)) {
        print_message("%f, expected %f +- %f\n", got, want, by);
        fail();
    }
}

/* A tile in the middle of being drawn: some splats blended, `want` what some more make of it. */
static void any_tiles(uint64_t *seed, t3r_tile *tile, t3r_wanted *want, t3r_tile_splat *lane,
                      t3r_blend_weights weights[SIDE])
{
    clear(tile);
    int before = (int)unit_between(seed, 0, 4);
    for (int i = 0; i < 12; i++) {
        t3r_tile_splat next = any_splat(seed);
        next.column = 4;
        next.last = SIDE - 1;
        t3r_blend_c(tile, &next, i == before ? weights : NULL);
        if (i == before) {
            *lane = next;
            want->drawn = *tile;
        }
    }
    t3r_tile drawn = *tile;
    *tile = want->drawn;
    want->drawn = drawn;
    for (uint32_t c = 0; c < 3; c++) {
        for (uint32_t j = 0; j < SIDE; j++) {
            for (uint32_t i = 0; i < SIDE; i++) {
                want->residual_q4[c][j][i] = (int16_t)unit_between(seed, -4080, 4080);
            }
        }
    }
}

/* g is right to half a unit, a share of what is behind for the reciprocal and its unit; the rest follows. */
static void sums_what_double_sums(void **state)
{
    (void)state;
    uint64_t seed = 5;
    static t3r_tile tile;
    static t3r_wanted want;
    for (int round = 0; round < 2000; round++) {
        t3r_tile_splat lane;
        t3r_blend_weights weights[SIDE];
        any_tiles(&seed, &tile, &want, &lane, weights);
        uint32_t first = (uint32_t)unit_between(&seed, 0, 15), last = (uint32_t)unit_between(&seed, first, 15);
        uint32_t most = 1, scale = 0;
        for (uint32_t j = first; j <= last; j++) {
            for (uint32_t i = 0; i < T3R_LANES; i++) {
                most = weights[j].q16[i] > most ? weights[j].q16[i] : most;
            }
        }
        while (most << (scale + 1) < 1 << 16) {
            scale++;
        }
        t3r_scatter_sums sums;
        t3r_blend_weights scaled[SIDE];
        memcpy(scaled, weights, sizeof scaled);
        t3r_scatter_columns(&want, &tile, lane.colour_q7, 4, first, last, scaled, scale, &sums);
        double factor = 1 << scale;
        for (uint32_t i = 0; i < T3R_LANES; i++) {
            double gg[5] = {0}, gg_off[5] = {0}, gr[3] = {0}, gr_off[3] = {0}, wr[3] = {0}, w_all = 0;
            for (uint32_t j = first; j <= last; j++) {
                double left = tile.transmittance_q16[j][4 + i], w = weights[j].q16[i] / 65536.0 * factor, square = 0;
                double square_off = 0.125, product = 0, product_off = 0.0625;
                for (int c = 0; c < 3; c++) {
                    double rest = want.drawn.colour_q7[c][j][4 + i] - tile.colour_q7[c][j][4 + i];
                    double behind = left == 0 ? 0 : rest * 512 / left, r = want.residual_q4[c][j][4 + i] / 16.0;
                    double g = w * (lane.colour_q7[c] / 128.0 - behind);
                    double off = 0.5 / 64 + 1.0 / 128 * w + behind / 8192 + 255.0 / 65536;
                    square += g * g;
                    square_off += 2 * fabs(g) * off + off * off;
                    product += g * r;
                    product_off += fabs(r) * off;
                    wr[c] += w * r;
                }
                w_all += w;
                for (int l = 0; l < 5; l++) {
                    gg[l] += square * choose(last - j, l);
                    gg_off[l] += square_off * choose(last - j, l);
                }
                for (int l = 0; l < 3; l++) {
                    gr[l] += product * choose(last - j, l);
                    gr_off[l] += product_off * choose(last - j, l);
                }
            }
            for (int l = 0; l < 4; l++) {
                near(sums.curvature[l][i] / 4.0, gg[l], gg_off[l]);
            }
            near((double)sums.curvature_4[i] / 4, gg[4], gg_off[4]);
            for (int l = 0; l < 3; l++) {
                near(sums.gradient[l][i] / 8.0, gr[l], gr_off[l]);
                near(sums.colour[l][i] / 524288.0, wr[l], 255.0 / 32768 * (last - first + 1));
            }
            near(sums.weight[i] / 32768.0, w_all, (last - first + 1) / 32768.0);
        }
    }
}

/* White, all of it, on black, and as much missing: the sums hold. */
static void the_most_there_can_be_fits(void **state)
{
    (void)state;
    static t3r_tile tile;
    static t3r_wanted want;
    t3r_blend_weights weights[SIDE];
    const uint16_t white[3] = {32640, 32640, 32640};
    for (int sign = -1; sign <= 1; sign += 2) {
        for (uint32_t c = 0; c < 3; c++) {
            for (uint32_t j = 0; j < SIDE; j++) {
                for (uint32_t i = 0; i < SIDE; i++) {
                    want.residual_q4[c][j][i] = (int16_t)(sign * 4080);
                }
            }
        }
        t3r_scatter_sums sums;
        memset(weights, 0xff, sizeof weights);
        t3r_scatter_columns(&want, &tile, white, 0, 0, SIDE - 1, weights, 0, &sums);
        const int64_t g = ((int64_t)32767 * 32640 + 32768) >> 16, square = (3 * g * g + 512) >> 10;
        const int64_t product = (sign * 3 * g * 4080 + 64) >> 7;
        static const int64_t times[5] = {16, 136, 816, 3876, 15504};
        for (uint32_t i = 0; i < T3R_LANES; i++) {
            for (int l = 0; l < 4; l++) {
                assert_true(sums.curvature[l][i] == square * times[l]);
            }
            assert_true(sums.curvature_4[i] == (uint64_t)(square * times[4]));
            for (int l = 0; l < 3; l++) {
                assert_true(sums.gradient[l][i] == product * times[l]);
                assert_true(sums.colour[l][i] == (int64_t)sign * 16 * 32767 * 4080);
            }
            assert_int_equal(sums.weight[i], 16 * 32767);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reciprocals_are_a_little_small), cmocka_unit_test(weights_blend_to_the_same_bits),
        cmocka_unit_test(masks_what_does_not_count),      cmocka_unit_test(sums_what_double_sums),
        cmocka_unit_test(the_most_there_can_be_fits),
    };
    return cmocka_run_group_tests_name("scatter", tests, NULL, NULL);
}
