/* SPDX-License-Identifier: Apache-2.0 */
/* The integer raster against the float64 oracle on the same Gaussians: at least 50 dB, both rounded to 8 bits, over
 * all pixels. The arena's size must not change a pixel. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/float64/drawing.h"
#include "oracle/float64/oracle_raster.h"
#include "raster/raster_splat.h"
#include "test.h"

#define LEAST_DB 50.0
/* Alpha: Q15 against double. Depth: where transmittance passes 1/2 within the margin, a neighbour in the order is
 * valid, too. The shares allow for splats less than one step apart in depth, whose order depends on the last bit. */
#define ALPHA_TOLERANCE 0.004
#define ALPHA_SHARE 0.001
#define DEPTH_SHARE 0.001

static const t3r_scene_frame plain_frame;

/* ---- comparing ----------------------------------------------------------------------------------- */

static void compare_planes(const char *name, const oracle_image *want, const drawing *got)
{
    size_t pixels = (size_t)want->width * want->height, alpha_off = 0, depth_off = 0;
    for (size_t i = 0; i < pixels; i++) {
        double alpha = 1 - want->transmittance[i];
        alpha_off += fabs(got->alpha_q15[i] / 32768.0 - alpha) > ALPHA_TOLERANCE;
        /* one step of Q20 from rounding z, relative 2^-16 beyond */
        double depth = got->depth_q20[i] / 1048576.0, slack = 2e-6 + depth * 1.6e-5 + want->depth_slack[i];
        double first = want->depth_first[i], last = want->depth_last[i];
        int none_is_right = last == HUGE_VAL;
        depth_off += got->depth_q20[i] == 0 ? !none_is_right
                                            : first == 0 || depth < fmin(fmin(first, last), want->depth[i]) - slack ||
                                                  depth > fmax(fmax(first, last), want->depth[i]) + slack;
    }
    if ((double)alpha_off > ALPHA_SHARE * (double)pixels || (double)depth_off > DEPTH_SHARE * (double)pixels) {
        fail_msg("%s: of %zu pixels, alpha is off in %zu and median depth in %zu", name, pixels, alpha_off, depth_off);
    }
}

static oracle_image oracle_of(const t3r_scene_frame *frame, const t3r_gaussian *gaussians, size_t count,
                              const t3r_camera *camera, uint32_t width, uint32_t height)
{
    oracle_gaussian *exact = calloc(count == 0 ? 1 : count, sizeof *exact);
    assert_non_null(exact);
    for (size_t i = 0; i < count; i++) {
        oracle_from_t3r(&gaussians[i], &exact[i]);
    }
    oracle_camera view = oracle_camera_from_t3r(camera, frame, width, height);
    oracle_image image;
    oracle_render(exact, count, &view, &image);
    free(exact);
    return image;
}

static void check_colour(const char *name, const oracle_image *want, const drawing *got, size_t count)
{
    double db = oracle_psnr(want, got->rgb, (size_t)got->width * 3);
    if (count > 1) {
        print_message("%-34s %4ux%-4u %6zu Gaussians, %6u drawn: %5.1f dB\n", name, got->width, got->height, count,
                      want->drawn, db);
    }
    if (db < LEAST_DB) {
        fail_msg("%s: %.1f dB, wanted %.1f", name, db, LEAST_DB);
    }
}

static void check(const char *name, const t3r_scene_frame *frame, const t3r_gaussian *gaussians, size_t count,
                  const t3r_camera *camera, uint32_t width, uint32_t height)
{
    oracle_image want = oracle_of(frame, gaussians, count, camera, width, height);
    drawing got = draw_scene(frame, gaussians, count, camera, width, height, ARENA_AT_FULL);
    check_colour(name, &want, &got, count);
    compare_planes(name, &want, &got);
    drawing_free(&got);
    oracle_image_free(&want);
}

/* ---- scenes -------------------------------------------------------------------------------------- */

typedef struct recipe {
    const char *name;
    uint32_t count, width, height;
    double focal;
    double least_z, most_z;
    double spread;                  /* positions up to this multiple of the half field of view */
    double least_sigma, most_sigma; /* scene units, log-uniform */
    double anisotropy;              /* longest over shortest axis */
    double least_opacity, most_opacity;
} recipe;

