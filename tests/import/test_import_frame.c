/* SPDX-License-Identifier: Apache-2.0 */
/* Cropping and resizing: pixels and camera must still agree. Checked by projecting points through both cameras, and
 * against an area average in double. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "import/folders/posed_folder.h"
#include "import/frames/crop.h"
#include "import/frames/frame.h"
#include "pictures/picture.h"
#include "scratch.h"
#include "test.h"

static void write_picture(scratch *s, const char *name, const picture *p)
{
    char error[256];
    if (picture_write_png(scratch_path(s, name), p, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
}

/* Red counts columns, green rows; depth steps count both. */
static void write_ramps(scratch *s, uint32_t width, uint32_t height, uint32_t depth_width, uint32_t depth_height)
{
    picture colour = {.width = width, .height = height, .channels = 3, .bits = 8};
    picture depth = {.width = depth_width, .height = depth_height, .channels = 1, .bits = 16};
    colour.samples = calloc((size_t)width * height, 3);
    depth.samples = calloc((size_t)depth_width * depth_height, 2);
    uint8_t *rgb = colour.samples;
    uint16_t *steps = depth.samples;
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++) {
            rgb[(y * width + x) * 3] = (uint8_t)x;
            rgb[(y * width + x) * 3 + 1] = (uint8_t)y;
        }
    }
    for (uint32_t y = 0; y < depth_height; y++) {
        for (uint32_t x = 0; x < depth_width; x++) {
            steps[y * depth_width + x] = (uint16_t)(y * 256 + x);
        }
    }
    write_picture(s, "colour.png", &colour);
    write_picture(s, "depth.png", &depth);
    picture_free(&colour);
    picture_free(&depth);
}

static posed_frame ramp_frame(void)
{
    static char colour[] = "colour.png", depth[] = "depth.png";
    posed_frame frame = {.image = colour, .depth = depth, .pose = {.rotation = {1, 0, 0, 0}}};
    frame.intrinsics = (posed_intrinsics){
        .width = NAN, .height = NAN, .fx = 210, .fy = 190, .cx = 104.3, .cy = 71.9, .angle_x = NAN, .angle_y = NAN};
    return frame;
}

static double bilinear(const uint8_t *rgb, uint32_t width, uint32_t channel, double u, double v)
{
    uint32_t x = (uint32_t)u, y = (uint32_t)v;
    double a = u - x, b = v - y;
    const uint8_t *p = rgb + ((size_t)y * width + x) * 3 + channel;
    return (p[0] * (1 - a) + p[3] * a) * (1 - b) + (p[width * 3] * (1 - a) + p[width * 3 + 3] * a) * b;
}

/* Checks the reprojection: a point in front of the camera appears at a column of the source, which the ramp encodes;
 * the imported picture, read where the imported camera sees the point, must give the same column, within half a
 * level of rounding. */
