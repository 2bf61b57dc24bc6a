/* SPDX-License-Identifier: Apache-2.0 */
/* Pose files and trajectories. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "import/viewpoint.h"
#include "scratch.h"
#include "test.h"

#define ONE_Q30 (1 << 30)

static const char *path; /* in a folder of the test's own */

static int make_path(void **state)
{
    int failed = scratch_setup(state);
    path = failed ? NULL : scratch_path(*state, "file");
    return failed;
}

static void write_text(const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

#define IDENTITY "[[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]"

TEST(reads_a_pose)
{
    viewpoint_list list;
    char error[256] = "";
    write_text("{\"fl_x\": 200, \"cx\": 100.5, \"w\": 256, \"h\": 128, \"transform_matrix\": " IDENTITY "}");
    assert_int_equal(viewpoint_read_pose(path, 0, 0, &list, error, sizeof error), 0);
    assert_int_equal(list.count, 1);
    const t3r_camera *v = list.items;
    assert_true(v->width == 256 && v->height == 128);
    assert_int_equal(v->fx_q16, 200 << 16);
    assert_int_equal(v->fy_q16, 200 << 16);
    assert_int_equal(v->cx_q16, 100 << 16); /* from the corner to the first pixel's centre */
    assert_int_equal(v->cy_q16, (127 << 16) / 2);
    assert_true(v->position_q32[0] == INT64_C(1) << 32 && v->position_q32[2] == INT64_C(3) << 32);
    /* y up, z backward versus y down, z forward: half a turn around x */
    assert_true(abs(v->rotation_q30[0]) < 2 && abs(abs(v->rotation_q30[1]) - ONE_Q30) < 2);
    viewpoint_list_free(&list);
}

TEST(reads_all_frames_of_a_list)
{
    viewpoint_list list;
    char error[256] = "";
    write_text(
        "{\"fl_x\": 200, \"w\": 64, \"h\": 64, \"frames\": [{\"file_path\": \"a.png\", \"transform_matrix\": " IDENTITY
        "}, {\"file_path\": \"b.png\", \"transform_matrix\": " IDENTITY "}]}");
    assert_int_equal(viewpoint_read_pose(path, 0, 0, &list, error, sizeof error), 0);
    assert_int_equal(list.count, 2);
    viewpoint_list_free(&list);
    write_text(
        "{\"fl_x\": 200, \"w\": 64, \"h\": 64, \"frames\": [{\"file_path\": \"a.png\"}, {\"file_path\": \"b.png\", "
        "\"transform_matrix\": " IDENTITY "}, {\"file_path\": \"c.png\", \"k1\": 0.1, \"transform_matrix\": " IDENTITY
        "}]}");
    assert_int_equal(viewpoint_read_pose(path, 0, 0, &list, error, sizeof error), 0);
    assert_int_equal(list.count, 1);
    assert_int_equal(list.losses.count, 2);
    assert_ptr_equal(strstr(list.losses.first, "frames[0]: "), list.losses.first);
    viewpoint_list_free(&list);
}

TEST(refuses_bad_poses)
{
    static const struct {
        const char *text, *reason;
    } bad[] = {
        {"", "JSON"},
        {"[1, 2]", "object"},
        {"{\"fl_x\": 200, \"w\": 64, \"h\": 64}", "transform_matrix"},
        {"{\"fl_x\": 200, \"transform_matrix\": " IDENTITY "}", "w or h"},
        {"{\"w\": 64, \"h\": 64, \"transform_matrix\": " IDENTITY "}", "fl_x"},
        {"{\"fl_x\": \"wide\", \"w\": 64, \"h\": 64, \"transform_matrix\": " IDENTITY "}", "fl_x"},
        {"{\"fl_x\": 2, \"w\": 64, \"h\": 64, \"transform_matrix\": " IDENTITY "}", "range"},
        {"{\"fl_x\": 200, \"w\": 64, \"h\": 64, \"transform_matrix\": [[1,0,0,0],[0,1,0,0],[0,0,0,0],[0,0,0,1]]}",
         "transform_matrix"},
        {"{\"fl_x\": 200, \"w\": 64, \"h\": 64, \"transform_matrix\": [[1,0,0,2e9],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}",
         "2^30"},
        {"{\"fl_x\": 200, \"w\": 64, \"h\": 64, \"k1\": 0.1, \"transform_matrix\": " IDENTITY "}", "pinhole"},
        {"{\"fl_x\": 200, \"w\": 64, \"h\": 64, \"k1\": 0.1, \"camera_model\": \"OPENCV_FISHEYE\", "
         "\"transform_matrix\": " IDENTITY "}",
         "pinhole"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        viewpoint_list list;
        char error[512] = "";
        write_text(bad[i].text);
        assert_int_equal(viewpoint_read_pose(path, 0, 0, &list, error, sizeof error), -1);
        assert_null(list.items);
        if (strstr(error, bad[i].reason) == NULL || strstr(error, path) != error) {
            fail_msg("'%s' does not say '%s'", error, bad[i].reason);
        }
    }
}

TEST(reads_a_trajectory)
{
    t3r_camera lens;
    viewpoint_list list;
    char error[256] = "";
    assert_int_equal(viewpoint_from_angle(90, 200, 100, &lens), 0);
    assert_true(abs(lens.fx_q16 - (100 << 16)) < 2);
    write_text("# stamp tx ty tz qx qy qz qw\n\n0.0 1 2 3 0 0 0 1\r\n  0.1 -1 0 0.5 0 2 0 0");
    assert_int_equal(viewpoint_read_trajectory(path, &lens, &list, error, sizeof error), 0);
    assert_int_equal(list.count, 2);
    assert_int_equal(list.items[0].width, 200);
    assert_int_equal(list.items[0].rotation_q30[0], ONE_Q30);
    assert_true(list.items[1].position_q32[0] == -(INT64_C(1) << 32));
    assert_int_equal(list.items[1].rotation_q30[2], ONE_Q30); /* normalised */
    viewpoint_list_free(&list);
    write_text("nan 0 0 0 0 0 0 1\n0 1 2 3 0 0 0 1\n1 0 0 0 0 0 0 0\n2 0 0 inf 0 0 0 1\n");
    assert_int_equal(viewpoint_read_trajectory(path, &lens, &list, error, sizeof error), 0);
    assert_int_equal(list.count, 1);
    assert_int_equal(list.losses.count, 3);
    assert_string_equal(list.losses.first, "line 1: no time in seconds");
    viewpoint_list_free(&list);
}

TEST(refuses_bad_trajectories)
{
    static const struct {
        const char *text, *reason;
    } bad[] = {
        {"", "no pose"},
        {"# nothing\n", "no pose"},
        {"0 1 2 3 0 0 0\n", "line 1: not 'seconds"},
        {"0 1 2 3 0 0 0 1 9\n", "more than eight"},
        {"0 1 2 nan 0 0 0 1\n", "not finite"},
        {"0 1 2 3 0 0 0 0\n", "quaternion"},
        {"0 1 2 2e9 0 0 0 1\n", "position"},
        {"a b c d e f g h\n", "no time"},
    };
    t3r_camera lens;
    assert_int_equal(viewpoint_from_angle(60, 64, 64, &lens), 0);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        viewpoint_list list;
        char error[512] = "";
        write_text(bad[i].text);
        assert_int_equal(viewpoint_read_trajectory(path, &lens, &list, error, sizeof error), -1);
        assert_null(list.items);
        if (strstr(error, bad[i].reason) == NULL) {
            fail_msg("'%s' does not say '%s'", error, bad[i].reason);
        }
    }
    t3r_camera wide;
    assert_int_equal(viewpoint_from_angle(179.9, 64, 64, &wide), -1);
}

/* Returns the pixel at which a camera sees a point. */
static void project(const t3r_camera *camera, const double point[3], double pixel[2])
{
    rigid pose = {0};
    double seen[3];
    for (int i = 0; i < 3; i++) {
        pose.position[i] = ldexp((double)camera->position_q32[i], -32);
    }
    for (int i = 0; i < 4; i++) {
        pose.rotation[i] = ldexp(camera->rotation_q30[i], -30);
    }
    pose = rigid_inverse(&pose);
    rigid_apply(&pose, point, seen);
    assert_true(seen[2] > 0);
    pixel[0] = camera->fx_q16 * 0x1p-16 * seen[0] / seen[2];
    pixel[1] = camera->fy_q16 * 0x1p-16 * seen[1] / seen[2];
}

TEST(turns_about_a_centre)
{
    static const double centre[3] = {1, -2, 5}, axis[3] = {0, 0.6, 0.8}, beside[3] = {1, -1.4, 5.8};
    t3r_camera start;
    viewpoint_list list;
    char error[256] = "";
    assert_int_equal(viewpoint_from_angle(60, 64, 48, &start), 0);
    assert_int_equal(viewpoint_turn(&start, centre, axis, 5, 0, &list, error, sizeof error), 0);
    assert_int_equal(list.count, 5);
    assert_memory_equal(&list.items[0], &start, sizeof start);
    double first[2], last[2], pixel[2];
    project(&start, centre, first);
    project(&start, beside, last);
    for (uint32_t i = 1; i < 5; i++) { /* points of the axis keep their pixels */
        assert_true(list.items[i].position_q32[0] != start.position_q32[0]);
        project(&list.items[i], centre, pixel);
        assert_true(fabs(pixel[0] - first[0]) < 1e-4 && fabs(pixel[1] - first[1]) < 1e-4);
        project(&list.items[i], beside, pixel);
        assert_true(fabs(pixel[0] - last[0]) < 1e-4 && fabs(pixel[1] - last[1]) < 1e-4);
    }
    viewpoint_list_free(&list);
    start.position_q32[0] = start.position_q32[1] =
        (INT64_C(1) << 62) - 1; /* farther along one axis, after an eighth */
    assert_int_equal(viewpoint_turn(&start, centre, (const double[3]){0, 0, 1}, 8, 0, &list, error, sizeof error), -1);
    assert_null(list.items);
}

TEST(turns_by_an_arc)
{
    static const double centre[3] = {0, 0, 4}, axis[3] = {0, 1, 0};
    t3r_camera start;
    viewpoint_list list;
    char error[256] = "";
    assert_int_equal(viewpoint_from_angle(60, 64, 48, &start), 0);
    assert_int_equal(viewpoint_turn(&start, centre, axis, 3, 60, &list, error, sizeof error), 0);
    for (int i = 0; i < 3; i++) { /* a quarter turn would be 4 to the side */
        const double side = ldexp((double)list.items[i].position_q32[0], -32);
        assert_true(fabs(side - 4 * sin((1 - i) * M_PI / 6)) < 1e-4);
    }
    assert_memory_equal(&list.items[1], &start, sizeof start);
    viewpoint_list_free(&list);
    assert_int_equal(viewpoint_turn(&start, centre, axis, 1, 60, &list, error, sizeof error), 0);
    assert_memory_equal(&list.items[0], &start, sizeof start);
    viewpoint_list_free(&list);
}

ALL_TESTS_WITH(make_path, scratch_teardown)