static t3r_gaussian *cook(const recipe *r, uint64_t seed)
{
    t3r_gaussian *gaussians = calloc(r->count, sizeof *gaussians);
    assert_non_null(gaussians);
    dice d = {seed};
    for (uint32_t i = 0; i < r->count; i++) {
        double z = dice_between(&d, r->least_z, r->most_z), beam = r->spread * fabs(z) / r->focal;
        double x = dice_between(&d, -0.5, 0.5) * r->width * beam, y = dice_between(&d, -0.5, 0.5) * r->height * beam;
        double sigma = r->least_sigma * pow(r->most_sigma / r->least_sigma, dice_between(&d, 0, 1));
        gaussians[i] = round_gaussian(x, y, z, sigma, dice_between(&d, r->least_opacity, r->most_opacity),
                                      dice_between(&d, 0, 1), dice_between(&d, 0, 1), dice_between(&d, 0, 1));
        double axes[3] = {sigma, sigma * pow(r->anisotropy, -dice_between(&d, 0, 1)), sigma / r->anisotropy}, f[9];
        random_factor(&d, axes, f);
        set_factor(&gaussians[i], f);
    }
    return gaussians;
}

TEST(random_scenes)
{
    static const recipe recipes[] = {
        {"small round", 20000, 256, 256, 250, 0.5, 4, 1.1, 0.001, 0.02, 1, 0.05, 1},
        {"discs", 20000, 256, 256, 250, 0.5, 4, 1.1, 0.002, 0.04, 30, 0.1, 1},
        {"faint", 20000, 256, 256, 250, 0.5, 4, 1.1, 0.005, 0.05, 3, 0, 0.05},
        {"large and few", 300, 256, 256, 250, 0.5, 4, 1.3, 0.05, 1, 5, 0.1, 1},
        {"needles 1000:1", 3000, 256, 256, 250, 0.5, 4, 1.1, 0.05, 0.5, 1000, 0.2, 1},
        {"all sizes", 5000, 256, 256, 250, 0.1, 16, 1.2, 0.0001, 0.5, 10, 0.02, 1},
        {"far away", 5000, 256, 256, 250, 100, 900, 1.1, 0.5, 10, 5, 0.1, 1},
        {"as dense as two views", 131072, 256, 256, 250, 1, 2, 1.0, 0.003, 0.006, 8, 0.6, 1},
        {"one pixel", 500, 1, 1, 8, 0.5, 4, 1.1, 0.01, 0.3, 3, 0.05, 0.5},
        {"odd sides", 1000, 17, 33, 30, 0.5, 4, 1.1, 0.01, 0.1, 5, 0.1, 1},
        {"640 x 480", 20000, 640, 480, 525, 0.5, 4, 1.1, 0.002, 0.05, 10, 0.1, 1},
        {"wide angle", 10000, 320, 200, 60, 0.2, 4, 1.1, 0.005, 0.1, 5, 0.1, 1},
        {"telescope", 5000, 256, 256, 8000, 2, 8, 1.1, 0.0002, 0.005, 5, 0.1, 1},
    };
    for (size_t i = 0; i < sizeof recipes / sizeof recipes[0]; i++) {
        const recipe *r = &recipes[i];
        t3r_gaussian *gaussians = cook(r, 0x9e3779b97f4a7c15u + i);
        t3r_camera camera = plain_camera(r->focal, r->width, r->height);
        check(r->name, &plain_frame, gaussians, r->count, &camera, r->width, r->height);
        free(gaussians);
    }
}

/* Turned cameras at other places, with unequal focal lengths and an off-centre principal point. */
TEST(moved_cameras)
{
    static const recipe r = {"ball", 8000, 200, 160, 200, -1, 1, 1, 0.005, 0.05, 20, 0.1, 1};
    t3r_gaussian *gaussians = cook(&r, 77);
    dice d = {78};
    for (uint32_t i = 0; i < r.count; i++) {
        for (int k = 0; k < 3; k++) {
            gaussians[i].position_q20[k] = (int32_t)dice_below(&d, 1 << 21) - (1 << 20);
        }
    }
    for (int i = 0; i < 6; i++) {
        const double turn = i * 1.1, at[3] = {0.1, -0.1, 0};
        const double position[3] = {3 * sin(turn), i - 2.5, 3 * cos(turn)};
        t3r_camera camera = camera_towards(200, r.width, r.height, position, at);
        camera.fy_q16 += 9 << 16;
        camera.cx_q16 += 123457;
        camera.cy_q16 -= 765432;
        for (int k = 0; k < 4 && i == 3; k++) {
            camera.rotation_q30[k] = camera.rotation_q30[k] / 2 + camera.rotation_q30[k] / 5; /* any norm will do */
        }
        check("moved camera", &plain_frame, gaussians, r.count, &camera, r.width, r.height);
        /* The same place in map coordinates, in units 1/64 as large. */
        t3r_scene_frame frame = {{(int64_t)4123456 << 32, -((int64_t)512345 << 32), 99}, -6};
        for (int k = 0; k < 3; k++) {
            camera.position_q32[k] = camera.position_q32[k] / 64 + frame.origin_q32[k];
        }
        check("moved camera, moved frame", &frame, gaussians, r.count, &camera, r.width, r.height);
    }
    free(gaussians);
}