static void check_reprojection(scratch *s, uint32_t from_width, uint32_t from_height, uint32_t width, uint32_t height)
{
    char error[512] = "";
    posed_frame frame = ramp_frame();
    import_buffers buffers;
    t3r_recorded_frame out;
    uint32_t checked = 0;
    write_ramps(s, from_width, from_height, from_width, from_height);
    if (import_frame(s->directory, &frame, NULL, width, height, &buffers, &out, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
    assert_int_equal(out.width, width);
    assert_int_equal(out.camera.width, width);
    assert_int_equal(out.camera.height, height);
    for (double y = -0.5; y < 0.5; y += 0.037) {
        for (double x = -0.6; x < 0.6; x += 0.041) {
            double u = out.camera.fx * x + out.camera.cx, v = out.camera.fy * y + out.camera.cy;
            if (u < 0 || v < 0 || u > width - 1.001 || v > height - 1.001) {
                continue;
            }
            double column = 210 * x + 104.3 - 0.5, row = 190 * y + 71.9 - 0.5;
            assert_true(fabs(bilinear(buffers.rgb, width, 0, u, v) - column) < 0.51);
            assert_true(fabs(bilinear(buffers.rgb, width, 1, u, v) - row) < 0.51);
            /* depth: the source pixel that contains the box's centre */
            uint32_t px = (uint32_t)(u + 0.5), py = (uint32_t)(v + 0.5);
            uint16_t step = buffers.depth[py * width + px];
            double centre_column = (px - out.camera.cx) / out.camera.fx * 210 + 104.3 - 0.5;
            double centre_row = (py - out.camera.cy) / out.camera.fy * 190 + 71.9 - 0.5;
            assert_true(fabs((step & 255) - centre_column) < 0.5 + 1e-9);
            assert_true(fabs((step >> 8) - centre_row) < 0.5 + 1e-9);
            checked++;
        }
    }
    assert_true(checked > 100);
    import_buffers_free(&buffers);
}

TEST_WITH(test_points_stay_where_they_are, scratch_setup, scratch_teardown)
{
    check_reprojection(*state, 240, 160, 64, 64);
    check_reprojection(*state, 240, 160, 120, 80);
    check_reprojection(*state, 240, 160, 240, 160);
    check_reprojection(*state, 201, 150, 50, 50);
    check_reprojection(*state, 150, 201, 64, 48);
    check_reprojection(*state, 230, 200, 96, 33);
    check_reprojection(*state, 240, 160, 0xf5, 0xa5); /* larger than the crop */
}

TEST(test_the_crop_is_the_largest)
{
    for (uint32_t w = 2; w < 200; w += 7) {
        for (uint32_t h = 2; h < 200; h += 5) {
            t3r_crop c = import_largest_crop(w, h, 4, 3);
            assert_true(c.width == w || c.height == h);
            assert_true(c.x + c.width <= w && c.y + c.height <= h);
            double off_aspect = fabs((double)c.width * 3 - (double)c.height * 4);
            assert_true(off_aspect <= 2 || c.width == 1 || c.height == 1);
            assert_true(w - c.width - 2 * c.x <= 1 && h - c.height - 2 * c.y <= 1);
        }
    }
    t3r_crop c = import_largest_crop(540, 360, 256, 256);
    assert_int_equal(c.x, 90);
    assert_int_equal(c.width, 360);
    assert_int_equal(c.height, 360);
}

TEST_WITH(test_depth_of_another_resolution, scratch_setup, scratch_teardown)
{
    scratch *s = *state;
    char error[512] = "";
    posed_frame frame = ramp_frame();
    import_buffers buffers;
    t3r_recorded_frame out;
    write_ramps(s, 240, 160, 120, 80);
    assert_int_equal(import_frame(s->directory, &frame, NULL, 40, 40, &buffers, &out, error, sizeof error), 0);
    /* the colour's crop is columns 40..200, so the depth's 20..100: two source pixels a box, its centre the second */
    assert_int_equal(out.depth_width, 40);
    for (uint32_t y = 0; y < 40; y++) {
        for (uint32_t x = 0; x < 40; x++) {
            assert_int_equal(buffers.depth[y * 40 + x], (2 * y + 1) * 256 + 20 + 2 * x + 1);
        }
    }
    import_buffers_free(&buffers);
    /* without a size both keep theirs */
    assert_int_equal(import_frame(s->directory, &frame, NULL, 0, 0, &buffers, &out, error, sizeof error), 0);
    assert_int_equal(out.width * 1000 + out.height, 240160);
    assert_int_equal(out.depth_width * 1000 + out.depth_height, 120080);
    assert_int_equal(buffers.depth[79 * 120 + 119], 79 * 256 + 119);
    assert_true(out.camera.fx == 210 && fabs(out.camera.cx - 103.8) < 1e-12);
    import_buffers_free(&buffers);
}

static void refuse(scratch *s, const posed_frame *frame, uint32_t side, int status_due, const char *why)
{
    char error[512] = "";
    import_buffers buffers;
    t3r_recorded_frame out;
    int status = import_frame(s->directory, frame, NULL, side, side, &buffers, &out, error, sizeof error);
    import_buffers_free(&buffers);
    assert_int_equal(status, status_due);
    if (strstr(error, why) == NULL) {
        fail_msg("'%s' does not say '%s'", error, why);
    }
}

TEST_WITH(test_bad_pictures_are_named, scratch_setup, scratch_teardown)
{
    scratch *s = *state;
    write_ramps(s, 240, 160, 240, 160);
    posed_frame frame = ramp_frame();
    char other[] = "other";
    frame.image = other;
    refuse(s, &frame, 16, IMPORT_NO_FRAME, "/other: No such file");
    frame = ramp_frame();
    frame.depth = other;
    refuse(s, &frame, 16, IMPORT_NO_DEPTH, "/other: No such file");
    frame.depth = frame.image;
    refuse(s, &frame, 16, IMPORT_NO_DEPTH, "colour.png: 8-bit colour, but depth is a 16-bit grey PNG");
    frame = ramp_frame();
    frame.image = frame.depth;
    refuse(s, &frame, 16, IMPORT_NO_FRAME, "depth.png: 16-bit grey, but a colour picture has 8 bits");
    frame = ramp_frame();
    frame.intrinsics.width = 65;
    refuse(s, &frame, 16, IMPORT_NO_FRAME, "colour.png: w: 65, but the picture is 240 pixels wide");
    frame = ramp_frame();
    frame.intrinsics.fx = 30000;
    refuse(s, &frame, 0, IMPORT_NO_FRAME, "fl_x");
    frame = ramp_frame();
    frame.intrinsics.cx = 1e6;
    refuse(s, &frame, 0, IMPORT_NO_FRAME, "cx");
    frame = ramp_frame();
    frame.intrinsics.distortion = T3R_DISTORTION_RADTAN;
    frame.intrinsics.coefficients[0] = -200;
    refuse(s, &frame, 0, IMPORT_NO_FRAME, "distortion: the coefficients fold");
}

/* Checks that depth of another aspect, and intrinsics for another size or aspect, are refused with the remedy. */
TEST_WITH(test_geometry_that_does_not_fit, scratch_setup, scratch_teardown)
{
    scratch *s = *state;
    write_ramps(s, 240, 160, 160, 90);
    posed_frame frame = ramp_frame();
    refuse(s, &frame, 0, IMPORT_NO_DEPTH,
           "depth.png: 160x90 pixels of depth cannot show the view of a picture of 240x160");
    refuse(s, &frame, 16, IMPORT_NO_DEPTH, "crop the depth to that view, or give its lens");
    frame.intrinsics.cx = 640;
    frame.depth = NULL;
    refuse(s, &frame, 16, IMPORT_NO_FRAME, "cx, cy: 639.5, 71.4 lies outside the picture of 240x160 pixels");
    frame = ramp_frame();
    frame.intrinsics.grid_width = 160;
    frame.intrinsics.grid_height = 240;
    refuse(s, &frame, 16, IMPORT_NO_FRAME, "w, h: the intrinsics are for 160x240 pixels, but the picture has 240x160");
    /* a part of a larger picture, whose axis lies outside, and depth of almost the same aspect */
    write_ramps(s, 240, 160, 120, 78);
    frame = ramp_frame();
    frame.intrinsics.width = 240;
    frame.intrinsics.height = 160;
    frame.intrinsics.cx = 640;
    char error[512] = "";
    import_buffers buffers;
    t3r_recorded_frame out;
    assert_int_equal(import_frame(s->directory, &frame, NULL, 0, 0, &buffers, &out, error, sizeof error), 0);
    assert_true(out.camera.cx == 639.5 && out.depth_height == 78);
    import_buffers_free(&buffers);
}

/* Checks that a picture beyond the largest side is averaged with --size, and refused without. */
TEST_WITH(test_large_pictures_are_averaged, scratch_setup, scratch_teardown)
{
    scratch *s = *state;
    enum { WIDTH = 4500, HEIGHT = 30 };
    picture wide = {.width = WIDTH, .height = HEIGHT, .channels = 1, .bits = 8, .samples = malloc(WIDTH * HEIGHT)};
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        ((uint8_t *)wide.samples)[i] = (uint8_t)(i % WIDTH / 20 + i % 2);
    }
    write_picture(s, "colour.png", &wide);
    picture_free(&wide);
    posed_frame frame = ramp_frame();
    frame.depth = NULL;
    frame.intrinsics.cx = 2250;
    frame.intrinsics.cy = 15;
    refuse(s, &frame, 0, IMPORT_NO_FRAME, "colour.png: 4500x30 pixels; sides of up to 4096 are supported, larger ones");
    char error[512] = "";
    import_buffers buffers;
    t3r_recorded_frame out;
    assert_int_equal(import_frame(s->directory, &frame, NULL, 1500, 10, &buffers, &out, error, sizeof error), 0);
    assert_true(fabs(out.camera.fx - 70) < 1e-9 && fabs(out.camera.cx - 749.5) < 1e-9);
    for (uint32_t x = 0; x < 1500; x++) {
        assert_true(abs((int)buffers.rgb[3 * x] - (int)(x * 3 / 20)) <= 2);
    }
    import_buffers_free(&buffers);
}

/* Checks that a lens of more coefficients than a recording holds becomes a pinhole: a point is where the pinhole sees
 * it, and what the lens does not see is black and has no depth. */
TEST_WITH(test_bent_lenses_become_pinholes, scratch_setup, scratch_teardown)
{
    scratch *s = *state;
    static const double coefficients[8] = {0.3, -0.1, 0.01, -0.02, 0.05, 0.7, -0.2, 0.1}; /* k1 k2 p1 p2 k3 k4 k5 k6 */
    char error[512] = "";
    posed_frame frame = ramp_frame();
    import_buffers buffers;
    t3r_recorded_frame out;
    uint32_t checked = 0;
    write_ramps(s, 240, 160, 240, 160);
    memcpy(frame.intrinsics.coefficients, coefficients, sizeof coefficients);
    frame.intrinsics.distortion = T3R_DISTORTION_RADTAN;
    assert_int_equal(import_frame(s->directory, &frame, NULL, 0, 0, &buffers, &out, error, sizeof error), 0);
    assert_int_equal(out.camera.distortion, T3R_DISTORTION_NONE);
    assert_true(out.camera.fx == 210 && out.camera.coefficients[0] == 0);
    for (uint32_t v = 0; v < 160; v += 7) {
        for (uint32_t u = 0; u < 240; u += 7) {
            const double x = (u - 103.8) / 210, y = (v - 71.4) / 190, r = x * x + y * y, *k = coefficients;
            const double f =
                (1 + k[0] * r + k[1] * r * r + k[4] * r * r * r) / (1 + k[5] * r + k[6] * r * r + k[7] * r * r * r);
            const double column = 210 * (x * f + 2 * k[2] * x * y + k[3] * (r + 2 * x * x)) + 103.8;
            const double row = 190 * (y * f + k[2] * (r + 2 * y * y) + 2 * k[3] * x * y) + 71.4;
            if (column < 0 || row < 0 || column > 239 || row > 159) {
                continue;
            }
            const uint8_t *pixel = buffers.rgb + ((size_t)v * 240 + u) * 3;
            assert_true(fabs(pixel[0] - column) < 0.51 && fabs(pixel[1] - row) < 0.51);
            const uint16_t step = buffers.depth[(size_t)v * 240 + u];
            assert_true(fabs((step & 255) - column) < 0.51 && fabs((step >> 8) - row) < 0.51);
            checked++;
        }
    }
    assert_true(checked > 500);
    import_buffers_free(&buffers);
    frame.intrinsics.coefficients[0] = 1e-9; /* what a recording holds is left to it */
    memset(frame.intrinsics.coefficients + 5, 0, 3 * sizeof *coefficients);
    assert_int_equal(import_frame(s->directory, &frame, NULL, 0, 0, &buffers, &out, error, sizeof error), 0);
    assert_int_equal(out.camera.distortion, T3R_DISTORTION_RADTAN);
    import_buffers_free(&buffers);
}

TEST_WITH(test_the_ending_may_be_left_out, scratch_setup, scratch_teardown)
{
    scratch *s = *state;
    char error[512] = "", bare[] = "./colour", bare_depth[] = "depth";
    write_ramps(s, 240, 160, 240, 160);
    posed_frame frame = ramp_frame();
    frame.image = bare;
    frame.depth = bare_depth;
    import_buffers buffers;
    t3r_recorded_frame out;
    assert_int_equal(import_frame(s->directory, &frame, NULL, 16, 16, &buffers, &out, error, sizeof error), 0);
    import_buffers_free(&buffers);
}

/* Returns the length of [a, a + 1) within [low, high) */
static double overlap(double a, double low, double high)
{
    double from = a > low ? a : low, to = a + 1 < high ? a + 1 : high;
    return to > from ? to - from : 0;
}

static double box_mean(const picture *p, double x0, double x1, double y0, double y1, uint32_t channel)
{
    double sum = 0;
    const uint8_t *rgb = p->samples;
    for (uint32_t y = (uint32_t)y0; y < y1; y++) {
        for (uint32_t x = (uint32_t)x0; x < x1; x++) {
            sum += rgb[((size_t)y * p->width + x) * 3 + channel] * overlap(x, x0, x1) * overlap(y, y0, y1);
        }
    }
    return sum / ((x1 - x0) * (y1 - y0));
}

/* A real scene: every frame imports, and colours are the mean of each box. */
TEST(test_hololens_scene)
{
    char folder_path[512], error[1024] = "";
    const char *data = getenv("T3R_DATA");
    snprintf(folder_path, sizeof folder_path, "%s/hololens_b", data != NULL ? data : "../shared/data");
    if (access(folder_path, R_OK) != 0) {
        printf("SKIPPED: no %s\n", folder_path);
        skip();
    }
    posed_folder folder;
    if (posed_folder_open(folder_path, NULL, &folder, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
    assert_int_equal(folder.frame_count, 12);
    assert_int_equal(folder.triplet_count, 4);
    for (uint32_t i = 0; i < folder.frame_count; i++) {
        import_buffers buffers;
        t3r_recorded_frame out;
        picture source;
        char *path = posed_path(folder_path, folder.frames[i].image);
        const posed_frame *frame = &folder.frames[i];
        assert_int_equal(import_frame(folder_path, frame, NULL, 256, 256, &buffers, &out, error, sizeof error), 0);
        assert_int_equal(picture_read(path, &source, error, sizeof error), 0);
        assert_true(fabs(out.camera.fx - 495.56775700934577 * 256 / 360) < 1e-9);
        assert_true(fabs(out.camera.cx - ((270.00289719626164 - 90) * 256 / 360 - 0.5)) < 1e-9);
        for (uint32_t k = 0; k < 600; k++) {
            uint32_t x = k * 37 % 256, y = k * 101 % 256;
            for (uint32_t c = 0; c < 3; c++) {
                double mean = box_mean(&source, 90 + x * 360 / 256.0, 90 + (x + 1) * 360 / 256.0, y * 360 / 256.0,
                                       (y + 1) * 360 / 256.0, c);
                assert_true(fabs(buffers.rgb[(y * 256 + x) * 3 + c] - mean) < 0.501);
            }
        }
        free(path);
        picture_free(&source);
        import_buffers_free(&buffers);
    }
    posed_folder_close(&folder);
}
