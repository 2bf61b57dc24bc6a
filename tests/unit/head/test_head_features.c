/* SPDX-License-Identifier: Apache-2.0 */
/* The features of a learned head, against their definition in doubles. */
#include "unit/unit.h"

#include "head/head_features.h"

enum { W = 23, H = 17, PIXELS = W * H, CLUSTERS = 3 };

static uint8_t colour[3][PIXELS], validity[PIXELS], label[PIXELS];
static uint16_t depth[PIXELS], texture[PIXELS];
static uint32_t mask[(PIXELS + 31) / 32];
static t3r_view view = {.width = W,
                        .height = H,
                        .colour = {colour[0], colour[1], colour[2]},
                        .depth = depth,
                        .validity = validity,
                        .texture = texture,
                        .label = label,
                        .mask = mask};
static t3r_cluster clusters[CLUSTERS] = {{.density_q10 = -4000}, {.density_q10 = -900}, {.density_q10 = 700}};
static const t3r_budget_settings settings = {.gamma_q8 = 179, .clusters = CLUSTERS, .pass_over_covered = true};

static void fill_view(uint64_t seed)
{
    memset(mask, 0, sizeof mask);
    for (uint32_t i = 0; i < PIXELS; i++) {
        bool valid = unit_between(&seed, 0, 9) > 0;
        for (int c = 0; c < 3; c++) {
            colour[c][i] = (uint8_t)unit_random(&seed);
        }
        static const uint8_t kinds[] = {T3R_MEASURED,
                                        T3R_MEASURED,
                                        T3R_MEASURED,
                                        T3R_MEASURED | T3R_MARK_COVERED,
                                        T3R_FILLED,
                                        T3R_FILLED | T3R_MARK_COVERED,
                                        T3R_MEASURED | T3R_MARK_DOUBTFUL,
                                        T3R_FILLED | T3R_MARK_DOUBTFUL};
        validity[i] = valid ? kinds[unit_between(&seed, 0, 7)] : 0;
        depth[i] = valid ? (uint16_t)(unit_between(&seed, 0, 5) > 0 ? 1500 + 9 * (i % W) + unit_between(&seed, -3, 3)
                                                                    : unit_between(&seed, 1, 65535))
                         : 0;
        texture[i] = (uint16_t)(unit_random(&seed) >> unit_between(&seed, 48, 63));
        label[i] = valid ? (uint8_t)unit_between(&seed, 0, CLUSTERS - 1) : 255;
        if (valid && unit_between(&seed, 0, 3) == 0) {
            mask[i / 32] |= 1u << i % 32;
        }
    }
}

static double held(double x)
{
    return fmin(fmax(x, -127), 127);
}

static double slope(uint32_t here, uint32_t before, uint32_t after)
{
    if (depth[before] == 0 || depth[after] == 0) {
        return 0;
    }
    return held(floor(4064.0 * ((double)depth[after] - depth[before]) / (2.0 * depth[here]) + 0.5));
}

static void check_pixel(const t3r_head_input *input, uint32_t x, uint32_t y, const int8_t *f)
{
    uint32_t i = y * W + x;
    for (int c = 0; c < 3; c++) {
        assert_int_equal(f[c], colour[c][i] - 128);
    }
    const bool valid = t3r_has_depth(validity[i]);
    bool retained = input->unadapted ? valid : (mask[i / 32] >> i % 32 & 1) != 0;
    assert_int_equal(f[3], retained ? 127 : 0);
    bool doubtful = (validity[i] & T3R_MARK_DOUBTFUL) != 0, covered = (validity[i] & T3R_MARK_COVERED) != 0;
    bool deferred = doubtful || (covered && settings.pass_over_covered);
    if (!valid || (deferred && f[3] == 0)) {
        assert_int_equal(f[5], -70);
        assert_true(f[4] == 0 && f[6] == 0 && f[7] == 0 && f[8] == 0);
        return;
    }
    assert_int_equal(f[4], (validity[i] & T3R_DEPTH_SOURCE_BITS) == T3R_MEASURED ? 127 : 64);
    double log_density = input->unadapted ? 0 : t3r_log_density_q10(&view, i, &settings, input->clusters) / 1024.0;
    assert_int_equal(f[5], held(floor(log_density * 16 + 64 + 0.5)));
    assert_true(fabs(f[6] - held((log2(texture[i] + 8.0) - 9.5) * 16)) < 0.51);
    assert_int_equal(f[7], slope(i, x > 0 ? i - 1 : i, x + 1 < W ? i + 1 : i));
    assert_int_equal(f[8], slope(i, y > 0 ? i - W : i, y + 1 < H ? i + W : i));
}

TEST(features_are_as_defined)
{
    t3r_head_input input = {.map = {.view = &view}, .settings = &settings, .clusters = clusters};
    int8_t least[T3R_FEATURES], most[T3R_FEATURES];
    memset(least, 127, sizeof least);
    memset(most, -128, sizeof most);
    for (uint64_t seed = 0; seed < 40; seed++) {
        fill_view(seed);
        input.unadapted = seed % 4 == 0;
        for (uint32_t y = 0; y < H; y++) {
            int8_t *row = unit_array(W, T3R_FEATURES);
            t3r_head_features(&input, y, row);
            for (uint32_t x = 0; x < W; x++) {
                int8_t one[T3R_FEATURES];
                t3r_head_features_at(&input, x, y, one);
                assert_memory_equal(one, row + x * T3R_FEATURES, T3R_FEATURES);
                check_pixel(&input, x, y, one);
                for (int c = 0; c < T3R_FEATURES; c++) {
                    least[c] = one[c] < least[c] ? one[c] : least[c];
                    most[c] = one[c] > most[c] ? one[c] : most[c];
                }
            }
            free(row);
        }
    }
    assert_true(least[0] == -128 && most[0] == 127 && least[3] == 0 && most[3] == 127 && least[4] == 0 &&
                most[4] == 127);
    assert_true(least[7] == -127 && most[7] == 127 && least[8] == -127 && most[8] == 127);
    assert_true(least[6] < -90 && most[6] > 90 && most[5] - least[5] > 30);
}

/* A copied arena's planes may mark a depth of 0 as measured; it has no slope. */
TEST(no_depth_has_no_slope)
{
    const t3r_head_input input = {
        .map = {.view = &view}, .settings = &settings, .clusters = clusters, .unadapted = true};
    int8_t f[T3R_FEATURES];
    fill_view(1);
    memset(validity, T3R_MEASURED, sizeof validity);
    for (int i = 0; i < PIXELS; i++) {
        depth[i] = (uint16_t)(1500 + 40 * (i % W) + 30 * (i / W));
    }
    t3r_head_features_at(&input, 5, 5, f);
    assert_true(f[7] > 0 && f[8] > 0);
    depth[5 * W + 5] = 0;
    t3r_head_features_at(&input, 5, 5, f);
    assert_true(f[7] == 0 && f[8] == 0);
}