TEST(degenerate_covariances)
{
    enum { COUNT = 2000, SIDE = 128 };
    t3r_gaussian *gaussians = calloc(COUNT, sizeof *gaussians);
    assert_non_null(gaussians);
    t3r_camera camera = plain_camera(120, SIDE, SIDE);
    dice d = {5};
    for (int kind = 0; kind < 7; kind++) {
        static const char *const names[] = {"zero factors",      "one axis only",  "two axes only",
                                            "least exponent",    "a line along z", "unnormalised mantissas",
                                            "sizes 2^-40 to 2^3"};
        for (int i = 0; i < COUNT; i++) {
            double z = dice_between(&d, 0.5, 3);
            t3r_gaussian g = round_gaussian(dice_between(&d, -0.5, 0.5) * z, dice_between(&d, -0.5, 0.5) * z, z, 0.05,
                                            dice_between(&d, 0.1, 1), dice_between(&d, 0, 1), dice_between(&d, 0, 1),
                                            dice_between(&d, 0, 1));
            double sigma[3] = {0.05, 0, 0}, f[9];
            sigma[1] = kind == 2 ? 0.02 : 0;
            random_factor(&d, sigma, f);
            if (kind == 0) {
                memset(g.factor, 0, sizeof g.factor);
                g.factor_exponent = (int8_t)((int)dice_below(&d, 76) - 60);
            } else if (kind <= 2) {
                set_factor(&g, f);
            } else if (kind == 3) {
                g.factor_exponent = -60;
            } else if (kind == 4) {
                const double line[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0.4};
                set_factor(&g, line);
            } else if (kind == 5) {
                for (int k = 0; k < 9; k++) {
                    g.factor[k] = (int16_t)((int)dice_below(&d, 7) - 3);
                }
                g.factor_exponent = -6;
            } else {
                sigma[0] = ldexp(1, (int)dice_below(&d, 44) - 40);
                sigma[1] = sigma[2] = sigma[0];
                random_factor(&d, sigma, f);
                set_factor(&g, f);
                g.opacity_q15 /= 16;
            }
            gaussians[i] = g;
        }
        check(names[kind], &plain_frame, gaussians, COUNT, &camera, SIDE, SIDE);
    }
    free(gaussians);
}

static void huge_scenes(int least_exponent, int most_exponent)
{
    enum { COUNT = 60, SIDE = 96 };
    t3r_gaussian gaussians[COUNT];
    t3r_camera camera = plain_camera(90, SIDE, SIDE);
    dice d = {6};
    for (int exponent = least_exponent; exponent <= most_exponent; exponent++) {
        for (int i = 0; i < COUNT; i++) {
            double z = dice_between(&d, 0.5, 30);
            gaussians[i] = round_gaussian(dice_between(&d, -1, 1) * z, dice_between(&d, -1, 1) * z, z, 1,
                                          dice_between(&d, 0.02, 0.2), dice_between(&d, 0, 1), dice_between(&d, 0, 1),
                                          dice_between(&d, 0, 1));
            double sigma[3] = {ldexp(dice_between(&d, 1, 2), exponent), ldexp(1, exponent - 2), ldexp(1, exponent - 9)};
            double f[9];
            random_factor(&d, sigma, f);
            set_factor(&gaussians[i], f);
        }
        char name[32];
        (void)snprintf(name, sizeof name, "huge, 2^%d scene units", exponent);
        check(name, &plain_frame, gaussians, COUNT, &camera, SIDE, SIDE);
    }
}

/* Splats up to 64 times as wide as the median depth. */
TEST(huge_splats)
{
    huge_scenes(0, 6);
}

/* Extreme values, up to the limits of the record. */
TEST(absurd_splats)
{
    huge_scenes(7, 29);
    enum { SIDE = 96 };
    t3r_camera camera = plain_camera(90, SIDE, SIDE);
    t3r_gaussian g = round_gaussian(0, 0, 2, 1, 0.5, 1, 0.5, 0.25);
    for (int k = 0; k < 9; k++) {
        g.factor[k] = (int16_t)(k % 4 == 0 ? 32767 : 0);
    }
    g.factor_exponent = 15;
    check("widest of all", &plain_frame, &g, 1, &camera, SIDE, SIDE);
    for (int k = 0; k < 9; k++) {
        g.factor[k] = INT16_MIN;
    }
    check("widest line", &plain_frame, &g, 1, &camera, SIDE, SIDE);
}

