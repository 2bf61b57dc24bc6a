/* SPDX-License-Identifier: Apache-2.0 */
/* The rivals' rasterizer agrees with the runtime's integer raster: at least 50 dB, both rounded to 8 bits. */
#include <stdio.h>

#include "splat_scenes.h"
#include "test.h"

#define LEAST_DB 50.0

typedef struct recipe {
    const char *name;
    uint32_t count, width, height;
    double focal, least_z, most_z, least_sigma, most_sigma, anisotropy, least_opacity;
} recipe;

static t3r_gaussian *cook(const recipe *r, uint64_t seed)
{
    t3r_gaussian *gaussians = calloc(r->count, sizeof *gaussians);
    dice d = {seed};
    assert_non_null(gaussians);
    for (uint32_t i = 0; i < r->count; i++) {
        double z = dice_between(&d, r->least_z, r->most_z), beam = 1.1 * z / r->focal;
        double sigma = r->least_sigma * pow(r->most_sigma / r->least_sigma, dice_between(&d, 0, 1));
        double axes[3] = {sigma, sigma * pow(r->anisotropy, -dice_between(&d, 0, 1)), sigma / r->anisotropy}, f[9];
        gaussians[i] = round_gaussian(dice_between(&d, -0.5, 0.5) * r->width * beam,
                                      dice_between(&d, -0.5, 0.5) * r->height * beam, z, sigma,
                                      dice_between(&d, r->least_opacity, 1), dice_between(&d, 0, 1),
                                      dice_between(&d, 0, 1), dice_between(&d, 0, 1));
        random_factor(&d, axes, f);
        set_factor(&gaussians[i], f);
    }
    return gaussians;
}

static void compare(const char *name, const t3r_scene_frame *frame, const t3r_gaussian *gaussians, uint32_t count,
                    const t3r_camera *camera, uint32_t width, uint32_t height)
{
    drawing want = draw_scene(frame, gaussians, count, camera, width, height, ARENA_AT_FULL);
    splat_model model;
    assert_true(splat_model_of(&model, gaussians, count));
    splat_camera own = splat_camera_of(camera, frame, width, height);
    splat_view view = view_of(&model, &own, SPLAT_ALPHA_LEAST);
    size_t pixels = (size_t)width * height;
    float *rgb = malloc(pixels * 3 * sizeof *rgb), *transmittance = malloc(pixels * sizeof *transmittance);
    assert_true(rgb != NULL && transmittance != NULL);
    splat_view_draw(&view, rgb, transmittance);
    double squares = 0, lit = 0;
    for (size_t i = 0; i < pixels * 3; i++) {
        double error = floor((double)rgb[i] * 255 + 0.5) - want.rgb[i];
        squares += error * error;
        lit += want.rgb[i] > 0;
    }
    for (size_t i = 0; i < pixels; i++) {
        assert_true(fabs(1 - (double)transmittance[i] - want.alpha_q15[i] / 32767.0) < 0.02);
    }
    double db = squares == 0 ? 99 : 10 * log10(255 * 255 * 3 * (double)pixels / squares);
    print_message("%-24s %6u Gaussians: %5.1f dB\n", name, count, db);
    assert_true(lit > 0.1 * (double)pixels);
    assert_true(db >= LEAST_DB);
    free(rgb);
    free(transmittance);
    splat_view_close(&view);
    splat_model_free(&model);
    drawing_free(&want);
}

TEST(random_scenes)
{
    static const recipe recipes[] = {
        {"small round", 20000, 256, 256, 250, 0.5, 4, 0.001, 0.02, 1, 0.05},
        {"discs", 20000, 256, 256, 250, 0.5, 4, 0.002, 0.04, 30, 0.1},
        {"large and few", 300, 256, 256, 250, 0.5, 4, 0.05, 1, 5, 0.1},
        {"needles 1000:1", 3000, 256, 256, 250, 0.5, 4, 0.05, 0.5, 1000, 0.2},
        {"as dense as two views", 131072, 256, 256, 250, 1, 2, 0.003, 0.006, 8, 0.6},
        {"odd sides", 1000, 17, 33, 30, 0.5, 4, 0.01, 0.1, 5, 0.1},
        {"wide angle", 10000, 320, 200, 60, 0.2, 4, 0.005, 0.1, 5, 0.1},
        {"telescope", 5000, 256, 256, 8000, 2, 8, 0.0002, 0.005, 5, 0.1},
    };
    for (size_t i = 0; i < sizeof recipes / sizeof recipes[0]; i++) {
        const recipe *r = &recipes[i];
        t3r_gaussian *gaussians = cook(r, 0x9e3779b97f4a7c15u + i);
        t3r_camera camera = plain_camera(r->focal, r->width, r->height);
        compare(r->name, &scene_frame, gaussians, r->count, &camera, r->width, r->height);
        free(gaussians);
    }
}

/* Turned cameras with unequal focal lengths, in map coordinates in units 1/64 as large. */
TEST(moved_cameras)
{
    static const recipe r = {"ball", 8000, 200, 160, 200, 0.5, 1, 0.005, 0.05, 20, 0.1};
    t3r_gaussian *gaussians = cook(&r, 77);
    dice d = {78};
    for (uint32_t i = 0; i < r.count; i++) {
        for (int k = 0; k < 3; k++) {
            gaussians[i].position_q20[k] = (int32_t)dice_below(&d, 1 << 21) - (1 << 20);
        }
    }
    for (int i = 0; i < 4; i++) {
        const double turn = i * 1.7, at[3] = {0.1, -0.1, 0}, position[3] = {3 * sin(turn), i - 1.5, 3 * cos(turn)};
        t3r_camera camera = camera_towards(200, r.width, r.height, position, at);
        camera.fy_q16 += 9 << 16;
        camera.cx_q16 += 123457;
        compare("moved camera", &scene_frame, gaussians, r.count, &camera, r.width, r.height);
        t3r_scene_frame frame = {{(int64_t)4123456 << 32, -((int64_t)512345 << 32), 99}, -6};
        for (int k = 0; k < 3; k++) {
            camera.position_q32[k] = camera.position_q32[k] / 64 + frame.origin_q32[k];
        }
        compare("moved frame", &frame, gaussians, r.count, &camera, r.width, r.height);
    }
    free(gaussians);
}

