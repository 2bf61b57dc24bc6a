/* SPDX-License-Identifier: Apache-2.0 */
/* transforms.json: good texts give the right cameras, bad ones an error that names frame and field. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geometry/quaternion.h"
#include "import/folders/transforms_json.h"
#include "test.h"

#define IDENTITY "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]"
#define FRAME(more) "{\"file_path\":\"a.png\",\"transform_matrix\":" IDENTITY more "}"
#define FOLDER(top, frame) "{" top "\"frames\":[" FRAME("") "," frame "]}"
#define LENS "\"fl_x\":100,\"fl_y\":110,\"w\":64,\"h\":48,\"cx\":30,\"cy\":25,"

static void parse(const char *text, posed_folder *folder)
{
    char error[512] = "";
    if (transforms_json_parse(text, strlen(text), NULL, folder, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
}

/* Checks that the text, or one of its frames, is refused. */
static void refuse(const char *text, const char *why)
{
    posed_folder folder;
    char error[512] = "";
    int status = transforms_json_parse(text, strlen(text), NULL, &folder, error, sizeof error);
    for (uint32_t i = 0; i < folder.frame_count && status == 0; i++) {
        if (folder.frames[i].rejected) {
            assert_int_equal(error[0], '\0');
            assert_non_null(strstr(folder.frames[i].wrong, folder.frames[i].image));
            snprintf(error, sizeof error, "%s", folder.frames[i].wrong);
            status = -1;
        }
    }
    posed_folder_close(&folder);
    assert_int_equal(status, -1);
    if (strstr(error, why) == NULL) {
        fail_msg("'%s' does not say '%s'", error, why);
    }
}

/* Rotates a vector by the quaternion, q v q*, spelled out without matrices. */
static void turn(const double q[4], const double v[3], double out[3])
{
    double w = q[0], t[3];
    const double *u = q + 1;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        t[i] = 2 * (u[j] * v[k] - u[k] * v[j]);
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = v[i] + w * t[i] + u[j] * t[k] - u[k] * t[j];
    }
}

TEST(test_intrinsics_and_axes)
{
    posed_folder folder;
    parse("{" LENS "\"integer_depth_scale\":0.002,\"frames\":[{\"file_path\":\"./a.png\",\"depth_path\":\"d.png\","
          "\"transform_matrix\":" IDENTITY "},{\"file_path\":\"b.png\",\"fl_x\":200,\"k1\":0.1,\"p2\":-0.02,"
          "\"transform_matrix\":[[0,0,1,5],[1,0,0,6],[0,1,0,7]]}],"
          "\"trim3r_triplets\":[{\"context\":[0,1],\"target\":0}]}",
          &folder);
    assert_int_equal(folder.frame_count, 2);
    assert_int_equal(folder.triplet_count, 1);
    assert_true(folder.depth_unit == 0.002);
    assert_string_equal(folder.frames[0].depth, "d.png");
    assert_null(folder.frames[1].depth);
    t3r_recorded_camera a, b;
    char error[256];
    assert_int_equal(posed_frame_camera(&folder.frames[0], 64, 48, &a, error, sizeof error), 0);
    assert_int_equal(posed_frame_camera(&folder.frames[1], 64, 48, &b, error, sizeof error), 0);
    assert_true(a.fx == 100 && a.fy == 110 && a.cx == 29.5 && a.cy == 24.5);
    assert_int_equal(a.distortion, T3R_DISTORTION_NONE);
    assert_true(b.fx == 200 && b.fy == 110);
    assert_int_equal(b.distortion, T3R_DISTORTION_RADTAN);
    assert_true(b.coefficients[0] == 0.1 && b.coefficients[1] == 0 && b.coefficients[3] == -0.02);
    /* OpenGL's backward is -z of ours, its up is -y */
    double forward[3], down[3];
    turn(a.rotation, (double[3]){0, 0, 1}, forward);
    turn(a.rotation, (double[3]){0, 1, 0}, down);
    assert_true(fabs(forward[2] + 1) < 1e-12 && fabs(down[1] + 1) < 1e-12);
    /* columns of b's matrix: right (0,1,0), up (0,0,1), backward (1,0,0) */
    turn(b.rotation, (double[3]){0, 0, 1}, forward);
    turn(b.rotation, (double[3]){0, 1, 0}, down);
    assert_true(fabs(forward[0] + 1) < 1e-12 && fabs(down[2] + 1) < 1e-12);
    assert_true(b.position[0] == 5 && b.position[1] == 6 && b.position[2] == 7);
    posed_folder_close(&folder);
}