/* One splat at a time over the whole range of focal lengths, depths, sizes up to 1000 pixels, shapes and places. */
TEST(single_splats)
{
    dice d = {12345};
    for (int i = 0; i < 8000; i++) {
        uint32_t w = 1 + dice_below(&d, 64), h = 1 + dice_below(&d, 64);
        double focal = exp(dice_between(&d, log(8), log(16383))), z = exp(dice_between(&d, log(0.032), log(900)));
        t3r_camera camera = plain_camera(focal, w, h);
        double x = dice_between(&d, -0.5 * w - 20, 0.5 * w + 20) * z / focal;
        double y = dice_between(&d, -0.5 * h - 20, 0.5 * h + 20) * z / focal;
        double long_axis = exp(dice_between(&d, log(0.05), log(1000))) * z / focal;
        double sigma[3] = {long_axis, long_axis * exp(-dice_between(&d, 0, 7)),
                           long_axis * exp(-dice_between(&d, 0, 7))};
        double f[9];
        t3r_gaussian g = round_gaussian(x, y, z, 1, exp(dice_between(&d, log(0.004), 0)), 1, 0.6, 0.3);
        random_factor(&d, sigma, f);
        if (fabs(x) > 1000 || fabs(y) > 1000 || sigma[0] > 1e9) {
            continue; /* outside of what a record holds */
        }
        set_factor(&g, f);
        oracle_image want = oracle_of(&plain_frame, &g, 1, &camera, w, h);
        drawing got = draw_scene(&plain_frame, &g, 1, &camera, w, h, ARENA_AT_FULL);
        check_colour("single splat", &want, &got, 1);
        drawing_free(&got);
        oracle_image_free(&want);
    }
}

