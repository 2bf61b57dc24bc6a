/* SPDX-License-Identifier: Apache-2.0 */
/* Cameras of other programs: conventions of poses, crops and sizes, and the numbers that no camera can have. */
#include <math.h>
#include <string.h>

#include "test.h"
#include "trim3r_host.h"

#define NEAR 1e-12

static const t3r_recorded_camera lens = {
    .width = 640, .height = 480, .fx = 500, .fy = 510, .cx = 319.5, .cy = 239.5, .rotation = {1, 0, 0, 0}};

/* A camera at (1, 2, 3) that was turned by a quarter about the world's z: its x is the world's y. */
static const double quarter[16] = {0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1};

static void assert_close(const double *a, const double *b, int count)
{
    for (int i = 0; i < count; i++) {
        assert_true(fabs(a[i] - b[i]) < NEAR);
    }
}

/* Turns a vector of the camera's axes to the world's. */
static void turned(const double q[4], const double v[3], double out[3])
{
    const double w = q[0], *u = q + 1;
    double t[3];
    for (int i = 0; i < 3; i++) {
        t[i] = 2 * (u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3]);
    }
    for (int i = 0; i < 3; i++) {
        out[i] = v[i] + w * t[i] + u[(i + 1) % 3] * t[(i + 2) % 3] - u[(i + 2) % 3] * t[(i + 1) % 3];
    }
}

/* Asserts that each axis of the camera lies in the world where a column of the matrix says; OpenGL's y and z point the
 * other way. */
static void assert_axes(const t3r_recorded_camera *camera, const double matrix[16], double sign)
{
    for (int axis = 0; axis < 3; axis++) {
        double unit[3] = {0}, found[3], wanted[3];
        unit[axis] = 1;
        turned(camera->rotation, unit, found);
        for (int i = 0; i < 3; i++) {
            wanted[i] = (axis > 0 ? sign : 1) * matrix[4 * i + axis];
        }
        assert_close(found, wanted, 3);
    }
}

TEST(a_matrix_is_a_pose_in_each_convention)
{
    static const double there[3] = {1, 2, 3};
    t3r_recorded_camera camera = lens;
    char error[256];
    assert_int_equal(t3r_camera_pose_matrix(&camera, quarter, T3R_AXES_OPENCV, error, sizeof error), T3R_OK);
    assert_axes(&camera, quarter, 1);
    assert_close(camera.position, there, 3);
    assert_int_equal(t3r_camera_pose_matrix(&camera, quarter, T3R_AXES_OPENGL, error, sizeof error), T3R_OK);
    assert_axes(&camera, quarter, -1);
    assert_close(camera.position, there, 3);
}

TEST(world_to_camera_is_the_inverse)
{
    /* the inverse of `quarter`: R^T, and -R^T t */
    static const double inverse[16] = {0, 1, 0, -2, -1, 0, 0, 1, 0, 0, 1, -3, 0, 0, 0, 1};
    static const double there[3] = {1, 2, 3};
    t3r_recorded_camera camera = lens;
    for (uint32_t axes = T3R_AXES_OPENCV; axes <= T3R_AXES_OPENGL; axes++) {
        assert_int_equal(t3r_camera_pose_matrix(&camera, inverse, axes | T3R_WORLD_TO_CAMERA, NULL, 0), T3R_OK);
        assert_axes(&camera, quarter, axes == T3R_AXES_OPENGL ? -1 : 1);
        assert_close(camera.position, there, 3);
    }
}

TEST(a_quaternion_is_the_same_pose_as_its_matrix)
{
    const double half = sqrt(0.5), there[3] = {1, 2, 3}, rotation[4] = {half, 0, 0, half};
    for (uint32_t axes = 0; axes <= (T3R_AXES_OPENGL | T3R_WORLD_TO_CAMERA); axes++) {
        t3r_recorded_camera one = lens, other = lens;
        assert_int_equal(t3r_camera_pose_matrix(&one, quarter, axes, NULL, 0), T3R_OK);
        assert_int_equal(t3r_camera_pose_quaternion(&other, there, rotation, axes, NULL, 0), T3R_OK);
        assert_close(one.position, other.position, 3);
        for (int axis = 0; axis < 3; axis++) { /* q and -q are one rotation */
            double unit[3] = {0}, a[3], b[3];
            unit[axis] = 1;
            turned(one.rotation, unit, a);
            turned(other.rotation, unit, b);
            assert_close(a, b, 3);
        }
    }
}

