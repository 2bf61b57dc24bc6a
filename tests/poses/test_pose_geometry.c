/* SPDX-License-Identifier: Apache-2.0 */
/* The geometry under pose estimation, on exact numbers: inverses, resection, rounding. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "posing/estimate.h"
#include "posing/opencv_module.h"
#include "rigid_errors.h"
#include "test.h"

static uint32_t seed = 1;

/* -1 .. 1 */
static double uniform(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (double)(seed >> 8) / 0x800000 - 1;
}

static rigid some_motion(double turn, double far)
{
    const double about[3] = {turn * uniform(), turn * uniform(), turn * uniform()};
    rigid m = rotation_about(about);
    for (int i = 0; i < 3; i++) {
        m.position[i] = far * uniform();
    }
    return m;
}

/* A place before both cameras, and the ray on which the second one sees it. */
static void some_point(const rigid *m, double point[3], double ray[2])
{
    double p[3];
    do {
        point[2] = 3 + uniform();
        point[0] = uniform() * point[2] / 2;
        point[1] = uniform() * point[2] / 2;
        rigid_apply(m, point, p);
    } while (p[2] < 0.5);
    for (int i = 0; i < 2; i++) {
        ray[i] = p[i] / p[2];
    }
}

TEST(test_inverse)
{
    for (int trial = 0; trial < 500; trial++) {
        rigid m = some_motion(trial % 2 == 0 ? 1.7 : 1e-6, 1), back = rigid_inverse(&m),
              none = rigid_compose(&back, &m);
        assert_true(radians_turned(&none, &rigid_identity) < 1e-12 && length_of(none.position) < 1e-12);
    }
}

TEST(test_resection)
{
    enum { COUNT = 300 };
    static double points[COUNT][3], rays[COUNT][2];
    char error[512] = "";
    const pose_module *module = pose_module_load(error, sizeof error);
    if (module == NULL) {
        fail_msg("%s", error);
    }
    rigid camera;
    double off;
    for (int trial = 0; trial < 30; trial++) {
        rigid m = some_motion(0.8, 1.5), back = rigid_inverse(&m);
        for (int i = 0; i < COUNT; i++) {
            some_point(&m, points[i], rays[i]);
            for (int k = 0; k < 3 && i % 4 == 0; k++) {
                points[i][k] += 2 * uniform(); /* a quarter is wrong */
            }
        }
        assert_int_equal(module->resect((const double(*)[3])points, (const double(*)[2])rays, COUNT, 1e-4, &camera,
                                        &off, error, sizeof error),
                         0);
        assert_true(off < 1e-5);
        assert_true(radians_turned(&camera, &back) < 1e-5);
        for (int i = 0; i < 3; i++) {
            assert_true(fabs(camera.position[i] - back.position[i]) < 1e-5);
        }
        assert_int_equal(module->resect((const double(*)[3])points, (const double(*)[2])rays, 15, 1e-4, &camera, &off,
                                        error, sizeof error),
                         -1);
    }
    memset(points, 0, sizeof points);
    assert_int_equal(module->resect((const double(*)[3])points, (const double(*)[2])rays, COUNT, 1e-4, &camera, &off,
                                    error, sizeof error),
                     -1);
    assert_non_null(strstr(error, "do not lie on the pixels' rays"));
}

/* The stored pose equals the given one but for rounding, in the world of the first camera. */
TEST(test_storing)
{
    for (int trial = 0; trial < 200; trial++) {
        rigid first = some_motion(2, 1000), pose = some_motion(2, 10), world = rigid_compose(&first, &pose);
        t3r_camera origin = {.rotation_q30 = {1 << 30}}, base, out;
        assert_int_equal(pose_store(&first, &origin, &base), 0);
        assert_int_equal(pose_store(&pose, &base, &out), 0);
        rigid stored = rigid_identity;
        for (int i = 0; i < 4; i++) {
            stored.rotation[i] = ldexp(out.rotation_q30[i], -30);
        }
        assert_true(radians_turned(&stored, &world) < 1e-8);
        for (int i = 0; i < 3; i++) {
            assert_true(fabs(ldexp((double)out.position_q32[i], -32) - world.position[i]) < 1e-7);
        }
    }
    t3r_camera origin = {.rotation_q30 = {1 << 30}}, out;
    rigid far = rigid_identity;
    far.position[1] = 1e10;
    assert_int_equal(pose_store(&far, &origin, &out), -1);
    far.position[1] = NAN;
    assert_int_equal(pose_store(&far, &origin, &out), -1);
}