TEST(near_plane)
{
    static const recipe recipes[] = {
        {"across the near plane", 400, 128, 128, 120, -0.5, 0.5, 1.5, 0.001, 0.05, 5, 0.05, 0.6},
        {"just before the near plane", 400, 128, 128, 120, 0.02, 0.045, 1.2, 0.0001, 0.002, 5, 0.05, 0.6},
        {"large ones close by", 200, 128, 128, 120, 0.01, 0.4, 3, 0.01, 0.5, 10, 0.02, 0.2},
    };
    for (size_t i = 0; i < sizeof recipes / sizeof recipes[0]; i++) {
        t3r_gaussian *gaussians = cook(&recipes[i], 1000 + i);
        t3r_camera camera = plain_camera(recipes[i].focal, recipes[i].width, recipes[i].height);
        check(recipes[i].name, &plain_frame, gaussians, recipes[i].count, &camera, recipes[i].width, recipes[i].height);
        free(gaussians);
    }
    /* A splat exactly on the near plane is culled, one step beyond it drawn; none behind the camera is drawn. */
    t3r_camera camera = plain_camera(100, 33, 33);
    static const struct {
        int32_t z_q20;
        int drawn;
    } cases[] = {{1 << 15, 0}, {(1 << 15) + 1, 1}, {(1 << 15) - 1, 0}, {0, 0}, {-(1 << 20), 0}, {INT32_MIN / 2 + 1, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        t3r_gaussian g = round_gaussian(0, 0, 1, 0.0001, 0.9, 1, 1, 1);
        g.position_q20[2] = cases[i].z_q20;
        drawing d = draw_scene(&plain_frame, &g, 1, &camera, 33, 33, ARENA_AT_FULL);
        assert_int_equal(d.rgb[(16 * 33 + 16) * 3] > 0, cases[i].drawn);
        drawing_free(&d);
    }
}

/* Culling by the side: |x|/z or |y|/z over 16, and the Jacobian held at 1.3 x the picture's edge. */
TEST(far_off_axis)
{
    static const recipe recipes[] = {
        {"beyond the clamp", 1500, 128, 96, 120, 0.3, 2, 4, 0.05, 0.8, 5, 0.05, 0.5},
        {"up to and past 16 z", 3000, 64, 64, 60, 0.1, 0.5, 40, 0.1, 2, 5, 0.05, 0.5},
    };
    for (size_t i = 0; i < sizeof recipes / sizeof recipes[0]; i++) {
        t3r_gaussian *gaussians = cook(&recipes[i], 2000 + i);
        t3r_camera camera = plain_camera(recipes[i].focal, recipes[i].width, recipes[i].height);
        check(recipes[i].name, &plain_frame, gaussians, recipes[i].count, &camera, recipes[i].width, recipes[i].height);
        free(gaussians);
    }
}

/* Returns the camera of the part of a picture that begins at a pixel, which may lie outside. */
static t3r_camera part_of(t3r_camera whole, int32_t left, int32_t top)
{
    whole.cx_q16 -= left * (1 << 16);
    whole.cy_q16 -= top * (1 << 16);
    return whole;
}

/* The Jacobian is clamped at 1.3 times the edge that is farther from the axis, or at |x|/z = 16, beyond which nothing
 * is drawn. The axis is in the middle, elsewhere in the picture, beside it, and as far away as cameras allow. */
TEST(farther_edges)
{
    static const struct {
        uint32_t width, height;
        int32_t left, top;
        double x, y;
    } cases[] = {{80, 40, 0, 0, 6.5, 3.25},       {400, 80, 0, 0, 16, 6.5},           {80, 4096, 0, 0, 6.5, 16},
                 {4096, 4096, 0, 0, 16, 16},      {40, 20, 8, -8, 4.55, 2.925},       {20, 10, 40, -30, 8.125, 5.6875},
                 {16, 16, 16391, -16376, 16, 16}, {4096, 4096, 18431, -14336, 16, 16}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const t3r_camera camera =
            part_of(plain_camera(8, cases[i].width, cases[i].height), cases[i].left, cases[i].top);
        t3r_projection projection;
        assert_int_equal(t3r_projection_make(&camera, &plain_frame, cases[i].width, cases[i].height, &projection),
                         T3R_OK);
        assert_int_equal(projection.limit_x_q24, (int32_t)floor(cases[i].x * 16777216));
        assert_int_equal(projection.limit_y_q24, (int32_t)floor(cases[i].y * 16777216));
    }
}

/* A crop in whole tiles that has the farther edges of a picture is the same pixels, bit for bit, and agrees with the
 * oracle; its axis may be far outside. Other crops clamp the Jacobian of Gaussians outside them a little earlier. */
TEST(crops)
{
    enum { WIDTH = 512, HEIGHT = 384 };
    static const recipe r = {"whole picture", 3000, WIDTH, HEIGHT, 200, 0.5, 4, 1.4, 0.01, 0.4, 5, 0.1, 0.8};
    static const struct {
        const char *name;
        uint32_t left, top, width, height;
    } corners[] = {{"left half", 0, 0, 256, HEIGHT},       {"lower right quarter", 256, 192, 256, 192},
                   {"upper left corner", 0, 0, 64, 48},    {"upper right corner", 448, 0, 64, 64},
                   {"lower left corner", 0, 320, 64, 64},  {"lower right tile", 496, 368, 16, 16},
                   {"beside the middle", 240, 0, 272, 384}};
    t3r_gaussian *gaussians = cook(&r, 4000);
    const t3r_camera camera = plain_camera(r.focal, WIDTH, HEIGHT);
    drawing whole = draw_scene(&plain_frame, gaussians, r.count, &camera, WIDTH, HEIGHT, ARENA_AT_FULL);
    for (size_t i = 0; i < sizeof corners / sizeof corners[0]; i++) {
        const uint32_t left = corners[i].left, top = corners[i].top, width = corners[i].width;
        const t3r_camera part = part_of(camera, (int32_t)left, (int32_t)top);
        drawing got = draw_scene(&plain_frame, gaussians, r.count, &part, width, corners[i].height, ARENA_AT_FULL);
        for (uint32_t y = 0; y < got.height; y++) {
            const size_t from = (size_t)(top + y) * WIDTH + left, to = (size_t)y * width;
            assert_memory_equal(got.rgb + 3 * to, whole.rgb + 3 * from, 3 * width);
            assert_memory_equal(got.depth_q20 + to, whole.depth_q20 + from, 4 * width);
            assert_memory_equal(got.alpha_q15 + to, whole.alpha_q15 + from, 2 * width);
        }
        drawing_free(&got);
        check(corners[i].name, &plain_frame, gaussians, r.count, &part, width, corners[i].height);
    }
    drawing_free(&whole);
    free(gaussians);
}

TEST(at_the_border)
{
    enum { SIDE = 48 };
    /* z = 1, so that pixel = focal x + 23.5; edges -0.5 and 47.5, outermost pixel centres 0 and 47 */
    static const double pixels[] = {-3, -0.5, 0, 0.25, 15.5, 16, 46.75, 47, 47.5, 50};
    enum { PLACES = sizeof pixels / sizeof pixels[0] };
    t3r_camera camera = plain_camera(64, SIDE, SIDE);
    t3r_gaussian all[PLACES * PLACES];
    for (int i = 0; i < PLACES * PLACES; i++) {
        double x = (pixels[i % PLACES] - 23.5) / 64, y = (pixels[i / PLACES] - 23.5) / 64;
        all[i] = round_gaussian(x, y, 1, 0.02, 0.9, (i % 7) / 6.0, (i % 5) / 4.0, (i % 3) / 2.0);
        check("one at the border", &plain_frame, &all[i], 1, &camera, SIDE, SIDE);
    }
    check("all at the border", &plain_frame, all, PLACES * PLACES, &camera, SIDE, SIDE);
}

TEST(saturation)
{
    enum { LAYERS = 500, SIDE = 40 };
    t3r_gaussian *gaussians = calloc(LAYERS, sizeof *gaussians);
    assert_non_null(gaussians);
    t3r_camera camera = plain_camera(40, SIDE, SIDE);
    for (int opacity = 0; opacity < 3; opacity++) {
        static const double values[] = {1, 0.5, 0.01};
        for (int i = 0; i < LAYERS; i++) {
            gaussians[i] = round_gaussian(0, 0, 1 + i / 100.0, 2, values[opacity], 1, i % 2, i < 3 ? 0 : 1);
        }
        check("many layers", &plain_frame, gaussians, LAYERS, &camera, SIDE, SIDE);
    }
    /* Equal depths: the index decides. */
    for (int i = 0; i < LAYERS; i++) {
        gaussians[i] = round_gaussian(0, 0, 1, 2, 0.7, i == 0, i == 1, i > 1);
    }
    check("layers at one depth", &plain_frame, gaussians, LAYERS, &camera, SIDE, SIDE);
    drawing d = draw_scene(&plain_frame, gaussians, LAYERS, &camera, SIDE, SIDE, ARENA_AT_FULL);
    const uint8_t *middle = &d.rgb[(20 * SIDE + 20) * 3];
    assert_in_range(middle[0], 176, 180); /* 0.7 of 255 */
    assert_in_range(middle[1], 52, 55);   /* 0.3 x 0.7 */
    drawing_free(&d);
    free(gaussians);
}

/* Sigma, depth and focal length are chosen for a closed form: the oracle agrees to rounding, the raster to one level.
 */
TEST(closed_form)
{
    enum { SIDE = 31, MIDDLE = 15 };
    static const struct {
        double sigma, z, opacity;
    } cases[] = {{0.02, 1, 0.8}, {0, 2, 1}, {0.1, 4, 0.3}, {0.5, 1, 0.999}, {0.01, 0.25, 0.5}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        t3r_camera camera = plain_camera(64, SIDE, SIDE);
        t3r_gaussian g = round_gaussian(0, 0, cases[i].z, cases[i].sigma, cases[i].opacity, 1, 0.5, 0.25);
        oracle_image want = oracle_of(&plain_frame, &g, 1, &camera, SIDE, SIDE);
        drawing got = draw_scene(&plain_frame, &g, 1, &camera, SIDE, SIDE, ARENA_AT_FULL);
        double sigma = ldexp(g.factor[0], g.factor_exponent), opacity = g.opacity_q15 / 32768.0;
        double variance = pow(64 * sigma / cases[i].z, 2) + 0.3;
        for (int y = 0; y < SIDE; y++) {
            for (int x = 0; x < SIDE; x++) {
                double d2 = pow(x - MIDDLE, 2) + pow(y - MIDDLE, 2);
                double alpha = fmin(0.99, opacity * exp(-d2 / (2 * variance)));
                int pixel = y * SIDE + x;
                if (fabs(alpha - 1 / 255.0) < 2e-5) {
                    continue; /* at the threshold both are valid */
                }
                alpha = alpha < 1 / 255.0 ? 0 : alpha;
                assert_true(fabs(want.rgb[pixel * 3] - alpha) < 1e-12);
                assert_true(fabs(want.transmittance[pixel] - (1 - alpha)) < 1e-12);
                for (int c = 0; c < 3; c++) {
                    double level = alpha * g.colour_q7[c] / 128.0;
                    assert_true(fabs(got.rgb[pixel * 3 + c] - level) <= 1);
                }
                assert_true(fabs(got.alpha_q15[pixel] / 32768.0 - alpha) < 0.002);
                assert_int_equal(got.depth_q20[pixel], alpha > 0.5 ? g.position_q20[2] : 0);
            }
        }
        drawing_free(&got);
        oracle_image_free(&want);
    }
}

TEST(nothing_to_see)
{
    t3r_camera camera = plain_camera(50, 20, 20);
    t3r_gaussian behind = round_gaussian(0, 0, -1, 0.1, 1, 1, 1, 1);
    t3r_gaussian clear = round_gaussian(0, 0, 1, 0.1, 0, 1, 1, 1);
    t3r_gaussian aside = round_gaussian(10, 0, 1, 0.1, 1, 1, 1, 1);
    const t3r_gaussian scenes[][3] = {{behind, behind, behind}, {clear, clear, clear}, {aside, behind, clear}};
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        drawing d = draw_scene(&plain_frame, scenes[i], 3, &camera, 20, 20, ARENA_AT_FULL);
        for (int p = 0; p < 400; p++) {
            assert_int_equal(d.rgb[p * 3] + d.rgb[p * 3 + 1] + d.rgb[p * 3 + 2], 0);
            assert_int_equal(d.alpha_q15[p], 0);
            assert_int_equal(d.depth_q20[p], 0);
        }
        drawing_free(&d);
    }
    drawing empty = draw_scene(&plain_frame, NULL, 0, &camera, 20, 20, ARENA_AT_FULL);
    drawing hidden = draw_scene(&plain_frame, scenes[0], 3, &camera, 20, 20, ARENA_AT_MINIMUM);
    assert_true(drawing_equal(&empty, &hidden));
    drawing_free(&empty);
    drawing_free(&hidden);
}

