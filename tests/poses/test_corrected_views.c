/* SPDX-License-Identifier: Apache-2.0 */
/* A camera among corrected views gets their correction: its own view's where one stands, the common one of all, and the
 * mean of the nearest; with none it stays. */
#include <math.h>

#include "reconstruction/context/corrected_views.h"
#include "test.h"

/* Makes a camera at x metres, turned about y by this many radians, a small angle. */
static t3r_camera camera_at(double x, double angle)
{
    return (t3r_camera){.width = 64,
                        .height = 64,
                        .fx_q16 = 64 << 16,
                        .fy_q16 = 64 << 16,
                        .position_q32 = {(int64_t)ldexp(x, 32)},
                        .rotation_q30 = {(int32_t)ldexp(cos(angle / 2), 30), 0, (int32_t)ldexp(sin(angle / 2), 30), 0}};
}

/* Adds a view at x whose pose turns by `angle` and moves by `shift`, and whose colours take this gain. */
static void add(corrected_views *views, double x, double angle, double shift, double gain)
{
    views->given[views->count] = camera_at(x, 0);
    views->used[views->count] = camera_at(x + shift, angle);
    for (int c = 0; c < 3; c++) {
        views->gain_q14[views->count][c] = (uint16_t)ldexp(gain, 14);
    }
    views->count++;
}

static void expect(const corrected_views *views, double x, double angle, double shift, double gain, double within)
{
    double found_gain[3];
    const t3r_camera camera = camera_at(x, 0), found = corrected_views_camera(views, &camera, found_gain);
    assert_true(fabs(ldexp((double)found.position_q32[0], -32) - x - shift) < within);
    assert_true(fabs(2 * asin(ldexp(found.rotation_q30[2], -30)) - angle) < within);
    assert_true(fabs(found_gain[0] * gain - 1) < within && found_gain[0] == found_gain[2]);
    assert_true(found.width == 64 && found.fx_q16 == camera.fx_q16 && found.rotation_q30[1] == 0);
}

TEST(test_no_views_no_correction)
{
    const corrected_views none = {.unit = 2};
    double gain[3];
    const t3r_camera camera = camera_at(3, 0.1), found = corrected_views_camera(&none, &camera, gain);
    assert_memory_equal(&found, &camera, sizeof camera);
    assert_true(gain[0] == 1 && gain[1] == 1 && gain[2] == 1);
}

TEST(test_what_all_views_have)
{
    corrected_views views = {.unit = 2};
    for (int i = 0; i < 5; i++) {
        add(&views, i, 0.01, 0.02, 1.25);
    }
    expect(&views, 1.7, 0.01, 0.02, 1.25, 1e-6);
    expect(&views, 100, 0.01, 0.02, 1.25, 1e-6);
}

TEST(test_its_own_where_a_view_stands)
{
    corrected_views views = {.unit = 2};
    add(&views, 0, 0.01, 0.02, 1.25);
    add(&views, 1, -0.02, 0.05, 0.75);
    add(&views, 2, 0.03, -0.01, 1);
    expect(&views, 0, 0.01, 0.02, 1.25, 1e-6);
    expect(&views, 1, -0.02, 0.05, 0.75, 1e-6);
    expect(&views, 2, 0.03, -0.01, 1, 1e-6);
}

TEST(test_between_views_of_the_nearest)
{
    corrected_views views = {.unit = 2};
    add(&views, 0, 0.01, 0.02, 1.5);
    add(&views, 1, 0.03, 0.06, 0.5);
    add(&views, 100, -0.5, -4, 1.75);
    expect(&views, 0.5, 0.02, 0.04, 1, 1e-3);
}

/* A turn counts, too: of views at one place that look elsewhere, the one that looks alike decides most. */
TEST(test_a_turn_is_a_distance)
{
    corrected_views views = {.unit = 2};
    add(&views, 0, 0.01, 0, 1.5);
    add(&views, 0, 0.03, 0, 0.5);
    add(&views, 0, 0.03, 0, 0.5);
    views.given[1] = views.given[2] = camera_at(0, 0.3);
    views.used[1] = views.used[2] = camera_at(0, 0.33);
    expect(&views, 0, 0.01, 0, 1.5, 1e-6);
    const t3r_camera near_it = camera_at(0, 0.1);
    double gain[3];
    const t3r_camera found = corrected_views_camera(&views, &near_it, gain);
    const double turned = 2 * asin(ldexp(found.rotation_q30[2], -30)) - 0.1;
    assert_true(turned > 0.01 && turned < 0.02);
}

TEST(test_exposure_is_clamped)
{
    uint8_t rgb[6] = {0, 100, 200, 1, 10, 255};
    const double gain[3] = {2, 1.5, 1.3};
    corrected_views_expose(rgb, 2, gain);
    const uint8_t expected[6] = {0, 150, 255, 2, 15, 255};
    assert_memory_equal(rgb, expected, sizeof expected);
}