/* The lower right corner of a picture; the optical axis is outside the corner. */
TEST(corner)
{
    enum { WHOLE = 256, SIDE = 64 };
    static const recipe r = {"corner", 300, WHOLE, WHOLE, 250, 0.5, 4, 0.05, 1, 5, 0.1};
    t3r_gaussian *gaussians = cook(&r, 79);
    t3r_camera camera = plain_camera(r.focal, WHOLE, WHOLE);
    camera.cx_q16 -= (WHOLE - SIDE) << 16;
    camera.cy_q16 -= (WHOLE - SIDE) << 16;
    compare(r.name, &scene_frame, gaussians, r.count, &camera, SIDE, SIDE);
    free(gaussians);
}

typedef struct gathered {
    const splat_view *view;
    float *rgb;
} gathered;

static void gather(void *user, const splat_row *row)
{
    const gathered *g = user;
    assert_true(row->columns >= 1 && row->columns <= SPLAT_TILE);
    for (uint32_t i = 0; i < row->columns; i++) {
        size_t pixel = (size_t)row->y * g->view->camera.width + row->x + i;
        for (size_t c = 0; c < 3; c++) {
            g->rgb[pixel * 3 + c] += row->alpha[i] * row->before[i] * g->view->splats[row->gaussian].colour[c];
        }
    }
}

/* The contributions that a walk reports add up to the picture. */
TEST(walk_is_the_picture)
{
    enum { WIDTH = 45, HEIGHT = 29 };
    static float drawn[WIDTH * HEIGHT * 3], walked[WIDTH * HEIGHT * 3];
    dice d = {4};
    splat_model model = random_model(&d, 400, 40, WIDTH, HEIGHT);
    splat_camera camera = middle_camera(40, WIDTH, HEIGHT);
    splat_view view = view_of(&model, &camera, SPLAT_ALPHA_LEAST);
    gathered g = {&view, walked};
    splat_view_draw(&view, drawn, NULL);
    splat_view_walk(&view, gather, &g);
    for (size_t i = 0; i < WIDTH * HEIGHT * 3; i++) {
        assert_true(fabsf(drawn[i] - walked[i]) < 1e-5f);
    }
    splat_view_close(&view);
    splat_model_free(&model);
}

/* A scene converted to parameters and back differs only by the record's rounding. */
TEST(model_round_trip)
{
    static const recipe r = {"round trip", 2000, 64, 64, 60, 0.5, 4, 0.001, 0.2, 100, 0.001};
    t3r_gaussian *gaussians = cook(&r, 5);
    splat_model model;
    assert_true(splat_model_of(&model, gaussians, r.count));
    for (uint32_t i = 0; i < r.count; i++) {
        const t3r_gaussian *g = &gaussians[i];
        t3r_gaussian back = *g;
        memset(back.factor, 0, sizeof back.factor);
        splat_model_store(parameters_of(&model, i), &back);
        assert_memory_equal(back.position_q20, g->position_q20, sizeof g->position_q20);
        assert_memory_equal(back.colour_q7, g->colour_q7, sizeof g->colour_q7);
        assert_int_equal(back.opacity_q15, g->opacity_q15);
        for (int a = 0; a < 3; a++) {
            for (int b = 0; b < 3; b++) {
                double was = 0, is = 0;
                for (int k = 0; k < 3; k++) {
                    was += ldexp((double)g->factor[a * 3 + k] * g->factor[b * 3 + k], 2 * g->factor_exponent);
                    is += ldexp((double)back.factor[a * 3 + k] * back.factor[b * 3 + k], 2 * back.factor_exponent);
                }
                assert_true(fabs(was - is) < 2e-4 * exp(2 * parameters_of(&model, i)[SPLAT_LOG_SCALE]) + 1e-12 ||
                            fabs(was - is) < 2e-4 * fabs(was) + ldexp(1, 2 * g->factor_exponent + 18));
            }
        }
    }
    splat_model_free(&model);
    free(gaussians);
}

/* No parameters that an optimiser may reach cause accesses out of bounds or traps. */
TEST(wild_parameters)
{
    static const double wild[] = {0, -0.0, 1e-300, 1e300, -1e300, 700, -700, INFINITY, -INFINITY, NAN};
    enum { SIDE = 20, KINDS = sizeof wild / sizeof wild[0] };
    static float rgb[SIDE * SIDE * 3];
    splat_camera camera = middle_camera(20, SIDE, SIDE);
    splat_model model = plain_model(1);
    for (int k = 0; k < SPLAT_PARAMETERS; k++) {
        for (size_t i = 0; i < KINDS; i++) {
            set_ball(&model, 0, 0, 0, 1, 0.1, 0.9);
            parameters_of(&model, 0)[k] = wild[i];
            splat_view view = view_of(&model, &camera, SPLAT_ALPHA_LEAST);
            splat_view_draw(&view, rgb, NULL);
            t3r_gaussian g = round_gaussian(0, 0, 1, 0.1, 0.5, 1, 1, 1);
            splat_model_store(parameters_of(&model, 0), &g);
            splat_view_close(&view);
        }
    }
    splat_model_free(&model);
}
