/* SPDX-License-Identifier: Apache-2.0 */
/* The rule of `eval --views`: distances of views, the median depth, the chosen frames. */
#include <math.h>
#include <string.h>

#include "reconstruction/context/nearest_views.h"
#include "test.h"

#define ONE_Q32 (INT64_C(1) << 32)
#define ONE_Q30 (INT32_C(1) << 30)

/* Returns a place at x world units, looking `degrees` to the right of +z. */
static view_place place_at(double x, double degrees)
{
    double half = degrees * acos(-1) / 360;
    t3r_camera camera = {.position_q32 = {(int64_t)ldexp(x, 32), 0, 0},
                         .rotation_q30 = {(int32_t)ldexp(cos(half), 30), 0, (int32_t)ldexp(sin(half), 30), 0}};
    return view_place_of(&camera);
}

TEST(test_place_of_a_camera)
{
    view_place ahead = place_at(-2.5, 0), right = place_at(0, 90);
    assert_true(ahead.usable);
    assert_true(ahead.position_q32[0] == -5 * ONE_Q32 / 2 && ahead.position_q32[1] == 0);
    assert_int_equal(ahead.axis_q30[2], ONE_Q30);
    assert_in_range(right.axis_q30[0], ONE_Q30 - 4, ONE_Q30);
    assert_in_range(right.axis_q30[2] + 4, 0, 8);
}

TEST(test_distance)
{
    view_place a = place_at(0, 0), b = place_at(3, 0), c = place_at(0, 60), d = place_at(3, 60);
    assert_true(view_distance(&a, &a, 1) == 0);
    assert_true(view_distance(&a, &b, 2) == 1.5);
    assert_true(fabs(view_distance(&a, &c, 2) - 1) < 1e-6); /* the chord of 60 degrees */
    assert_true(fabs(view_distance(&a, &d, 4) - 1.25) < 1e-6);
    assert_true(view_distance(&a, &d, 4) == view_distance(&d, &a, 4));
    t3r_camera rolled = {.rotation_q30 = {0, 0, 0, ONE_Q30}};
    view_place e = view_place_of(&rolled);
    assert_true(view_distance(&a, &e, 2) == 0);
    /* the largest possible distance of positions */
    view_place least = a, most = a;
    least.position_q32[0] = 1 - (INT64_C(1) << 62);
    most.position_q32[0] = (INT64_C(1) << 62) - 1;
    assert_true(fabs(view_distance(&least, &most, 1) - 0x1p31) < 1);
}

TEST(test_median_depth)
{
    uint8_t bytes[2 * 12] = {0};
    const uint16_t steps[4][2] = {{0, 500}, {3000, 0}, {65535, 1000}, {0, 0}};
    for (int i = 0; i < 8; i++) {
        bytes[6 * (i / 2) + 2 * (i % 2)] = (uint8_t)(steps[i / 2][i % 2] & 255);
        bytes[6 * (i / 2) + 2 * (i % 2) + 1] = (uint8_t)(steps[i / 2][i % 2] >> 8);
        bytes[6 * (i / 2) + 4] = 77; /* outside the picture */
    }
    t3r_frame frame = {.depth = bytes,
                       .depth_width = 2,
                       .depth_height = 4,
                       .depth_stride_bytes = 6,
                       .depth_unit_q40 = UINT64_C(1) << 38};
    assert_true(view_median_depth(&frame) == 250); /* the lower median of 500 1000 3000 65535 */
    frame.depth_height = 2;
    assert_true(view_median_depth(&frame) == 125);
    memset(bytes, 0, sizeof bytes);
    assert_true(view_median_depth(&frame) == 0);
    memset(bytes, 255, sizeof bytes);
    assert_true(view_median_depth(&frame) == 65535 / 4.0);
}

TEST(test_nearest_frames)
{
    /*                       0               1               2               3                4 */
    view_place places[] = {place_at(4, 0),  place_at(1, 0),    place_at(0, 0),  place_at(-1, 0),
                           place_at(0, 20), place_at(0.2, 90), place_at(0.1, 0)};
    const uint32_t count = sizeof places / sizeof places[0];
    uint32_t context[8] = {0, 3};
    /* at depth 2: 4 (0.35), 1 and 3 (0.5), 5 (1.4), 0 (2); 6 has no depth */
    places[6].usable = false;
    assert_int_equal(nearest_views(places, count, 2, 2, 5, context, 2), 5);
    const uint32_t expected[] = {0, 3, 4, 1, 5};
    assert_memory_equal(context, expected, sizeof expected);
    /* a far scene: rotated cameras come last; of equal ones the first */
    assert_int_equal(nearest_views(places, count, 2, 1000, 8, context, 0), 5);
    const uint32_t turned[] = {1, 3, 0, 4, 5};
    assert_memory_equal(context, turned, sizeof turned);
    /* no more than requested; existing ones stay */
    context[0] = 5;
    assert_int_equal(nearest_views(places, count, 2, 2, 1, context, 1), 1);
    assert_int_equal(context[0], 5);
    assert_int_equal(nearest_views(places, count, 2, 2, 2, context, 1), 2);
    assert_int_equal(context[1], 4);
}