/* ---- the arena never shows ----------------------------------------------------------------------- */

TEST(arena_sizes)
{
    static const recipe recipes[] = {
        {"small", 3000, 160, 120, 150, 0.5, 4, 1.1, 0.002, 0.02, 5, 0.1, 1},
        {"wide", 500, 160, 120, 150, 0.5, 4, 1.2, 0.1, 1, 5, 0.05, 0.9},
        {"one", 1, 160, 120, 150, 1, 1.1, 0.1, 0.5, 0.6, 1, 0.5, 0.6},
        /* with full lists, more splats in 64 tiles than one worker draws between two calls of the progress hook */
        {"all tiles", 1100, 128, 128, 100, 1, 1.1, 0.1, 4, 5, 1, 0.2, 1},
    };
    static const int several_at_minimum[] = {0, 1, 1, 1};
    for (size_t i = 0; i < sizeof recipes / sizeof recipes[0]; i++) {
        const recipe *r = &recipes[i];
        t3r_gaussian *gaussians = cook(r, 3000 + i);
        t3r_camera camera = plain_camera(r->focal, r->width, r->height);
        drawing few, full, many;
        few = draw_scene(&plain_frame, gaussians, r->count, &camera, r->width, r->height, ARENA_AT_MINIMUM);
        full = draw_scene(&plain_frame, gaussians, r->count, &camera, r->width, r->height, ARENA_AT_FULL);
        many = draw_scene(&plain_frame, gaussians, r->count, &camera, r->width, r->height, ARENA_AT_TEN_TIMES);
        print_message("%-6s passes: %u at the minimum, %u full, %u at ten times\n", r->name, few.passes, full.passes,
                      many.passes);
        assert_true(drawing_equal(&few, &full));
        assert_true(drawing_equal(&few, &many));
        assert_true(few.passes >= full.passes && full.passes >= many.passes && many.passes >= 1);
        if (several_at_minimum[i]) {
            assert_true(few.passes > 1);
        }
        assert_true(many.passes < few.passes || few.passes == 1);
        /* and every size between the two, including unaligned ones */
        t3r_config config = render_config(r->count, r->width, r->height);
        t3r_plan_info plan;
        assert_int_equal(t3r_plan(&config, &plan), T3R_OK);
        for (int step = 1; step < 16; step++) {
            arena a = arena_of_bytes(plan.min_bytes + (plan.bytes - plan.min_bytes) * (size_t)step / 16 + (size_t)step);
            t3r_runtime *rt = NULL;
            assert_int_equal(t3r_init(&rt, a.bytes, a.count, &config), T3R_OK);
            load_scene(rt, &plain_frame, gaussians, r->count);
            drawing d = draw(rt, &camera, r->width, r->height);
            assert_true(drawing_equal(&few, &d));
            assert_true(d.passes <= few.passes && d.passes >= many.passes);
            drawing_free(&d);
            arena_free(&a);
        }
        drawing_free(&few);
        drawing_free(&full);
        drawing_free(&many);
        free(gaussians);
    }
}

