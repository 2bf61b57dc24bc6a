/* SPDX-License-Identifier: Apache-2.0 */
/* TUM RGB-D folders, made on the fly: association, interpolation, intrinsics, errors. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "import/folders/posed_folder.h"
#include "scratch.h"
#include "test.h"

static const double lens[INTRINSICS_NUMBERS] = {500, 510, 319.5, 239.5, 0.1, 0, 0, 0, 0.2};
static const posed_folder_options with_lens = {.intrinsics = lens};

static void put(scratch *s, const char *name, const char *text)
{
    assert_int_equal(scratch_write(s, name, text, strlen(text)), 0);
}

static void refuse(scratch *s, const posed_folder_options *options, const char *why)
{
    posed_folder folder;
    char error[512] = "";
    int status = posed_folder_open(s->directory, options, &folder, error, sizeof error);
    posed_folder_close(&folder);
    assert_int_equal(status, -1);
    if (strstr(error, why) == NULL) {
        fail_msg("'%s' does not say '%s'", error, why);
    }
}

static void good_lists(scratch *s)
{
    put(s, "rgb.txt",
        "# color images\n# timestamp filename\n10.000 rgb/a.png\n10.050 rgb/b.png\r\n\n12.000 rgb/c.png\n"
        "20.000 rgb/d.png\n");
    put(s, "depth.txt", "9.990 depth/early.png\n10.008 depth/a.png\n10.071 depth/late.png\n12.020 depth/c.png\n");
    put(s, "groundtruth.txt",
        "# timestamp tx ty tz qx qy qz qw\n9.980 0 0 0 0 0 0 1\n10.040 3 6 9 0 0 0 1\n"
        "10.060 5 6 9 0 0 -0.173648177 -0.984807753\n12.010 1 2 3 0.5 0.5 0.5 0.5\n");
}

TEST_WITH(test_association, scratch_setup, scratch_teardown)
{
    scratch *s = *state;
    posed_folder folder;
    char error[512] = "";
    good_lists(s);
    if (posed_folder_open(s->directory, &with_lens, &folder, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
    /* d has no pose near it */
    assert_int_equal(folder.frame_count, 3);
    assert_int_equal(folder.left_out.frames.count, 1);
    assert_true(folder.depth_unit == 1 / 5000.0);
    assert_string_equal(folder.frames[0].image, "rgb/a.png");
    assert_string_equal(folder.frames[1].image, "rgb/b.png");
    /* distances: 8 ms and 10 ms; 21 ms and 42 ms; 20 ms */
    assert_string_equal(folder.frames[0].depth, "depth/a.png");
    assert_null(folder.frames[1].depth);
    assert_string_equal(folder.frames[2].depth, "depth/c.png");
    /* a third of the way; half-way, through a quaternion of the other sign: 20 degrees about z become 10 */
    const posed_frame *f = folder.frames;
    assert_true(fabs(f[0].pose.position[0] - 1) < 1e-6 && fabs(f[0].pose.position[1] - 2) < 1e-6);
    assert_true(fabs(f[1].pose.position[0] - 4) < 1e-6);
    assert_true(fabs(f[1].pose.rotation[0] - cos(5 * 3.14159265358979 / 180)) < 1e-6);
    assert_true(fabs(f[1].pose.rotation[3] - sin(5 * 3.14159265358979 / 180)) < 1e-6);
    /* neighbours too far apart: the nearest */
    assert_true(f[2].pose.position[0] == 1 && fabs(f[2].pose.rotation[0] - 0.5) < 1e-12);
    t3r_recorded_camera camera;
    assert_int_equal(posed_frame_camera(&f[0], 640, 480, &camera, error, sizeof error), 0);
    assert_true(camera.fx == 500 && camera.cx == 319.5 && camera.cy == 239.5);
    assert_int_equal(camera.distortion, T3R_DISTORTION_RADTAN);
    assert_true(camera.coefficients[4] == 0.2);
    posed_folder_close(&folder);
}

TEST_WITH(test_depth_is_optional, scratch_setup, scratch_teardown)
{
    scratch *s = *state;
    posed_folder folder;
    char error[512];
    good_lists(s);
    remove(scratch_path(s, "depth.txt"));
    assert_int_equal(posed_folder_open(s->directory, &with_lens, &folder, error, sizeof error), 0);
    assert_int_equal(folder.frame_count, 3);
    assert_null(folder.frames[0].depth);
    posed_folder_close(&folder);
}

