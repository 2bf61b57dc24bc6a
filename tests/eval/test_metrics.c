/* SPDX-License-Identifier: Apache-2.0 */
/* The measures on pictures whose values follow from the definitions. */
#include <math.h>
#include <string.h>

#include "pictures/metrics.h"
#include "pictures/metrics_filter.h"
#include "test.h"

#define SIDE 48u
#define PIXELS (SIDE * SIDE)

static void assert_near(double a, double b, double bound)
{
    if (!(fabs(a - b) <= bound)) {
        fail_msg("%.12g is not within %g of %.12g", a, bound, b);
    }
}

/* Makes a picture with structure in all channels. */
static void fill_picture(uint8_t *rgb, uint32_t seed)
{
    for (uint32_t i = 0; i < PIXELS * 3; i++) {
        uint32_t x = i / 3 % SIDE, y = i / 3 / SIDE;
        seed = seed * 1664525u + 1013904223u;
        rgb[i] = (uint8_t)(x * 3 + y * 2 * (i % 3) + (seed >> 28));
    }
}

TEST(test_identical_pictures)
{
    uint8_t a[PIXELS * 3];
    fill_picture(a, 1);
    assert_near(metric_psnr(a, a, NULL, SIDE, SIDE), 99, 0);
    assert_near(metric_ssim(a, a, NULL, SIDE, SIDE), 1, 1e-12);
    assert_near(metric_sharp(a, a, NULL, SIDE, SIDE), 1, 1e-12);
    assert_near(metric_flip(a, a, NULL, SIDE, SIDE), 0, 0);
}

TEST(test_psnr_of_a_known_error)
{
    uint8_t a[PIXELS * 3], b[PIXELS * 3], mask[PIXELS] = {0};
    memset(a, 100, sizeof a);
    memcpy(b, a, sizeof b);
    for (uint32_t i = 0; i < PIXELS * 3; i++) {
        b[i] = (uint8_t)(a[i] + (i % 2 == 0 ? 10 : -10));
    }
    assert_near(metric_psnr(a, b, NULL, SIDE, SIDE), 20 * log10(255 / 10.0), 1e-12);
    /* one pixel of the mask, one of its channels wrong by 255: a third of the peak's square */
    a[3 * 7] = 255;
    a[3 * 7 + 1] = a[3 * 7 + 2] = 9;
    b[3 * 7] = 0;
    b[3 * 7 + 1] = b[3 * 7 + 2] = 9;
    mask[7] = 1;
    assert_near(metric_psnr(a, b, mask, SIDE, SIDE), 10 * log10(3), 1e-12);
}

TEST(test_ssim_of_flat_pictures)
{
    uint8_t a[PIXELS * 3], b[PIXELS * 3];
    memset(a, 50, sizeof a);
    memset(b, 200, sizeof b);
    /* no variance: only the luminance term */
    double c1 = 0.01 * 255 * 0.01 * 255;
    assert_near(metric_ssim(a, b, NULL, SIDE, SIDE), (2 * 50.0 * 200 + c1) / (50.0 * 50 + 200.0 * 200 + c1), 1e-9);
}

TEST(test_sharp_is_a_ratio_of_gradients)
{
    uint8_t a[PIXELS * 3], b[PIXELS * 3];
    for (uint32_t i = 0; i < PIXELS * 3; i++) {
        uint32_t x = i / 3 % SIDE, y = i / 3 / SIDE;
        a[i] = (uint8_t)(3 * x); /* slope 3 everywhere, edges included */
        b[i] = (uint8_t)(x + y); /* slope sqrt 2 */
    }
    assert_near(metric_sharp(a, b, NULL, SIDE, SIDE), sqrt(2) / 3, 1e-12);
    memset(b, 77, sizeof b);
    assert_near(metric_sharp(a, b, NULL, SIDE, SIDE), 0, 0);
    assert_near(metric_sharp(b, a, NULL, SIDE, SIDE), 3 / 1e-9, 1);
}

/* Black against white has no feature, only a luminance step of 100: 100^0.7, in the upper part of the range, which
 * ends at pure green against pure blue. */
TEST(test_flip_of_black_and_white)
{
    uint8_t black[PIXELS * 3], white[PIXELS * 3];
    memset(black, 0, sizeof black);
    memset(white, 255, sizeof white);
    double largest = pow(203.43, 0.7); /* Hunt-adjusted HyAB of green and blue, to two decimals */
    double expected = 0.95 + 0.05 * (pow(100, 0.7) - 0.4 * largest) / (0.6 * largest);
    assert_near(metric_flip(black, white, NULL, SIDE, SIDE), expected, 1e-4);
    assert_near(metric_flip(white, black, NULL, SIDE, SIDE), expected, 1e-4);
}