TEST(test_every_rotation_survives)
{
    uint32_t seed = 1;
    for (int trial = 0; trial < 2000; trial++) {
        double q[4], norm = 0, m[9], back[4];
        for (int i = 0; i < 4; i++) {
            seed = seed * 1664525u + 1013904223u;
            q[i] = trial % 5 == i ? 0 : (double)(seed >> 8) / 0x800000 - 1;
            norm += q[i] * q[i];
        }
        if (norm < 0.01) {
            continue;
        }
        for (int i = 0; i < 4; i++) {
            q[i] /= sqrt(norm);
        }
        for (int c = 0; c < 3; c++) {
            double column[3], axis[3] = {c == 0, c == 1, c == 2};
            turn(q, axis, column);
            for (int r = 0; r < 3; r++) {
                /* 3e-4 too long: accepted, and normalised */
                m[r * 3 + c] = column[r] * 1.0003;
            }
        }
        assert_null(quaternion_of(m, back));
        double dot = q[0] * back[0] + q[1] * back[1] + q[2] * back[2] + q[3] * back[3];
        assert_true(fabs(fabs(dot) - 1) < 1e-12);
    }
}

TEST(test_fallbacks)
{
    posed_folder folder;
    t3r_recorded_camera camera;
    char error[256];
    parse(FOLDER("\"camera_angle_x\":1.0471975511965976,", FRAME("")), &folder);
    assert_int_equal(posed_frame_camera(&folder.frames[1], 200, 100, &camera, error, sizeof error), 0);
    assert_true(fabs(camera.fx - 100 * sqrt(3)) < 1e-9 && camera.fy == camera.fx);
    assert_true(camera.cx == 99.5 && camera.cy == 49.5);
    assert_true(folder.depth_unit == 0.001);
    posed_folder_close(&folder);
}

TEST(test_lenses)
{
    posed_folder folder;
    parse(FOLDER(LENS "\"camera_model\":\"OPENCV_FISHEYE\",\"k1\":0.1,\"k2\":0.2,\"k3\":0.3,\"k4\":0.4,", FRAME("")),
          &folder);
    const posed_intrinsics *in = &folder.frames[0].intrinsics;
    assert_int_equal(in->distortion, T3R_DISTORTION_FISHEYE);
    assert_true(in->coefficients[0] == 0.1 && in->coefficients[2] == 0.3 && in->coefficients[3] == 0.4);
    posed_folder_close(&folder);
    parse(FOLDER(LENS "\"camera_model\":\"OPENCV\",\"k1\":0.1,\"k3\":0.3,\"k4\":0,", FRAME("")), &folder);
    in = &folder.frames[0].intrinsics;
    assert_int_equal(in->distortion, T3R_DISTORTION_RADTAN);
    assert_true(in->coefficients[4] == 0.3);
    posed_folder_close(&folder);
    parse(FOLDER(LENS "\"camera_model\":\"PINHOLE\",\"k1\":0.1,", FRAME("")), &folder);
    assert_int_equal(folder.frames[0].intrinsics.distortion, T3R_DISTORTION_NONE);
    posed_folder_close(&folder);
    parse(FOLDER(LENS "\"camera_model\":\"OPENCV\",\"k4\":0.1,\"k6\":0.3,", FRAME("")), &folder);
    assert_true(folder.frames[0].intrinsics.coefficients[5] == 0.1);
    assert_true(folder.frames[0].intrinsics.coefficients[7] == 0.3);
    posed_folder_close(&folder);
    refuse(FOLDER(LENS "\"camera_model\":\"THIN_PRISM\",", FRAME("")), "frames[0]: camera_model");
    refuse(FOLDER(LENS "\"camera_model\":7,", FRAME("")), "camera_model: not a string");
    refuse(FOLDER(LENS "\"latlong\":true,", FRAME("")), "latlong: this lens");
    refuse(FOLDER(LENS, FRAME(",\"k2\":\"x\"")), "frames[1]: k2: not a number");
}

