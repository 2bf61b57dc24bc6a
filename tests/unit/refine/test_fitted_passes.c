/* SPDX-License-Identifier: Apache-2.0 */
/* The chosen number of passes: equal to the formula in doubles, within its bounds at all extremes, fewer for more
 * Gaussians and for views that disagree more. Whole builds are in test_refine.c. */
#include "unit/unit.h"

#include "refine/fitted_passes.h"

/* Computes sqrt(400 / (share x levels^2)); a share above a quarter counts as one. */
static double wanted(uint32_t points, uint32_t gaussians, uint32_t shared_q8)
{
    return sqrt(400.0 * points / fmin(gaussians, ceil(points / 4.0)) / (shared_q8 / 256.0));
}

TEST(as_in_double)
{
    assert_int_equal(t3r_predict_passes(100000, 100000, 400 * 256, 16), 2);
    assert_int_equal(t3r_predict_passes(100000, 25000, 400 * 256, 16), 2);
    assert_int_equal(t3r_predict_passes(100000, 20000, 125 * 256, 16), 4);
    uint64_t seed = 3;
    for (int turn = 0; turn < 20000; turn++) {
        const uint32_t points = (uint32_t)unit_between(&seed, 1, 1 << 28);
        const uint32_t gaussians = (uint32_t)unit_between(&seed, 1 + points / 64, points);
        const uint32_t shared_q8 = (uint32_t)unit_between(&seed, 1, 1 << (8 + turn % 16));
        const double exact = wanted(points, gaussians, shared_q8);
        const uint32_t got = t3r_predict_passes(points, gaussians, shared_q8, T3R_MAX_REFINE);
        assert_true(got >= fmin(fmax(exact - 0.5001, 1), T3R_MAX_REFINE));
        assert_true(got <= fmin(fmax(exact + 0.5001, 1), T3R_MAX_REFINE));
    }
}

TEST(fewer_where_less_is_shared)
{
    uint32_t by_share = T3R_MAX_REFINE, by_views = T3R_MAX_REFINE;
    for (uint32_t n = 1; n <= 1000; n++) {
        const uint32_t share = t3r_predict_passes(1000, n, 100 * 256, T3R_MAX_REFINE);
        const uint32_t views = t3r_predict_passes(1000, 100, n * 256, T3R_MAX_REFINE);
        assert_true(share <= by_share && views <= by_views);
        by_share = share;
        by_views = views;
    }
    assert_int_equal(by_share, 4);
    assert_int_equal(by_views, 2);
}

/* From three on, passes over a part of the pixels are a quarter more, and the last one is whole. */
TEST(in_parts)
{
    for (uint32_t whole = 1; whole <= T3R_MAX_REFINE; whole++) {
        const t3r_passes passes = t3r_passes_in_parts(whole);
        assert_int_equal(passes.count, whole < 3 ? whole : whole + (whole + 1) / 4);
        assert_int_equal(passes.parts, whole < 3 ? 0 : passes.count - 1);
    }
}

/* A part of the pixels is enough where views disagree by 80 levels^2 at 256 x 256 or more, and neighbours share 3/8. */
TEST(a_part_suffices_where_neighbours_share)
{
    const uint32_t pixels = 256 * 256, least_q8 = 80 * 256;
    assert_true(t3r_parts_suffice(pixels, least_q8, 30 * 256));
    assert_false(t3r_parts_suffice(pixels, least_q8, 30 * 256 - 1));
    assert_false(t3r_parts_suffice(pixels, least_q8 - 1, 80 * 256));
    assert_false(t3r_parts_suffice(pixels / 4, least_q8, 80 * 256));
    assert_true(t3r_parts_suffice(pixels / 4, 4 * least_q8, 120 * 256));
    assert_false(t3r_parts_suffice(pixels, least_q8, -80 * 256));
    assert_false(t3r_parts_suffice(1 << 24, 0, 0));
    assert_true(t3r_parts_suffice(1 << 24, 1 << 24, 1 << 24));
    assert_false(t3r_parts_suffice(1 << 24, 1 << 24, -(1 << 24)));
}

TEST(extremes)
{
    const uint32_t most_points = 1u << 28, worst = 1u << 24;
    assert_int_equal(t3r_predict_passes(most_points, 1, 0, 16), 16);
    assert_int_equal(t3r_predict_passes(most_points, most_points, worst, 16), 1);
    assert_int_equal(t3r_predict_passes(1, 1, 0, 1), 1);
    assert_int_equal(t3r_predict_passes(0, 0, 100, 16), 1); /* a restored arena may lack points */
    assert_int_equal(t3r_predict_passes(0, 5, 100, 16), 1);
    assert_int_equal(t3r_predict_passes(1, 1, UINT32_MAX, 16), 1);
}
