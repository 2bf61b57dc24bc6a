/* SPDX-License-Identifier: Apache-2.0 */
/* COLMAP models: every camera model becomes the right lens or is refused by name; allowed and refused texts, with the
 * number of the wrong line. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "import/colmap/colmap_camera.h"
#include "import/colmap/colmap_model.h"
#include "test.h"

typedef int (*reader)(FILE *file, colmap_model *model, char *error, size_t error_bytes);

static void read_text(reader read, const char *text, colmap_model *model)
{
    char error[256] = "";
    FILE *file = fmemopen((void *)(uintptr_t)text, strlen(text), "rb");
    assert_non_null(file);
    int status = read(file, model, error, sizeof error);
    fclose(file);
    if (status != 0) {
        fail_msg("%s", error);
    }
}

static void refuse_text(reader read, const char *text, const char *why)
{
    char error[256] = "";
    colmap_model model = {0};
    FILE *file = fmemopen((void *)(uintptr_t)text, strlen(text), "rb");
    assert_non_null(file);
    int status = read(file, &model, error, sizeof error);
    fclose(file);
    colmap_model_free(&model);
    assert_int_equal(status, -1);
    if (strstr(error, why) == NULL) {
        fail_msg("'%s' does not say '%s'", error, why);
    }
}

/* Makes parameters 500, 510 (for two focal lengths), 320, 240, then 0.01, 0.02 ... */
static const char *make(const char *name, posed_intrinsics *out)
{
    double parameters[COLMAP_PARAMETERS_MOST];
    const colmap_camera_model *model = colmap_model_of_name(name);
    assert_non_null(model);
    uint32_t focals = strstr(name, "SIMPLE") != NULL || strstr(name, "RADIAL") != NULL ? 1 : 2, k = 0;
    parameters[k++] = 500;
    if (focals == 2) {
        parameters[k++] = 510;
    }
    parameters[k++] = 320;
    parameters[k++] = 240;
    for (int i = 1; k < COLMAP_PARAMETERS_MOST; i++) {
        parameters[k++] = i * 0.01;
    }
    return colmap_intrinsics(model, parameters, 640, 480, out);
}

TEST(test_models)
{
    static const struct {
        const char *name;
        double fy;
        t3r_distortion distortion;
        double coefficients[5];
    } rows[] = {
        {"SIMPLE_PINHOLE", 500, T3R_DISTORTION_NONE, {0}},
        {"PINHOLE", 510, T3R_DISTORTION_NONE, {0}},
        {"SIMPLE_RADIAL", 500, T3R_DISTORTION_RADTAN, {0.01}},
        {"RADIAL", 500, T3R_DISTORTION_RADTAN, {0.01, 0.02}},
        {"OPENCV", 510, T3R_DISTORTION_RADTAN, {0.01, 0.02, 0.03, 0.04}},
        {"OPENCV_FISHEYE", 510, T3R_DISTORTION_FISHEYE, {0.01, 0.02, 0.03, 0.04}},
        {"SIMPLE_RADIAL_FISHEYE", 500, T3R_DISTORTION_FISHEYE, {0.01}},
        {"RADIAL_FISHEYE", 500, T3R_DISTORTION_FISHEYE, {0.01, 0.02}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        posed_intrinsics lens;
        assert_null(make(rows[i].name, &lens));
        assert_true(lens.fx == 500 && lens.fy == rows[i].fy && lens.cx == 320 && lens.cy == 240);
        assert_true(lens.width == 640 && lens.height == 480);
        assert_int_equal(lens.distortion, rows[i].distortion);
        for (int k = 0; k < 5; k++) {
            assert_true(lens.coefficients[k] == rows[i].coefficients[k]);
        }
    }
    static const char *const refused[] = {"FOV", "THIN_PRISM_FISHEYE", "RAD_TAN_THIN_PRISM_FISHEYE"};
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        posed_intrinsics lens;
        const char *why = make(refused[i], &lens);
        assert_non_null(why);
        assert_non_null(strstr(why, refused[i]));
    }
    const double full[12] = {500, 510, 320, 240, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8};
    posed_intrinsics lens;
    assert_null(colmap_intrinsics(colmap_model_of_name("FULL_OPENCV"), full, 640, 480, &lens));
    assert_true(lens.coefficients[3] == 0.4 && lens.coefficients[4] == 0.5);
    assert_true(lens.coefficients[5] == 0.6 && lens.coefficients[7] == 0.8);
    assert_null(colmap_model_of_name("PINHOLE "));
    for (int32_t id = -1; id <= 12; id++) { /* numbers and names come from one list */
        assert_int_equal(colmap_model_of_id(id) != NULL, id >= 0 && id <= 11);
    }
    assert_ptr_equal(colmap_model_of_id(5), colmap_model_of_name("OPENCV_FISHEYE"));
}