TEST(test_flip_is_symmetric_and_grows)
{
    uint8_t a[PIXELS * 3], b[PIXELS * 3];
    double last = 0;
    fill_picture(a, 3);
    for (int step = 4; step <= 64; step *= 2) {
        for (uint32_t i = 0; i < PIXELS * 3; i++) {
            b[i] = (uint8_t)(a[i] > 127 ? a[i] - step : a[i] + step);
        }
        double flip = metric_flip(a, b, NULL, SIDE, SIDE);
        assert_near(flip, metric_flip(b, a, NULL, SIDE, SIDE), 1e-12);
        assert_true(flip > last && flip < 1);
        last = flip;
    }
}

/* Compares with the authors' own evaluator, in single precision, for this pair at 67 pixels a degree. */
TEST(test_flip_of_a_published_evaluator)
{
    uint8_t a[PIXELS * 3], b[PIXELS * 3];
    fill_picture(a, 1);
    fill_picture(b, 2);
    assert_near(metric_flip(a, b, NULL, SIDE, SIDE), 0.076951, 2e-6);
}

TEST(test_mask_leaves_pixels_out)
{
    uint8_t a[PIXELS * 3], b[PIXELS * 3], left[PIXELS], none[PIXELS] = {0}, all[PIXELS];
    fill_picture(a, 3);
    memcpy(b, a, sizeof b);
    memset(all, 1, sizeof all);
    for (uint32_t i = 0; i < PIXELS; i++) {
        left[i] = i % SIDE < SIDE / 2 ? 200 : 0;
        if (i % SIDE >= SIDE / 2 + 6) { /* beyond the window of the mask's last column */
            b[3 * i] ^= 0xff;
        }
    }
    assert_near(metric_psnr(a, b, left, SIDE, SIDE), 99, 0);
    assert_near(metric_ssim(a, b, left, SIDE, SIDE), 1, 1e-12);
    assert_near(metric_sharp(a, b, left, SIDE, SIDE), 1, 1e-12);
    assert_true(metric_psnr(a, b, NULL, SIDE, SIDE) < 40);
    assert_near(metric_ssim(a, b, all, SIDE, SIDE), metric_ssim(a, b, NULL, SIDE, SIDE), 0);
    assert_near(metric_flip(a, b, all, SIDE, SIDE), metric_flip(a, b, NULL, SIDE, SIDE), 0);
    assert_true(isnan(metric_psnr(a, b, none, SIDE, SIDE)));
    assert_true(isnan(metric_ssim(a, b, none, SIDE, SIDE)));
    assert_true(isnan(metric_sharp(a, b, none, SIDE, SIDE)));
    assert_true(isnan(metric_flip(a, b, none, SIDE, SIDE)));
}

TEST(test_pictures_smaller_than_the_windows)
{
    uint8_t a[9 * 3], b[9 * 3];
    for (uint32_t i = 0; i < sizeof a; i++) {
        a[i] = (uint8_t)(i * 9);
        b[i] = (uint8_t)(255 - i);
    }
    for (uint32_t w = 1; w <= 3; w++) {
        for (uint32_t h = 1; h <= 3; h++) {
            assert_near(metric_ssim(a, a, NULL, w, h), 1, 1e-12);
            assert_true(isfinite(metric_ssim(a, b, NULL, w, h)));
            assert_true(isfinite(metric_sharp(a, b, NULL, w, h)));
            assert_true(metric_flip(a, b, NULL, w, h) > 0);
        }
    }
}

TEST(test_filter_borders)
{
    const double in[3] = {1, 2, 4}, one[5] = {0, 0, 1, 0, 0};
    const double earlier[5] = {1, 0, 0, 0, 0}, later[5] = {0, 0, 0, 0, 1};
    double out[3], work[3];
    metrics_filter(in, out, work, 3, 1, earlier, one, 2, METRICS_BORDER_REFLECT);
    assert_near(out[0], 2, 0); /* 2 1 | 1 2 4 */
    assert_near(out[1], 1, 0);
    assert_near(out[2], 1, 0);
    metrics_filter(in, out, work, 3, 1, later, one, 2, METRICS_BORDER_REPLICATE);
    assert_near(out[0], 4, 0);
    assert_near(out[1], 4, 0);
    assert_near(out[2], 4, 0);
    metrics_filter(in, out, work, 1, 3, one, later, 2, METRICS_BORDER_REFLECT);
    assert_near(out[0], 4, 0); /* 1 2 4 | 4 2 */
    assert_near(out[1], 4, 0);
    assert_near(out[2], 2, 0);
}
