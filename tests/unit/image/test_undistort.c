/* SPDX-License-Identifier: Apache-2.0 */
/* The undistortion grid against double, and sampling with it. */
#include "unit/unit.h"

#include "core/camera.h"
#include "image/undistort.h"
#include "trim3r.h"

#define Q16(x) ((int32_t)lround((x)*65536.0))
#define Q24(x) ((int32_t)lround((x)*16777216.0))

typedef struct lens_case {
    const char *name;
    uint32_t width, height;
    double fx, fy, cx, cy;
    t3r_distortion kind;
    double k[5];
    int realistic; /* interpolation is held to 0.1 pixels */
} lens_case;

static const lens_case cases[] = {
    {"webcam", 640, 480, 520, 518, 321.3, 243.9, T3R_DISTORTION_RADTAN, {0.12, -0.25, 0.001, -0.0015, 0.09}, 1},
    {"barrel", 256, 256, 190, 191, 127.2, 128.1, T3R_DISTORTION_RADTAN, {-0.28, 0.09, 0.0004, 0.0002, -0.012}, 1},
    {"tele", 4096, 3000, 16000, 16001, 2000, 1500, T3R_DISTORTION_RADTAN, {0.4, 30, 0, 0.001, 100}, 1},
    {"fisheye", 256, 256, 140, 139, 128.4, 126.8, T3R_DISTORTION_FISHEYE, {-0.02, 0.008, -0.004, 0.0006}, 1},
    {"fisheye large", 1280, 800, 450, 452, 640, 400, T3R_DISTORTION_FISHEYE, {0.03, -0.01, 0.002, -0.0003}, 1},
    {"fisheye plain", 97, 61, 20, 20, 48, 30, T3R_DISTORTION_FISHEYE, {0}, 0},
    {"fisheye narrow", 64, 64, 16000, 16000, 31, 33, T3R_DISTORTION_FISHEYE, {1, 2, 3, 4}, 1},
    {"wide", 128, 96, 40, 40, 60, 50, T3R_DISTORTION_RADTAN, {0.1, 0.01, 0.01, -0.01, 0.001}, 0},
};
enum { CASES = sizeof cases / sizeof cases[0] };

static t3r_camera camera_of(const lens_case *c)
{
    t3r_camera camera = {c->width,   c->height, Q16(c->fx), Q16(c->fy), Q16(c->cx),
                         Q16(c->cy), c->kind,   {0},        {0},        {1 << 30, 0, 0, 0}};
    for (int i = 0; i < 5; i++) {
        camera.distortion_q24[i] = Q24(c->k[i]);
    }
    return camera;
}

/* Computes the source by OpenCV's published models. */
static void real_source(const lens_case *c, double u, double v, double out[2])
{
    double x = (u - c->cx) / c->fx, y = (v - c->cy) / c->fy;
    double r2 = x * x + y * y, r = sqrt(r2);
    double bent_x, bent_y;
    if (c->kind == T3R_DISTORTION_FISHEYE) {
        double t = atan(r), t2 = t * t;
        double scale = r > 0 ? t * (1 + t2 * (c->k[0] + t2 * (c->k[1] + t2 * (c->k[2] + t2 * c->k[3])))) / r : 1;
        bent_x = x * scale;
        bent_y = y * scale;
    } else {
        double f = 1 + r2 * (c->k[0] + r2 * (c->k[1] + r2 * c->k[4]));
        bent_x = x * f + 2 * c->k[2] * x * y + c->k[3] * (r2 + 2 * x * x);
        bent_y = y * f + c->k[2] * (r2 + 2 * y * y) + 2 * c->k[3] * x * y;
    }
    out[0] = c->fx * bent_x + c->cx;
    out[1] = c->fy * bent_y + c->cy;
}

TEST(nodes)
{
    for (int i = 0; i < CASES; i++) {
        const lens_case *c = &cases[i];
        t3r_camera camera = camera_of(c);
        int32_t *grid = unit_array(T3R_GRID_VALUES(c->width, c->height), sizeof(int32_t));
        uint32_t across = c->width / T3R_GRID_STEP + 2, down = c->height / T3R_GRID_STEP + 2;
        double worst = 0, worst_between = 0;
        assert_int_equal(t3r_camera_check(&camera, c->width, c->height), T3R_OK);
        assert_int_equal(t3r_undistort_grid(&camera, c->width, c->height, grid), T3R_OK);
        for (uint32_t n = 0; n < across * down; n++) {
            double exact[2];
            real_source(c, n % across * 8.0, n / across * 8.0, exact);
            assert_true(grid[2 * n] != T3R_GRID_OUTSIDE);
            worst =
                fmax(worst, fmax(fabs(grid[2 * n] / 65536.0 - exact[0]), fabs(grid[2 * n + 1] / 65536.0 - exact[1])));
        }
        for (uint32_t y = 0; y < c->height; y += 3) {
            for (uint32_t x = 0; x < c->width; x += 3) {
                double exact[2];
                real_source(c, x, y, exact);
                for (uint32_t k = 0; k < 2; k++) {
                    const int32_t *node = grid + 2 * (y / 8 * across + x / 8) + k;
                    double a = x % 8 / 8.0, b = y % 8 / 8.0;
                    double between = ((1 - a) * node[0] + a * node[2]) * (1 - b) +
                                     ((1 - a) * node[2 * across] + a * node[2 * across + 2]) * b;
                    worst_between = fmax(worst_between, fabs(between / 65536 - exact[k]));
                }
            }
        }
        print_message("%s: node %.5f, between %.4f pixels\n", c->name, worst, worst_between);
        assert_true(worst < 1.0 / 16);
        assert_true(!c->realistic || worst_between < 0.1);
        free(grid);
    }
}