TEST(test_bad_texts_are_named)
{
    refuse("", "byte 0: not JSON");
    refuse("[]", "byte 0: not a JSON object");
    refuse("{\"frames\": nope}", "byte 11: not JSON");
    refuse("{\"frames\":[" FRAME(",\"fl_x\":NaN") "]}", "fl_x: not a number");
    refuse("{\"frames\":[" FRAME(",\"fl_x\":-Infinity") "]}", "fl_x: not a number");
    refuse("{\"frames\":[" FRAME(",\"fl_x\":nan") "]}", "not JSON");
    refuse("{}", "frames: missing");
    refuse("{\"frames\":{}}", "frames: not an array");
    refuse("{\"frames\":[]}", "frames: empty");
    refuse("{\"frames\":[3]}", "frames[0]: not an object");
    refuse(FOLDER(LENS, "{\"transform_matrix\":" IDENTITY "}"), "frames[1]: file_path: missing");
    refuse(FOLDER(LENS, "{\"file_path\":5,\"transform_matrix\":" IDENTITY "}"), "frames[1]: file_path: not a string");
    refuse(FOLDER(LENS, "{\"file_path\":\"\",\"transform_matrix\":" IDENTITY "}"), "file_path: empty");
    refuse(FOLDER(LENS, "{\"file_path\":\"b.png\"}"), "frames[1]: transform_matrix: missing");
    refuse(FOLDER("", FRAME("")), "frames[0]: fl_x: missing, and no camera_angle_x");
    refuse(FOLDER(LENS, FRAME(",\"fl_x\":-3")), "frames[1]: fl_x: not positive");
    refuse(FOLDER(LENS, FRAME(",\"fl_x\":1e999")), "frames[1]: fl_x: not finite");
    refuse(FOLDER(LENS, FRAME(",\"w\":63.5")), "frames[1]: w: not a whole number");
    refuse(FOLDER(LENS, FRAME(",\"h\":17000")), "frames[1]: h: not a whole number");
    refuse(FOLDER(LENS, FRAME(",\"cx\":[]")), "frames[1]: cx: not a number");
    refuse(FOLDER(LENS "\"camera_angle_x\":4,", FRAME("")), "camera_angle_x: not between");
    refuse(FOLDER(LENS, FRAME(",\"depth_path\":\"d.png\"")), "integer_depth_scale: missing");
    refuse(FOLDER(LENS "\"integer_depth_scale\":0,", FRAME("")), "integer_depth_scale: not between");
    refuse(FOLDER(LENS "\"integer_depth_scale\":128,", FRAME("")), "integer_depth_scale: not between");
    refuse(FOLDER(LENS "\"trim3r_triplets\":[{\"context\":[0,2],\"target\":0}],", FRAME("")),
           "trim3r_triplets[0]: context");
    refuse(FOLDER(LENS "\"trim3r_triplets\":[{\"context\":[0,1],\"target\":0},{\"context\":[0,1],\"target\":0.5}],",
                  FRAME("")),
           "trim3r_triplets[1]: target");
    refuse(FOLDER(LENS "\"trim3r_triplets\":7,", FRAME("")), "trim3r_triplets: not an array");
}

#define POSE(matrix) "{\"file_path\":\"b.png\",\"transform_matrix\":" matrix "}"

TEST(test_bad_poses_are_named)
{
    refuse(FOLDER(LENS, POSE("7")), "frames[1]: transform_matrix: not an array of 4 rows");
    refuse(FOLDER(LENS, POSE("[[1,0,0,0],[0,1,0,0]]")), "not an array of 4 rows");
    refuse(FOLDER(LENS, POSE("[[1,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]")), "a row is not 4 numbers");
    refuse(FOLDER(LENS, POSE("[[1,0,0,null],[0,1,0,0],[0,0,1,0],[0,0,0,1]]")), "not a finite number");
    refuse(FOLDER(LENS, POSE("[[1e999,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]")), "not a finite number");
    refuse(FOLDER(LENS, POSE("[[1.002,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]")), "not orthonormal");
    refuse(FOLDER(LENS, POSE("[[1,0.01,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]")), "not orthonormal");
    refuse(FOLDER(LENS, POSE("[[-1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]")), "mirrors");
    refuse(FOLDER(LENS, POSE("[[1,0,0,1.1e9],[0,1,0,0],[0,0,1,0],[0,0,0,1]]")), "2^30");
    refuse(FOLDER(LENS, POSE("[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,0.01]]")), "last row");
}

TEST(test_pictures_of_another_size)
{
    posed_folder folder;
    t3r_recorded_camera camera;
    char error[256];
    parse(FOLDER(LENS, FRAME("")), &folder);
    assert_int_equal(posed_frame_camera(&folder.frames[0], 65, 48, &camera, error, sizeof error), -1);
    assert_non_null(strstr(error, "w: 64, but the picture is 65 pixels wide"));
    assert_int_equal(posed_frame_camera(&folder.frames[0], 64, 47, &camera, error, sizeof error), -1);
    assert_non_null(strstr(error, "h: 48, but the picture is 47 pixels high"));
    posed_folder_close(&folder);
}

TEST(test_every_cut_is_refused)
{
    const char *text = FOLDER(LENS, FRAME(",\"depth_path\":null"));
    for (size_t cut = 0; cut < strlen(text); cut++) {
        posed_folder folder;
        char error[512] = "";
        char *exact = malloc(cut + 1); /* so that a sanitizer notices a read beyond the end */
        memcpy(exact, text, cut);
        assert_int_equal(transforms_json_parse(exact, cut, NULL, &folder, error, sizeof error), -1);
        assert_true(error[0] != '\0');
        posed_folder_close(&folder);
        free(exact);
    }
}
