/* SPDX-License-Identifier: Apache-2.0 */
/* Scales of Gaussians: order statistics, and the bins that several scenes share. */
#include <math.h>
#include <stdlib.h>

#include "scene/gaussian_shape.h"
#include "scene/summary/splat_scales.h"
#include "test.h"

#define COUNT 2000u

/* Makes Gaussian i a disc of radius `radius[i]`, rotated, four times as wide as high, nearly flat. */
static void make_scene(scene_file *scene, const double *radius, uint32_t count, int exponent)
{
    *scene = (scene_file){.frame = {.exponent = exponent}, .count = count};
    scene->gaussians = calloc(count, sizeof *scene->gaussians);
    assert_non_null(scene->gaussians);
    for (uint32_t i = 0; i < count; i++) {
        const double axes[3] = {radius[i] / 2, radius[i] / 500, radius[i] * 2}, turn[4] = {1, i % 7 / 7.0, 0.3, -0.2};
        assert_int_equal(gaussian_shape_set(&scene->gaussians[i], axes, turn), 0);
    }
}

TEST(test_quantiles)
{
    const double radius[] = {0.5, 0.125, 2, 0.25, 1};
    scene_file scene;
    splat_scales scales;
    make_scene(&scene, radius, 5, 2); /* scene units are four world units */
    assert_true(splat_scales_of(&scales, &scene));
    const double expected[] = {0.5, 1, 2, 4, 8};
    for (int i = 0; i < 5; i++) {
        assert_true(fabs(scales.scale[i] / expected[i] - 1) < 2e-3);
    }
    assert_true(splat_scales_quantile(&scales, 0) == scales.scale[0]);
    assert_true(splat_scales_quantile(&scales, 1) == scales.scale[4]);
    assert_true(splat_scales_quantile(&scales, 0.5) == scales.scale[2]);
    assert_true(fabs(splat_scales_quantile(&scales, 0.625) - (scales.scale[2] + scales.scale[3]) / 2) < 1e-12);
    splat_scales_free(&scales);
    scene_file_free(&scene);
}

TEST(test_bins)
{
    double radius[2][COUNT];
    scene_file scene;
    splat_scales list[2];
    for (uint32_t i = 0; i < COUNT; i++) {
        radius[0][i] = 1.1 * exp2(i % 8);       /* the beginnings of eight octaves */
        radius[1][i] = i == 0 ? 1e-6 : 1.1 / 4; /* a single small one widens nothing */
    }
    for (int s = 0; s < 2; s++) {
        make_scene(&scene, radius[s], COUNT, 0);
        assert_true(splat_scales_of(&list[s], &scene));
        scene_file_free(&scene);
    }
    scale_bins bins = scale_bins_of(list, 2);
    assert_int_equal(bins.first, -8); /* 1.1 / 4 lies above 2^-2 */
    assert_int_equal(bins.count, 9 * SCALE_BINS_AN_OCTAVE + 1);
    assert_true(scale_bins_edge(&bins, 0) == 0.25 && scale_bins_edge(&bins, 4) == 0.5);
    uint32_t counts[SCALE_BINS_MOST];
    scale_bins_fill(&bins, &list[0], counts);
    for (uint32_t b = 0; b < bins.count; b++) {
        assert_int_equal(counts[b], b >= 8 && b % 4 == 0 ? COUNT / 8 : 0);
    }
    scale_bins_fill(&bins, &list[1], counts);
    assert_int_equal(counts[0], COUNT); /* lower values included */
    /* higher values included */
    scale_bins narrow = scale_bins_of(&list[1], 1);
    assert_int_equal(narrow.count, 1);
    scale_bins_fill(&narrow, &list[0], counts);
    assert_int_equal(counts[0], COUNT);
    splat_scales_free(&list[0]);
    splat_scales_free(&list[1]);
}

TEST(test_bins_end_somewhere)
{
    double radius[COUNT];
    for (uint32_t i = 0; i < COUNT; i++) {
        radius[i] = i % 2 == 0 ? 0x1p-30 : 0x1p10;
    }
    scene_file scene;
    splat_scales scales;
    make_scene(&scene, radius, COUNT, 0);
    assert_true(splat_scales_of(&scales, &scene));
    scale_bins bins = scale_bins_of(&scales, 1);
    assert_int_equal(bins.count, SCALE_BINS_MOST);
    assert_true(scale_bins_edge(&bins, bins.count) > 900 && scale_bins_edge(&bins, bins.count) < 1300);
    uint32_t counts[SCALE_BINS_MOST];
    scale_bins_fill(&bins, &scales, counts);
    assert_int_equal(counts[0], COUNT / 2);
    splat_scales_free(&scales);
    scene_file_free(&scene);
}
