/* SPDX-License-Identifier: Apache-2.0 */
/* The scene's frame: poses and depth steps in scene units, against exact arithmetic. */
#include "unit/unit.h"

#include "core/camera.h"
#include "core/fixed.h"
#include "core/scene_frame.h"

enum { REFUSED = INT32_MIN };

/* Returns the position of a camera at that place, along each axis in turn. */
static int32_t placed(int64_t position_q32, int64_t origin_q32, int32_t exponent)
{
    int32_t got[3];
    for (int axis = 0; axis < 3; axis++) {
        t3r_camera camera = {.fx_q16 = 100 << 16, .fy_q16 = 100 << 16, .rotation_q30 = {1 << 30}};
        t3r_scene_frame frame = {.exponent = exponent};
        t3r_pose pose = {.position_q20 = {7, 7, 7}};
        camera.position_q32[axis] = position_q32;
        frame.origin_q32[axis] = origin_q32;
        assert_int_equal(t3r_camera_check(&camera, 8, 8), T3R_OK);
        const t3r_status status = t3r_pose_in_scene(&camera, &frame, &pose);
        assert_true(status == T3R_OK || status == T3R_ERR_CAMERA);
        got[axis] = status == T3R_OK ? pose.position_q20[axis] : REFUSED;
        for (int i = 0; status == T3R_OK && i < 3; i++) {
            assert_true(i == axis || pose.position_q20[i] == 0);
        }
    }
    assert_true(got[0] == got[1] && got[0] == got[2]);
    return got[0];
}

/* Offsets that a double holds exactly, times powers of two. */
TEST(positions)
{
    uint64_t seed = 3;
    for (int turn = 0; turn < 20000; turn++) {
        const int32_t exponent = turn % (T3R_EXPONENT_MOST - T3R_EXPONENT_LEAST + 1) + T3R_EXPONENT_LEAST;
        const int64_t most = INT64_C(1) << unit_between(&seed, 0, 52);
        const int64_t offset = turn % 8 == 0 ? most : unit_between(&seed, -most, most);
        const int64_t origin = unit_between(&seed, -(INT64_C(1) << 61), INT64_C(1) << 61);
        const double exact = floor(ldexp((double)offset, -12 - exponent) + 0.5);
        assert_int_equal(placed(origin + offset, origin, exponent),
                         fabs(exact) <= T3R_POSITION_MOST_Q20 ? (int32_t)exact : REFUSED);
    }
}

TEST(bounds_of_positions)
{
    const int64_t most = T3R_POSITION_MOST_Q20;
    for (int sign = -1; sign <= 1; sign += 2) {
        assert_int_equal(placed(sign * most, 0, -12), sign * most);
        assert_int_equal(placed(sign * (most + 1), 0, -12), REFUSED);
        assert_int_equal(placed(sign * (most >> 1), 0, -13), sign * most);
        assert_int_equal(placed(sign * ((most >> 1) + 1), 0, -13), REFUSED);
        assert_int_equal(placed(sign * (most << 24), 0, 12), sign * most);
        /* 2^61 in Q32 before scaling */
        const int64_t far = INT64_C(1) << 61;
        assert_int_equal(placed(sign * (far - 1), 0, 24), sign * (1 << 25));
        assert_int_equal(placed(sign * far, 0, 24), REFUSED);
        assert_int_equal(placed(sign * (T3R_MAX_POSITION_Q32 - 1), -sign * (T3R_MAX_POSITION_Q32 - 1), 24), REFUSED);
        /* so far that the scaled value would exceed 64 bits */
        assert_int_equal(placed(sign * (INT64_C(1) << 52), 0, -24), REFUSED);
        assert_int_equal(placed(sign * (far - 1), 0, -24), REFUSED);
    }
}

TEST(turned)
{
    t3r_camera camera = {.rotation_q30 = {1 << 29, 1 << 29, -(1 << 29), 3 << 28}};
    const t3r_scene_frame frame = {.exponent = 3};
    t3r_pose pose;
    int32_t rotation_q30[9];
    t3r_camera_rotation(camera.rotation_q30, rotation_q30);
    assert_int_equal(t3r_pose_in_scene(&camera, &frame, &pose), T3R_OK);
    assert_memory_equal(pose.rotation_q30, rotation_q30, sizeof rotation_q30);
}

/* A unit's 32 highest bits, and raw steps times them in scene units: a double holds the product exactly. */
TEST(depth_steps)
{
    uint64_t seed = 6;
    for (int turn = 0; turn < 64 * 49 * 4; turn++) {
        const uint64_t noise = unit_random(&seed);
        const int top = turn % 64, exponent = turn / 64 % 49 - 24;
        const uint64_t lowest = UINT64_C(1) << top,
                       unit_q40 = turn / 64 / 49 == 0 ? lowest : lowest | (noise & (lowest - 1));
        const uint64_t held = unit_q40 & ~(top > 31 ? (UINT64_C(1) << (top - 31)) - 1 : 0);
        const t3r_depth_scale scale = t3r_depth_scale_of(unit_q40, exponent);
        assert_true(scale.mantissa >> 31 == 1 && scale.shift <= 62);
        const uint16_t raws[] = {0, 1, 2, 1000, (uint16_t)(noise >> 48), UINT16_MAX};
        for (size_t i = 0; i < sizeof raws / sizeof raws[0]; i++) {
            const double exact = floor(ldexp((double)held * raws[i], -20 - exponent) + 0.5);
            assert_int_equal(t3r_depth_q20(scale, raws[i]), (int32_t)fmin(exact, T3R_POSITION_MOST_Q20 - 1));
        }
    }
}

/* The same units the other way round, from depths at the ends of their range and in between. */
TEST(steps_up_to_a_depth)
{
    uint64_t seed = 7;
    for (int turn = 0; turn < 63 * 1024; turn++) {
        const uint32_t noise = (uint32_t)unit_random(&seed), shift = (uint32_t)turn % 63;
        const t3r_depth_scale scale = {turn % 5 == 0 ? 1u << 31 : turn % 5 == 1 ? UINT32_MAX : noise | 1u << 31, shift};
        const uint32_t most[] = {0, 1, 2, INT32_MAX, (uint32_t)unit_random(&seed) >> (1 + turn / 63 % 31)};
        for (size_t i = 0; i < sizeof most / sizeof most[0]; i++) {
            const uint64_t whole = ((uint64_t)most[i] << (shift < 32 ? shift : 32)) / scale.mantissa;
            const uint64_t steps = whole << (shift < 32 ? 0 : shift - 32);
            assert_int_equal(t3r_depth_steps(scale, most[i]), (uint32_t)(steps < 65535 ? steps : 65535));
        }
    }
}