typedef struct planes {
    uint8_t *colour[3];
    uint16_t *depth;
} planes;

static planes planes_new(uint32_t width, uint32_t height)
{
    planes p;
    for (int c = 0; c < 3; c++) {
        p.colour[c] = unit_array(width, height);
    }
    p.depth = unit_array((size_t)width * height, sizeof(uint16_t));
    return p;
}

static void planes_free(planes p)
{
    for (int c = 0; c < 3; c++) {
        free(p.colour[c]);
    }
    free(p.depth);
}

/* Each sample is the bilinear (colour) or nearest (depth) one at the real source position, or 0 outside. */
TEST(sampling)
{
    for (int i = 0; i < CASES; i++) {
        const lens_case *c = &cases[i];
        if (c->width > 700) {
            continue;
        }
        uint32_t width = c->width, height = c->height;
        t3r_camera camera = camera_of(c);
        planes in = planes_new(width, height), out = planes_new(width, height);
        int32_t *grid = unit_array(T3R_GRID_VALUES(width, height), sizeof(int32_t));
        for (uint32_t at = 0; at < width * height; at++) {
            in.colour[0][at] = (uint8_t)(at % width * 254 / width + 1);
            in.colour[1][at] = (uint8_t)(at / width * 254 / height + 1);
            in.colour[2][at] = 255;
            in.depth[at] = (uint16_t)(1 + at % 60000);
        }
        assert_int_equal(t3r_undistort_grid(&camera, width, height, grid), T3R_OK);
        t3r_undistort_colour(grid, width, height, 0, height, (const uint8_t *const *)in.colour, out.colour);
        t3r_undistort_depth(grid, width, height, 0, height, in.depth, out.depth);
        uint32_t near_misses = 0;
        for (uint32_t at = 0; at < width * height; at++) {
            double p[2];
            real_source(c, at % width, at / width, p);
            double margin = fmin(fmin(p[0] + 0.5, p[1] + 0.5), fmin(width - 0.5 - p[0], height - 0.5 - p[1]));
            int shown = out.depth[at] != 0;
            assert_int_equal(shown, out.colour[2][at] != 0);
            if (fabs(margin) > 1) {
                assert_int_equal(shown, margin > 0);
            }
            if (!shown) {
                assert_int_equal(out.colour[0][at], 0);
                continue;
            }
            assert_int_equal(out.colour[2][at], 255);
            double slack = c->realistic ? 0.1 : 1;
            double x = fmin(fmax(p[0], 0), width - 1), y = fmin(fmax(p[1], 0), height - 1);
            assert_true(fabs(out.colour[0][at] - (x * 254 / width + 0.5)) < 1.2 + slack * 254 / width);
            assert_true(fabs(out.colour[1][at] - (y * 254 / height + 0.5)) < 1.2 + slack * 254 / height);
            uint32_t nearest = (uint32_t)floor(fmin(fmax(p[1], 0), height - 1) + 0.5) * width +
                               (uint32_t)floor(fmin(fmax(p[0], 0), width - 1) + 0.5);
            near_misses += out.depth[at] != in.depth[nearest];
        }
        /* a position within 0.1 of the middle between two pixels may be rounded either way */
        assert_true(!c->realistic || near_misses < width * height / 5);
        planes_free(in);
        planes_free(out);
        free(grid);
    }
}