TEST(copied_arena)
{
    static const recipe r = {"copy", 2000, 100, 80, 90, 0.5, 4, 1.1, 0.01, 0.1, 5, 0.1, 1};
    t3r_gaussian *gaussians = cook(&r, 4000);
    t3r_camera camera = plain_camera(r.focal, r.width, r.height);
    t3r_config config = render_config(r.count, r.width, r.height);
    arena first = arena_of(&config, ARENA_AT_MINIMUM), second = arena_of_bytes(first.count);
    t3r_runtime *rt = NULL, *copy = NULL;
    assert_int_equal(t3r_init(&rt, first.bytes, first.count, &config), T3R_OK);
    load_scene(rt, &plain_frame, gaussians, r.count);
    drawing before = draw(rt, &camera, r.width, r.height);
    memcpy(second.bytes, first.bytes, first.count);
    memset(first.bytes, 0xff, first.count);
    arena_free(&first);
    assert_int_equal(t3r_attach(&copy, second.bytes, second.count), T3R_OK);
    drawing after = draw(copy, &camera, r.width, r.height);
    assert_true(drawing_equal(&before, &after));
    t3r_scene scene;
    assert_int_equal(t3r_get_scene(copy, &scene), T3R_OK);
    assert_int_equal(scene.count, r.count);
    assert_memory_equal(scene.gaussians, gaussians, r.count * sizeof *gaussians);
    drawing_free(&before);
    drawing_free(&after);
    arena_free(&second);
    free(gaussians);
}

