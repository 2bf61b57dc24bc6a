/* SPDX-License-Identifier: Apache-2.0 */
/* The derivatives of a drawn view against central differences, in every parameter of every Gaussian. */
#include <stdio.h>

#include "splat_scenes.h"
#include "test.h"

/* The cut at 1/255 has no derivative: here it is too low to be seen. */
#define UNSEEN 1e-6
/* Pictures are floats and steps are small against a pixel: tolerance of a few thousandths of the parameter's largest
 * derivative. */
#define STEP 2e-3
#define TOLERANCE 4e-3

enum { WIDTH = 21, HEIGHT = 18, VALUES = WIDTH * HEIGHT * 3, COUNT = 24 };

/* Returns a linear measure of the picture, whose derivative with respect to the picture is `weights`. */
static double measure(const splat_model *model, const splat_camera *camera, const float *weights)
{
    static float rgb[VALUES];
    splat_view view = view_of(model, camera, UNSEEN);
    double sum = 0;
    splat_view_draw(&view, rgb, NULL);
    for (int i = 0; i < VALUES; i++) {
        sum += (double)(weights[i] * rgb[i]);
    }
    splat_view_close(&view);
    return sum;
}

static void differentiate(const splat_model *model, const splat_camera *camera, const float *weights, double *gradient)
{
    static float rgb[VALUES];
    splat_gradient flat[COUNT] = {{0}};
    splat_view view = view_of(model, camera, UNSEEN);
    splat_view_draw(&view, rgb, NULL);
    splat_view_differentiate(&view, rgb, weights, flat);
    memset(gradient, 0, COUNT * SPLAT_PARAMETERS * sizeof *gradient);
    for (uint32_t i = 0; i < COUNT; i++) {
        splat_chain(camera, parameters_of(model, i), &flat[i], &gradient[(size_t)i * SPLAT_PARAMETERS]);
    }
    splat_view_close(&view);
}

static void compare(splat_model *model, const splat_camera *camera, uint64_t seed)
{
    float weights[VALUES];
    double gradient[COUNT * SPLAT_PARAMETERS], difference[COUNT * SPLAT_PARAMETERS];
    dice d = {seed};
    for (int i = 0; i < VALUES; i++) {
        weights[i] = (float)dice_between(&d, -1, 1);
    }
    differentiate(model, camera, weights, gradient);
    for (size_t k = 0; k < SPLAT_PARAMETERS; k++) {
        double largest = 0;
        for (size_t i = 0; i < COUNT; i++) {
            double *p = &model->parameters[i * SPLAT_PARAMETERS + k], was = *p;
            double step = STEP * (k < SPLAT_LOG_SCALE ? 1.0 / 20 : 1); /* places: a 500th of a pixel */
            *p = was + step;
            double above = measure(model, camera, weights);
            *p = was - step;
            difference[i * SPLAT_PARAMETERS + k] = (above - measure(model, camera, weights)) / (2 * step);
            *p = was;
            largest = fmax(largest, fabs(difference[i * SPLAT_PARAMETERS + k]));
        }
        assert_true(largest > 1e-2);
        for (size_t i = k; i < COUNT * SPLAT_PARAMETERS; i += SPLAT_PARAMETERS) {
            if (!(fabs(gradient[i] - difference[i]) <= TOLERANCE * largest)) {
                fail_msg("Gaussian %u, parameter %u: %g, by differences %g (largest %g)",
                         (unsigned)(i / SPLAT_PARAMETERS), (unsigned)k, gradient[i], difference[i], largest);
            }
        }
    }
}

TEST(plain_view)
{
    splat_camera camera = middle_camera(20, WIDTH, HEIGHT);
    for (uint64_t seed = 1; seed <= 5; seed++) {
        dice d = {seed};
        splat_model model = random_model(&d, COUNT, 20, WIDTH, HEIGHT);
        compare(&model, &camera, seed);
        splat_model_free(&model);
    }
}

TEST(turned_view)
{
    const double position[3] = {0.7, -0.4, -0.3}, at[3] = {0, 0, 1.5};
    t3r_camera from = camera_towards(22, WIDTH, HEIGHT, position, at);
    from.fy_q16 += 3 << 16;
    splat_camera camera = splat_camera_of(&from, &scene_frame, WIDTH, HEIGHT);
    dice d = {9};
    splat_model model = random_model(&d, COUNT, 20, WIDTH, HEIGHT);
    compare(&model, &camera, 9);
    splat_model_free(&model);
}

/* At the cap of alpha the derivatives by place, shape and opacity are 0. */
TEST(capped)
{
    static float rgb[9 * 9 * 3], weights[9 * 9 * 3];
    splat_camera camera = middle_camera(10, 9, 9);
    splat_model model = plain_model(1);
    set_ball(&model, 0, 0, 0, 1, 50, 0.9999);
    splat_view view = view_of(&model, &camera, SPLAT_ALPHA_LEAST);
    splat_gradient g = {0};
    splat_view_draw(&view, rgb, NULL);
    for (size_t i = 0; i < 9 * 9 * 3; i++) {
        weights[i] = 1;
    }
    splat_view_differentiate(&view, rgb, weights, &g);
    assert_true(fabs(g.x) + fabs(g.y) + fabs(g.a) + fabs(g.b) + fabs(g.c) + fabs(g.opacity) == 0);
    assert_true(fabs(g.colour[0] - 81 * 0.99) < 1e-3);
    splat_view_close(&view);
    splat_model_free(&model);
}