TEST(test_bad_numbers)
{
    const colmap_camera_model *pinhole = colmap_model_of_name("PINHOLE");
    posed_intrinsics lens;
    const double infinite[4] = {500, 500, INFINITY, 1}, negative[4] = {500, -1, 1, 1}, good[4] = {500, 500, 1, 1};
    assert_string_equal(colmap_intrinsics(pinhole, infinite, 9, 9, &lens), "a parameter is not a finite number");
    assert_string_equal(colmap_intrinsics(pinhole, negative, 9, 9, &lens), "a focal length is not positive");
    assert_non_null(colmap_intrinsics(pinhole, good, 0, 9, &lens));
    assert_non_null(colmap_intrinsics(pinhole, good, 9, UINT64_MAX, &lens));
}

#define IMAGE(name) "1 1 0 0 0 1 2 3 7 " name "\n\n"

TEST(test_text)
{
    colmap_model model = {0};
    read_text(colmap_read_cameras_text, "# a\n\n7 PINHOLE 64 48 50 51 32 24\r\n8 SIMPLE_PINHOLE 9 9 5 4 4", &model);
    read_text(colmap_read_images_text,
              "# a\n2 0 1 0 0 1 2 3 7 a 10.png \r\n\n1 1 0 0 0 1 2 3 8 a 9.png\n1 2 -1 # 3 4 5\n3 1.05 0 0 0 0 0 0 9 b",
              &model);
    assert_null(colmap_model_sort(&model));
    assert_int_equal(model.camera_count, 2);
    assert_int_equal(model.image_count, 3);
    assert_string_equal(model.images[0].name, "a 9.png"); /* numbers by value */
    assert_string_equal(model.images[1].name, "a 10.png");
    assert_true(model.images[0].pose.position[0] == -1 && model.images[0].pose.position[2] == -3);
    /* half a turn around x: the camera looks back */
    assert_true(model.images[1].pose.position[0] == -1 && model.images[1].pose.position[1] == 2 &&
                model.images[1].pose.position[2] == 3);
    assert_true(model.images[2].pose.rotation[0] == 1);
    assert_int_equal(colmap_model_camera(&model, 8)->id, 8);
    assert_null(colmap_model_camera(&model, 9));
    colmap_model_free(&model);
}

/* Checks that an image with a bad pose, and a camera of an unknown model, are named and spoil no other. */
TEST(test_bad_images_are_kept_apart)
{
    static const char *const poses[] = {"2 0 0 0 1 2 3", "nan 0 0 0 1 2 3", "1 0 0 0 inf 2 3", "1 0 0 0 2e9 2 3"};
    static const char *const reasons[] = {"the quaternion's norm", "the quaternion's norm", "a number is not finite",
                                          "a position is 2^30 or more"};
    for (size_t i = 0; i < sizeof poses / sizeof *poses; i++) {
        colmap_model model = {0};
        char text[256];
        snprintf(text, sizeof text, "1 %s 7 a\n\n" IMAGE("b"), poses[i]);
        read_text(colmap_read_cameras_text, "7 PINHOLE 64 48 50 51 32 24\n8 WIDE 9 9 5\n", &model);
        read_text(colmap_read_images_text, text, &model);
        assert_null(colmap_model_sort(&model));
        assert_non_null(strstr(model.images[0].wrong, reasons[i]));
        assert_null(model.images[1].wrong);
        assert_null(colmap_model_camera(&model, 7)->wrong);
        assert_string_equal(colmap_model_camera(&model, 8)->wrong, "an unknown camera model");
        colmap_model_free(&model);
    }
}

TEST(test_refusals)
{
    refuse_text(colmap_read_cameras_text, "# a\nx PINHOLE 1 1\n", "line 2: no CAMERA_ID");
    refuse_text(colmap_read_cameras_text, "4294967296 PINHOLE 1 1\n", "line 1: no CAMERA_ID");
    refuse_text(colmap_read_cameras_text, "-1 PINHOLE 1 1\n", "line 1: no CAMERA_ID");
    refuse_text(colmap_read_cameras_text, "1\n", "line 1: no MODEL");
    refuse_text(colmap_read_cameras_text, "1 PINHOLE 1\n", "line 1: no WIDTH and HEIGHT");
    refuse_text(colmap_read_cameras_text, "1 PINHOLE 64 48 1 2 3\n", "line 1: fewer parameters");
    refuse_text(colmap_read_cameras_text, "1 PINHOLE 64 48 1 2 3 4 5\n", "line 1: more parameters");
    refuse_text(colmap_read_images_text, IMAGE("a") "1 1 0 0 0 1 2\n", "line 3: not 'IMAGE_ID QW");
    refuse_text(colmap_read_images_text, IMAGE(""), "line 1: no name");
    char *longer = malloc(10000);
    memset(longer, ' ', 9999);
    longer[9999] = '\0';
    refuse_text(colmap_read_images_text, longer, "line 1: it is too long");
    free(longer);
    colmap_model twice = {0};
    read_text(colmap_read_cameras_text, "7 PINHOLE 64 48 50 51 32 24\n7 PINHOLE 64 48 50 51 32 24\n", &twice);
    read_text(colmap_read_images_text, IMAGE("a"), &twice);
    assert_string_equal(colmap_model_sort(&twice), "a camera is there twice");
    colmap_model_free(&twice);
    colmap_model none = {0};
    assert_string_equal(colmap_model_sort(&none), "no camera");
}