/* Smaller targets than the arena was planned for, padded rows, and each output alone: the same pixels. */
static void draw_apart(double least_sigma, double opacity)
{
    enum { W = 53, H = 37, PAD = 12 };
    const recipe r = {"apart", 800, W, H, 50, 0.5, 4, 1.1, least_sigma, 10 * least_sigma, 5, opacity, 1};
    t3r_gaussian *gaussians = cook(&r, 5000);
    t3r_camera camera = plain_camera(r.focal, W, H);
    drawing whole = draw_scene(&plain_frame, gaussians, r.count, &camera, W, H, ARENA_AT_FULL);
    t3r_config config = render_config(r.count, 300, 200);
    arena a = arena_of(&config, ARENA_AT_MINIMUM);
    t3r_runtime *rt = NULL;
    assert_int_equal(t3r_init(&rt, a.bytes, a.count, &config), T3R_OK);
    load_scene(rt, &plain_frame, gaussians, r.count);
    static uint8_t rgb[H][W * 3 + PAD];
    static uint32_t depth[H][W + PAD];
    static uint16_t alpha[H][W + PAD];
    memset(rgb, 0xee, sizeof rgb);
    memset(depth, 0xee, sizeof depth);
    memset(alpha, 0xee, sizeof alpha);
    t3r_target target = {.width = W, .height = H, .rgb = rgb[0], .rgb_stride_bytes = sizeof rgb[0]};
    assert_int_equal(t3r_render(rt, &camera, &target), T3R_OK);
    target = (t3r_target){.width = W, .height = H, .depth_q20 = depth[0], .depth_stride_bytes = sizeof depth[0]};
    assert_int_equal(t3r_render(rt, &camera, &target), T3R_OK);
    target = (t3r_target){.width = W, .height = H, .alpha_q15 = alpha[0], .alpha_stride_bytes = sizeof alpha[0]};
    assert_int_equal(t3r_render(rt, &camera, &target), T3R_OK);
    for (size_t y = 0; y < H; y++) {
        assert_memory_equal(rgb[y], whole.rgb + y * W * 3, W * 3);
        assert_memory_equal(depth[y], whole.depth_q20 + y * W, W * sizeof depth[0][0]);
        assert_memory_equal(alpha[y], whole.alpha_q15 + y * W, W * sizeof alpha[0][0]);
        for (size_t x = 0; x < PAD; x++) {
            assert_int_equal(rgb[y][W * 3 + x], 0xee);
            assert_int_equal(depth[y][W + x], 0xeeeeeeeeu);
            assert_int_equal(alpha[y][W + x], 0xeeee);
        }
    }
    arena_free(&a);
    drawing_free(&whole);
    free(gaussians);
}

TEST(outputs_apart)
{
    draw_apart(0.01, 0.1);
    draw_apart(0.2, 0.9); /* tiles that are soon opaque */
}

static void note_hash(void *user, t3r_stage stage, uint64_t hash)
{
    assert_int_equal(stage, T3R_STAGE_RASTER);
    *(uint64_t *)user = hash;
}

/* The stage's hash covers the requested planes and ignores the bytes between their rows. */
TEST(planes_are_hashed)
{
    enum { W = 21, H = 17 };
    static const recipe r = {"hashed", 200, W, H, 20, 0.5, 4, 1.1, 0.01, 0.1, 5, 0.1, 1};
    t3r_gaussian *gaussians = cook(&r, 60);
    t3r_camera camera = plain_camera(r.focal, W, H);
    t3r_config config = render_config(r.count, W, H);
    arena a = arena_of(&config, ARENA_AT_MINIMUM);
    t3r_runtime *rt = NULL;
    uint64_t hash = 0, seen[3];
    const t3r_hooks hooks = {.user = &hash, .stage_hash = note_hash};
    assert_int_equal(t3r_init(&rt, a.bytes, a.count, &config), T3R_OK);
    assert_int_equal(t3r_set_hooks(rt, &hooks), T3R_OK);
    load_scene(rt, &plain_frame, gaussians, r.count);
    static uint8_t rgb[H][W * 3 + 4];
    static uint32_t depth[H][W + 4];
    static uint16_t alpha[H][W + 4];
    for (uint32_t pad = 0; pad <= 4; pad += 4) {
        const t3r_target targets[3] = {
            {.width = W, .height = H, .rgb = rgb[0], .rgb_stride_bytes = W * 3 + pad},
            {.width = W, .height = H, .depth_q20 = depth[0], .depth_stride_bytes = (W + pad) * 4},
            {.width = W, .height = H, .alpha_q15 = alpha[0], .alpha_stride_bytes = (W + pad) * 2},
        };
        for (int plane = 0; plane < 3; plane++) {
            assert_int_equal(t3r_render(rt, &camera, &targets[plane]), T3R_OK);
            assert_true(pad == 0 || hash == seen[plane]);
            seen[plane] = hash;
        }
        assert_true(seen[0] != seen[1] && seen[1] != seen[2] && seen[0] != seen[2]);
    }
    arena_free(&a);
    free(gaussians);
}