/* No distortion, or one without coefficients: the image itself. */
TEST(identity)
{
    const uint32_t sizes[][2] = {{8, 8}, {31, 9}, {64, 50}, {9, 23}};
    uint64_t seed = 8;
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        for (int kind = T3R_DISTORTION_NONE; kind <= T3R_DISTORTION_RADTAN; kind++) {
            uint32_t width = sizes[s][0], height = sizes[s][1];
            lens_case c = {"", width, height, 77, 70, width * 0.47, height * 0.55, (t3r_distortion)kind, {0}, 1};
            t3r_camera camera = camera_of(&c);
            planes in = planes_new(width, height), out = planes_new(width, height);
            int32_t *grid = unit_array(T3R_GRID_VALUES(width, height), sizeof(int32_t));
            for (uint32_t at = 0; at < width * height; at++) {
                for (int k = 0; k < 3; k++) {
                    in.colour[k][at] = (uint8_t)unit_random(&seed);
                }
                in.depth[at] = (uint16_t)unit_random(&seed);
            }
            assert_int_equal(t3r_undistort_grid(&camera, width, height, grid), T3R_OK);
            t3r_undistort_colour(grid, width, height, 0, height, (const uint8_t *const *)in.colour, out.colour);
            t3r_undistort_depth(grid, width, height, 0, height, in.depth, out.depth);
            for (int k = 0; k < 3; k++) {
                assert_memory_equal(in.colour[k], out.colour[k], width * height);
            }
            assert_memory_equal(in.depth, out.depth, (size_t)width * height * 2);
            planes_free(in);
            planes_free(out);
            free(grid);
        }
    }
}

/* A polynomial that folds: nothing beyond the fold, not a mirrored image. */
TEST(fold)
{
    const uint32_t side = 128;
    /* r (1 - r^2 / 3) turns back at r = 1, 60 pixels from the centre */
    lens_case c = {"", side, side, 60, 60, 63.5, 63.5, T3R_DISTORTION_RADTAN, {-1.0 / 3, 0, 0, 0, 0}, 0};
    t3r_camera camera = camera_of(&c);
    planes in = planes_new(side, side), out = planes_new(side, side);
    int32_t *grid = unit_array(T3R_GRID_VALUES(side, side), sizeof(int32_t));
    for (uint32_t at = 0; at < side * side; at++) {
        in.depth[at] = 7;
    }
    assert_int_equal(t3r_undistort_grid(&camera, side, side, grid), T3R_OK);
    t3r_undistort_depth(grid, side, side, 0, side, in.depth, out.depth);
    for (uint32_t at = 0; at < side * side; at++) {
        double r = hypot(at % side - 63.5, at / side - 63.5);
        if (r < 45) {
            assert_int_equal(out.depth[at], 7);
        } else if (r > 61) {
            assert_int_equal(out.depth[at], 0);
        }
    }
    planes_free(in);
    planes_free(out);
    free(grid);
}

/* Any coefficients give a result, never undefined behaviour; wild ones give an error. */
TEST(wild)
{
    uint64_t seed = 21;
    const uint32_t width = 72, height = 40;
    int32_t *grid = unit_array(T3R_GRID_VALUES(width, height), sizeof(int32_t));
    planes in = planes_new(width, height), out = planes_new(width, height);
    uint32_t refused = 0, taken = 0;
    for (int turn = 0; turn < 600; turn++) {
        t3r_camera camera = {0};
        camera.rotation_q30[0] = 1 << 30;
        camera.distortion = turn % 2 == 0 ? T3R_DISTORTION_RADTAN : T3R_DISTORTION_FISHEYE;
        camera.fx_q16 = (int32_t)unit_between(&seed, 8 << 16, turn % 3 == 0 ? (16384 << 16) - 1 : 200 << 16);
        camera.fy_q16 = (int32_t)unit_between(&seed, 8 << 16, turn % 3 == 0 ? (16384 << 16) - 1 : 200 << 16);
        camera.cx_q16 = (int32_t)unit_between(&seed, -(16383 << 16), 16383 << 16) >> unit_between(&seed, 0, 12);
        camera.cy_q16 = (int32_t)unit_between(&seed, -(16383 << 16), 16383 << 16) >> unit_between(&seed, 0, 12);
        for (int i = 0; i < 5; i++) {
            camera.distortion_q24[i] = (int32_t)unit_between(&seed, INT32_MIN, INT32_MAX) >> unit_between(&seed, 0, 12);
        }
        if (t3r_camera_check(&camera, width, height) != T3R_OK) {
            continue;
        }
        if (t3r_undistort_grid(&camera, width, height, grid) != T3R_OK) {
            refused++;
            continue;
        }
        taken++;
        t3r_undistort_colour(grid, width, height, 0, height, (const uint8_t *const *)in.colour, out.colour);
        t3r_undistort_depth(grid, width, height, 0, height, in.depth, out.depth);
    }
    assert_true(refused > 50 && taken > 50);
    lens_case c = {"", width, height, 40, 40, 36, 20, T3R_DISTORTION_RADTAN, {-100, 0, 0, 0, 0}, 0};
    t3r_camera camera = camera_of(&c);
    assert_int_equal(t3r_undistort_grid(&camera, width, height, grid), T3R_ERR_CAMERA);
    planes_free(in);
    planes_free(out);
    free(grid);
}
