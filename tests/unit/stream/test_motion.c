/* SPDX-License-Identifier: Apache-2.0 */
/* Rigid motions of cameras and of the map, against real numbers. */
#include "unit/unit.h"

#include <math.h>

#include "core/camera.h"
#include "core/scene_frame.h"
#include "stream/motion.h"

static const double ONE_Q30 = 1073741824.0, ONE_Q32 = 4294967296.0;

static t3r_camera camera_at(double x, double y, double z, double turn, double tilt, double norm)
{
    t3r_camera camera = {.fx_q16 = 100 << 16, .fy_q16 = 100 << 16};
    const double at[3] = {x, y, z},
                 q[4] = {cos(turn) * cos(tilt), sin(tilt) * cos(turn), sin(turn) * cos(tilt), -sin(turn) * sin(tilt)};
    for (int i = 0; i < 3; i++) {
        camera.position_q32[i] = llround(at[i] * ONE_Q32);
    }
    for (int i = 0; i < 4; i++) {
        camera.rotation_q30[i] = (int32_t)lround(q[i] * norm * ONE_Q30);
    }
    assert_int_equal(t3r_camera_check(&camera, 8, 8), T3R_OK);
    return camera;
}

static double off(const t3r_camera *a, const t3r_camera *b)
{
    int32_t ra_q30[9], rb_q30[9];
    double most = 0;
    t3r_camera_rotation(a->rotation_q30, ra_q30);
    t3r_camera_rotation(b->rotation_q30, rb_q30);
    for (int i = 0; i < 9; i++) {
        most = fmax(most, fabs((ra_q30[i] - (double)rb_q30[i]) / ONE_Q30));
    }
    for (int i = 0; i < 3; i++) {
        most = fmax(most, fabs((double)(a->position_q32[i] - b->position_q32[i]) / ONE_Q32));
    }
    return most;
}

/* The motion from one camera to another takes the first to the second, and back again. */
TEST(from_camera_to_camera)
{
    for (int32_t exponent = -15; exponent <= 6; exponent += 3) {
        const double unit = ldexp(1, exponent);
        const t3r_scene_frame frame = {{INT64_C(5) << 32, -(INT64_C(3) << 32), 7}, exponent};
        const t3r_camera a = camera_at(5 + unit, -3, unit / 3, 0.2, -0.5, 0.6);
        const t3r_camera b = camera_at(5 - 2 * unit, -3 + unit, 0, -1.3, 0.9, 1.4);
        t3r_motion there, back;
        assert_true(t3r_motion_between(&a, &b, &frame, &there) && t3r_motion_between(&b, &a, &frame, &back));
        t3r_camera moved = a;
        t3r_move_camera(&there, &frame, &moved);
        assert_true(off(&moved, &b) < 4e-6 * fmax(unit, 1));
        t3r_move_camera(&back, &frame, &moved);
        assert_true(off(&moved, &a) < 4e-6 * fmax(unit, 1));
    }
}

/* A camera that leaves the range of positions stops at its bound, and is out of the frame's range. */
TEST(a_camera_that_leaves)
{
    const t3r_scene_frame frame = {{T3R_MAX_POSITION_Q32 - 1, 0, 0}, T3R_EXPONENT_MOST};
    t3r_camera from = camera_at(0, 0, 0, 0, 0, 1), to = from, camera = from;
    t3r_motion motion;
    t3r_pose pose;
    from.position_q32[0] = to.position_q32[0] = camera.position_q32[0] = frame.origin_q32[0];
    assert_true(t3r_motion_between(&from, &to, &frame, &motion));
    motion.to_q20[0] = T3R_POSITION_MOST_Q20;
    motion.to_q20[1] = -T3R_POSITION_MOST_Q20;
    t3r_move_camera(&motion, &frame, &camera);
    assert_int_equal(t3r_camera_check(&camera, 8, 8), T3R_OK);
    assert_int_equal(t3r_pose_in_scene(&camera, &frame, &pose), T3R_ERR_CAMERA);
}

/* Cameras of a restored arena may be anything: those that are not valid or far away have no motion, and stay. */
TEST(any_cameras)
{
    const t3r_scene_frame frame = {{0, 0, 0}, 0};
    const t3r_camera valid = camera_at(0, 0, 0, 0.1, 0.2, 1), far = camera_at(5000, 0, 0, 0, 0, 1);
    const t3r_camera broken = {.fx_q16 = 100 << 16, .fy_q16 = 100 << 16};
    const t3r_camera *cameras[] = {&valid, &far, &broken};
    t3r_motion motion;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            assert_int_equal(t3r_motion_between(cameras[i], cameras[k], &frame, &motion), i + k == 0);
        }
    }
    assert_true(t3r_motion_between(&valid, &valid, &frame, &motion));
    for (int i = 1; i < 3; i++) {
        t3r_camera moved = *cameras[i];
        t3r_move_camera(&motion, &frame, &moved);
        assert_memory_equal(&moved, cameras[i], sizeof moved);
    }
}

/* Gaussians move and turn: position and covariance are those of real numbers, and what leaves the range is dropped. */
TEST(the_map_moves)
{
    const t3r_scene_frame frame = {{0, 0, 0}, 0};
    const t3r_camera a = camera_at(0.5, -0.25, 2, 0.4, 0.1, 1), b = camera_at(-1, 0.75, 1, -0.7, 0.6, 1);
    t3r_motion motion;
    assert_true(t3r_motion_between(&a, &b, &frame, &motion));
    t3r_gaussian g[2] = {{.position_q20 = {1 << 20, -(3 << 19), 5 << 18},
                          .factor = {16000, -700, 3, 250, 9000, -4000, 11, 12, 13000},
                          .factor_exponent = -20}};
    t3r_map_record records[2] = {{.key = 7}, {.key = 9}};
    g[1] = g[0];
    g[1].position_q20[0] = T3R_POSITION_MOST_Q20 - 1;
    g[1].position_q20[1] = g[1].position_q20[2] = T3R_POSITION_MOST_Q20 - 1;
    t3r_map map = {g, records, 2};
    const t3r_gaussian old = g[0];
    t3r_move_map(&motion, &map);
    assert_int_equal(map.count, 1);
    assert_int_equal(records[0].key, 7);
    double r[9] = {0}, f[9], want[9];
    int32_t from_q30[9], to_q30[9];
    t3r_camera_rotation(a.rotation_q30, from_q30);
    t3r_camera_rotation(b.rotation_q30, to_q30);
    for (int i = 0; i < 9; i++) {
        for (int k = 0; k < 3; k++) { /* the second rotation times the first one's transpose */
            r[i] += to_q30[i / 3 * 3 + k] / ONE_Q30 * (from_q30[i % 3 * 3 + k] / ONE_Q30);
        }
        f[i] = ldexp(old.factor[i], old.factor_exponent);
    }
    for (int i = 0; i < 3; i++) {
        double at = motion.to_q20[i];
        for (int k = 0; k < 3; k++) {
            at += r[3 * i + k] * (old.position_q20[k] - (double)motion.from_q20[k]);
            want[3 * i + k] = r[3 * i] * f[k] + r[3 * i + 1] * f[3 + k] + r[3 * i + 2] * f[6 + k];
        }
        assert_true(fabs(at - g[0].position_q20[i]) <= 1);
    }
    for (int i = 0; i < 9; i++) {
        assert_true(fabs(ldexp(g[0].factor[i], g[0].factor_exponent) - want[i]) < 16000 * ldexp(1, -20) / 8192);
    }
}