TEST_WITH(test_known_intrinsics, scratch_setup, scratch_teardown)
{
    scratch *s = *state;
    posed_folder folder;
    char error[512];
    good_lists(s);
    refuse(s, NULL, "intrinsics unknown");
    refuse(s, NULL, "--intrinsics fx,fy,cx,cy");
    /* the same lists under a name that identifies the camera */
    scratch named = *s;
    snprintf(named.directory, sizeof named.directory, "%.200s/rgbd_dataset_freiburg2_x", s->directory);
    assert_int_equal(mkdir(named.directory, 0700), 0);
    good_lists(&named);
    assert_int_equal(posed_folder_open(named.directory, NULL, &folder, error, sizeof error), 0);
    assert_true(folder.frames[0].intrinsics.fx == 520.9);
    assert_true(folder.frames[0].intrinsics.cx == 325.1 + 0.5);
    assert_true(folder.frames[0].intrinsics.coefficients[0] == 0.2312);
    posed_folder_close(&folder);
    scratch_close(&named);
}

/* Checks that lines that cannot be read are counted and named, and that the others are used. */
TEST_WITH(test_bad_lines_are_left_out, scratch_setup, scratch_teardown)
{
    scratch *s = *state;
    posed_folder folder;
    char error[512] = "";
    good_lists(s);
    put(s, "rgb.txt", "10.000 rgb/a.png\nabc rgb/b.png\n12.000 rgb/c.png\n");
    put(s, "depth.txt", "9.9\n10.008 depth/a.png\nnan depth/c.png\n");
    put(s, "groundtruth.txt",
        "9.980 0 0 0 0 0 0 1\n9.99 nan nan nan nan nan nan nan\n10.040 3 6 9 0 0 0 1\n12.01 0 0 0 0 0 0 0\n");
    assert_int_equal(posed_folder_open(s->directory, &with_lens, &folder, error, sizeof error), 0);
    assert_int_equal(folder.frame_count, 1);
    assert_true(fabs(folder.frames[0].pose.position[0] - 1) < 1e-6); /* between the good neighbours */
    assert_string_equal(folder.frames[0].depth, "depth/a.png");
    static const char *const due[] = {"rgb.txt: lines left out: 1; the first: line 2: no time stamp",
                                      "groundtruth.txt: lines left out: 2; the first: line 2: a number is not finite",
                                      "depth.txt: lines left out: 2; the first: line 1: no file name",
                                      "rgb/c.png: no pose near it in time"};
    assert_int_equal(folder.left_out.frames.count, 4);
    for (size_t i = 0; i < 4; i++) {
        assert_non_null(strstr(folder.left_out.frames.lines[i], due[i]));
    }
    posed_folder_close(&folder);
}

/* Checks that --depth-unit counts instead of the data set's own step. */
TEST_WITH(test_another_depth_unit, scratch_setup, scratch_teardown)
{
    scratch *s = *state;
    posed_folder folder;
    char error[512] = "";
    good_lists(s);
    posed_folder_options options = with_lens;
    options.depth_unit = 0.001;
    assert_int_equal(posed_folder_open(s->directory, &options, &folder, error, sizeof error), 0);
    assert_true(folder.depth_unit == 0.001);
    posed_folder_close(&folder);
}

TEST_WITH(test_bad_lists_are_named, scratch_setup, scratch_teardown)
{
    scratch *s = *state;
    good_lists(s);
    put(s, "rgb.txt", "# nothing\n");
    refuse(s, &with_lens, "rgb.txt: no entry");
    put(s, "rgb.txt", "10.0\n");
    refuse(s, &with_lens, "rgb.txt: line 1: no file name");
    put(s, "rgb.txt", "nan a.png\n");
    refuse(s, &with_lens, "rgb.txt: line 1: no time stamp");
    put(s, "rgb.txt", "500.0 a.png\n");
    refuse(s, &with_lens, "no pose within 20 ms");
    good_lists(s);
    put(s, "depth.txt", "10.0\n");
    refuse(s, &with_lens, "depth.txt: line 1");
    good_lists(s);
    put(s, "groundtruth.txt", "10.0 0 0 0 0 0 1\n");
    refuse(s, &with_lens, "groundtruth.txt: line 1: not 'seconds tx ty tz qx qy qz qw'");
    put(s, "groundtruth.txt", "10.0 0 0 0 0 0 0 0\n");
    refuse(s, &with_lens, "groundtruth.txt: line 1: a quaternion without direction");
    put(s, "groundtruth.txt", "10.0 inf 0 0 0 0 0 1\n");
    refuse(s, &with_lens, "groundtruth.txt: line 1");
    put(s, "groundtruth.txt", "10.0 3e9 0 0 0 0 0 1\n");
    refuse(s, &with_lens, "groundtruth.txt: line 1: a position");
    remove(scratch_path(s, "groundtruth.txt"));
    refuse(s, &with_lens, "groundtruth.txt: No such file");
    remove(scratch_path(s, "rgb.txt"));
    refuse(s, &with_lens, "neither transforms.json nor rgb.txt");
    good_lists(s);
    put(s, "transforms.json", "{}");
    refuse(s, &with_lens, "has its own intrinsics");
    refuse(s, NULL, "transforms.json: frames: missing");
}
