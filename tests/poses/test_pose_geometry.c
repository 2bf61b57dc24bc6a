/* SPDX-License-Identifier: Apache-2.0 */
/* The geometry under pose estimation, on exact numbers: five points, resection, triangulation, rounding. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/camera.h"
#include "posing/estimate.h"
#include "posing/five_point.h"
#include "posing/relative.h"
#include "posing/resection.h"

static uint32_t state = 1;

/* -1 .. 1 */
static double uniform(void)
{
    state = state * 1664525u + 1013904223u;
    return (double)(state >> 8) / 0x800000 - 1;
}

static motion some_motion(double turn, double far)
{
    motion m;
    const double about[3] = {turn * uniform(), turn * uniform(), turn * uniform()};
    rotation_about(about, m.r);
    for (int i = 0; i < 3; i++) {
        m.t[i] = far * uniform();
    }
    return m;
}

/* Draws a point in front of both cameras, and the rays on which they see it. */
static void some_point(const motion *m, double point[3], double ray_a[2], double ray_b[2])
{
    double p[3];
    do {
        point[2] = 3 + uniform();
        point[0] = uniform() * point[2] / 2;
        point[1] = uniform() * point[2] / 2;
        motion_apply(m, point, p);
    } while (p[2] < 0.5);
    for (int i = 0; i < 2; i++) {
        ray_a[i] = point[i] / point[2];
        ray_b[i] = p[i] / p[2];
    }
}

static void test_rotations(void **unused)
{
    (void)unused;
    for (int trial = 0; trial < 500; trial++) {
        motion m = some_motion(trial % 2 == 0 ? 1.7 : 1e-6, 1), back = motion_inverse(&m),
               none = motion_after(&back, &m);
        assert_true(fabs(determinant3(m.r) - 1) < 1e-12);
        assert_true(rotation_angle(none.r, motion_none.r) < 1e-7 && norm3(none.t) < 1e-12);
        const double v[3] = {0.3 * uniform(), 0.3 * uniform(), 0.3 * uniform()};
        rotation_about(v, m.r);
        assert_true(fabs(rotation_angle(m.r, motion_none.r) - norm3(v)) < 1e-9);
    }
}

/* One of the solutions is the motion that made the rays; all satisfy their equations. */
static void test_five_points(void **unused)
{
    (void)unused;
    int missed = 0;
    for (int trial = 0; trial < 300; trial++) {
        motion m = some_motion(0.4, 1);
        double rays_a[5][2], rays_b[5][2], point[3], essentials[FIVE_POINT_MOST][9], best = 1;
        for (int i = 0; i < 5; i++) {
            some_point(&m, point, rays_a[i], rays_b[i]);
        }
        int count = five_point(rays_a, rays_b, essentials);
        for (int e = 0; e < count; e++) {
            double size = 0;
            for (int k = 0; k < 9; k++) {
                size += essentials[e][k] * essentials[e][k];
            }
            for (int i = 0; i < 5; i++) {
                assert_true(fabs(epipolar_error(essentials[e], rays_a[i], rays_b[i], 1)) < 1e-6);
            }
            assert_true(fabs(determinant3(essentials[e])) < 1e-5 * pow(size, 1.5));
            motion four[4];
            assert_int_equal(essential_motions(essentials[e], four), 0);
            for (int i = 0; i < 4; i++) {
                best = fmin(best, rotation_angle(four[i].r, m.r) + direction_angle(four[i].t, m.t));
            }
        }
        missed += best > 1e-4;
    }
    assert_true(missed <= 3); /* nearly degenerate sets of five */
}

static void test_five_points_on_a_line_have_none(void **unused)
{
    (void)unused;
    double rays[5][2], essentials[FIVE_POINT_MOST][9];
    memset(rays, 0, sizeof rays);
    assert_int_equal(five_point(rays, rays, essentials), 0);
}

static void test_triangulation(void **unused)
{
    (void)unused;
    for (int trial = 0; trial < 500; trial++) {
        motion m = some_motion(0.3, 1);
        double point[3], ray_a[2], ray_b[2], depth_a, depth_b, p[3];
        some_point(&m, point, ray_a, ray_b);
        motion_apply(&m, point, p);
        assert_true(relative_triangulate(&m, ray_a, ray_b, &depth_a, &depth_b));
        assert_true(fabs(depth_a - point[2]) < 1e-6 && fabs(depth_b - p[2]) < 1e-6);
        for (int i = 0; i < 3; i++) {
            m.t[i] = -m.t[i]; /* the rays then meet behind the cameras */
        }
        assert_false(relative_triangulate(&m, ray_a, ray_b, &depth_a, &depth_b));
    }
}

static void test_resection(void **unused)
{
    (void)unused;
    enum { COUNT = 300 };
    static double points[COUNT][3], rays[COUNT][2];
    for (int trial = 0; trial < 30; trial++) {
        motion m = some_motion(0.8, 1.5), camera, back = motion_inverse(&m);
        double ray[2], error;
        for (int i = 0; i < COUNT; i++) {
            some_point(&m, points[i], ray, rays[i]);
            for (int k = 0; k < 3 && i % 4 == 0; k++) {
                points[i][k] += 2 * uniform(); /* a quarter is wrong */
            }
        }
        assert_int_equal(resect((const double(*)[3])points, (const double(*)[2])rays, COUNT, &camera, &error), 0);
        assert_true(error < 1e-6);
        assert_true(rotation_angle(camera.r, back.r) < 1e-5);
        for (int i = 0; i < 3; i++) {
            assert_true(fabs(camera.t[i] - back.t[i]) < 1e-5);
        }
        assert_int_equal(resect((const double(*)[3])points, (const double(*)[2])rays, 15, &camera, &error), -1);
    }
    memset(points, 0, sizeof points);
    motion camera;
    double error;
    assert_int_equal(resect((const double(*)[3])points, (const double(*)[2])rays, COUNT, &camera, &error), -1);
}

/* The stored pose is the estimated one up to rounding, composed with the first camera's own. */
static void test_storing(void **unused)
{
    (void)unused;
    for (int trial = 0; trial < 200; trial++) {
        motion first = some_motion(2, 1000), pose = some_motion(2, 10), world = motion_after(&first, &pose);
        t3r_camera origin = {.rotation_q30 = {1 << 30}}, base, out;
        assert_int_equal(pose_store(&first, &origin, &base), 0);
        assert_int_equal(pose_store(&pose, &base, &out), 0);
        int32_t rotation[9];
        t3r_camera_rotation(out.rotation_q30, rotation);
        for (int i = 0; i < 9; i++) {
            assert_true(fabs(ldexp(rotation[i], -30) - world.r[i]) < 1e-8);
        }
        for (int i = 0; i < 3; i++) {
            assert_true(fabs(ldexp((double)out.position_q32[i], -32) - world.t[i]) < 1e-7);
        }
    }
    t3r_camera origin = {.rotation_q30 = {1 << 30}}, out;
    motion far = motion_none;
    far.t[1] = 1e10;
    assert_int_equal(pose_store(&far, &origin, &out), -1);
    far.t[1] = NAN;
    assert_int_equal(pose_store(&far, &origin, &out), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rotations),
        cmocka_unit_test(test_five_points),
        cmocka_unit_test(test_five_points_on_a_line_have_none),
        cmocka_unit_test(test_triangulation),
        cmocka_unit_test(test_resection),
        cmocka_unit_test(test_storing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