TEST(a_pose_that_is_none_changes_nothing)
{
    static const struct {
        int entry;
        double value;
        const char *word;
    } wrong[] = {{0, NAN, "finite"}, {12, 1, "0 0 0 1"}, {5, 1.5, "rotation"}, {3, 1e12, "position"}};
    t3r_recorded_camera camera = lens;
    char error[256];
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        double matrix[16];
        memcpy(matrix, quarter, sizeof matrix);
        matrix[wrong[i].entry] = wrong[i].value;
        assert_int_equal(t3r_camera_pose_matrix(&camera, matrix, 0, error, sizeof error), T3R_ERR_CAMERA);
        assert_non_null(strstr(error, wrong[i].word));
    }
    const double origin[3] = {0}, none[4] = {0};
    assert_int_equal(t3r_camera_pose_quaternion(&camera, origin, none, 0, error, sizeof error), T3R_ERR_CAMERA);
    assert_int_equal(t3r_camera_pose_matrix(&camera, quarter, 4, error, sizeof error), T3R_ERR_CAMERA);
    assert_memory_equal(&camera, &lens, sizeof camera);
}

/* The pixel that a direction (x, y, 1) falls on, before and after, is the same place of the picture. */
TEST(a_crop_and_a_size_keep_what_a_pixel_sees)
{
    const t3r_crop crop = {100, 40, 320, 400};
    t3r_recorded_camera camera = lens;
    assert_int_equal(t3r_camera_crop(&camera, &crop, 160, 100, NULL, 0), T3R_OK);
    assert_true(camera.width == 160 && camera.height == 100);
    const double x = 0.1, y = -0.2;
    const double edge_x = (lens.fx * x + lens.cx + 0.5 - crop.x) * 160 / 320;
    const double edge_y = (lens.fy * y + lens.cy + 0.5 - crop.y) * 100 / 400;
    assert_true(fabs(camera.fx * x + camera.cx + 0.5 - edge_x) < NEAR);
    assert_true(fabs(camera.fy * y + camera.cy + 0.5 - edge_y) < NEAR);
    /* the middle of the whole picture stays the middle of a smaller one */
    t3r_recorded_camera half = lens;
    assert_int_equal(t3r_camera_crop(&half, &(t3r_crop){0, 0, 640, 480}, 320, 240, NULL, 0), T3R_OK);
    assert_true(fabs(half.cx - 159.5) < NEAR && fabs(half.cy - 119.5) < NEAR);
}

TEST(a_crop_outside_the_picture_is_refused)
{
    static const t3r_crop outside[] = {
        {0, 0, 0, 480}, {0, 0, 641, 480}, {1, 0, 640, 480}, {0, 1, 640, 480}, {UINT32_MAX, 0, 2, 2}};
    t3r_recorded_camera camera = lens;
    char error[256];
    for (size_t i = 0; i < sizeof outside / sizeof outside[0]; i++) {
        assert_int_equal(t3r_camera_crop(&camera, &outside[i], 64, 64, error, sizeof error), T3R_ERR_CAMERA);
        assert_non_null(strstr(error, "640x480"));
    }
    assert_int_equal(t3r_camera_crop(&camera, &(t3r_crop){0, 0, 640, 480}, 64, 0, error, sizeof error), T3R_ERR_CAMERA);
    assert_memory_equal(&camera, &lens, sizeof camera);
    camera.width = camera.height = 0;
    assert_int_equal(t3r_camera_crop(&camera, &(t3r_crop){0, 0, 640, 480}, 64, 64, NULL, 0), T3R_ERR_CAMERA);
}

TEST(fixed_point_rounds_and_names_what_is_out_of_range)
{
    t3r_recorded_camera camera = lens;
    t3r_camera fixed;
    char error[256];
    camera.position[1] = -0.25;
    assert_int_equal(t3r_camera_fixed(&camera, &fixed, error, sizeof error), T3R_OK);
    assert_string_equal(error, "");
    assert_true(fixed.width == 640 && fixed.height == 480);
    assert_int_equal(fixed.fx_q16, 500 << 16);
    assert_int_equal(fixed.cx_q16, 639 << 15);
    assert_int_equal(fixed.position_q32[1], -(INT64_C(1) << 30));
    assert_int_equal(fixed.rotation_q30[0], 1 << 30);
    camera.fy = 7.5;
    assert_int_equal(t3r_camera_fixed(&camera, &fixed, error, sizeof error), T3R_ERR_CAMERA);
    assert_non_null(strstr(error, "fl_y"));
}
