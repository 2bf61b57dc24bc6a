/* SPDX-License-Identifier: Apache-2.0 */
/* Fine-tuning recovers a known model from its pictures, with the same result every time. */
#include <stdio.h>

#include "splat_scenes.h"
#include "study/rivals/tuning/finetune.h"
#include "test.h"

enum { SIDE = 32, VALUES = SIDE * SIDE * 3, VIEWS = 2, COUNT = 60 };

typedef struct scene {
    splat_model model;
    finetune_target targets[VIEWS];
    uint8_t pictures[VIEWS][VALUES];
} scene;

static void draw_bytes(const splat_model *model, const splat_camera *camera, uint8_t *rgb)
{
    float drawn[VALUES];
    splat_view view = view_of(model, camera, SPLAT_ALPHA_LEAST);
    splat_view_draw(&view, drawn, NULL);
    for (int i = 0; i < VALUES; i++) {
        rgb[i] = (uint8_t)floorf(fminf(drawn[i], 1) * 255 + 0.5f);
    }
    splat_view_close(&view);
}

/* Draws pictures of a random model, and disturbs the model. */
static void make_scene(scene *s)
{
    dice d = {11};
    s->model = random_model(&d, COUNT, SIDE, SIDE, SIDE);
    for (int v = 0; v < VIEWS; v++) {
        const double position[3] = {0.5 * v, 0.1 * v, 0}, at[3] = {0, 0, 1.5};
        t3r_camera camera = camera_towards(SIDE, SIDE, SIDE, position, at);
        s->targets[v] = (finetune_target){splat_camera_of(&camera, &scene_frame, SIDE, SIDE), s->pictures[v]};
        draw_bytes(&s->model, &s->targets[v].camera, s->pictures[v]);
    }
    for (uint32_t i = 0; i < COUNT; i++) {
        double *p = parameters_of(&s->model, i);
        for (int k = 0; k < 3; k++) {
            p[SPLAT_POSITION + k] += dice_between(&d, -0.01, 0.01);
            p[SPLAT_LOG_SCALE + k] += dice_between(&d, -0.5, 0.2);
            p[SPLAT_COLOUR + k] = fmin(fmax(p[SPLAT_COLOUR + k] + dice_between(&d, -0.2, 0.2), 0), 1);
        }
        p[SPLAT_LOGIT] += dice_between(&d, -0.5, 0.5);
    }
}

static double psnr(const scene *s)
{
    double squares = 0;
    for (int v = 0; v < VIEWS; v++) {
        uint8_t rgb[VALUES];
        draw_bytes(&s->model, &s->targets[v].camera, rgb);
        for (int i = 0; i < VALUES; i++) {
            squares += pow(rgb[i] - s->pictures[v][i], 2);
        }
    }
    return 10 * log10(255.0 * 255 * VIEWS * VALUES / squares);
}

TEST(finds_back)
{
    scene *s = calloc(1, sizeof *s);
    assert_non_null(s);
    make_scene(s);
    double before = psnr(s);
    assert_true(finetune(&s->model, s->targets, VIEWS, 200, &finetune_rates_default, NULL));
    double after = psnr(s);
    print_message("%.1f dB disturbed, %.1f dB fine-tuned\n", before, after);
    assert_true(s->model.count == COUNT);
    assert_true(after > before + 12 && after > 32);
    for (uint32_t i = 0; i < COUNT; i++) {
        for (int k = 0; k < SPLAT_PARAMETERS; k++) {
            double p = parameters_of(&s->model, i)[k];
            assert_true(isfinite(p) && (k < SPLAT_COLOUR || (p >= 0 && p <= 1)));
        }
    }
    splat_model_free(&s->model);
    free(s);
}

TEST(same_every_time)
{
    scene *s = calloc(2, sizeof *s);
    t3r_threads *threads = t3r_threads_start(3);
    assert_non_null(s);
    assert_non_null(threads);
    for (int i = 0; i < 2; i++) {
        make_scene(&s[i]);
        assert_true(finetune(&s[i].model, s[i].targets, VIEWS, 10, &finetune_rates_default, i == 0 ? NULL : threads));
    }
    t3r_threads_stop(threads);
    assert_memory_equal(s[0].model.parameters, s[1].model.parameters, COUNT * SPLAT_PARAMETERS * sizeof(double));
    splat_model_free(&s[0].model);
    splat_model_free(&s[1].model);
    free(s);
}

/* In the first step of Adam every parameter moves by its own rate, unless the loss does not depend on it. */
TEST(first_step)
{
    static uint8_t black[VALUES];
    splat_camera camera = middle_camera(SIDE, SIDE, SIDE);
    finetune_target target = {camera, black};
    splat_model model = plain_model(2);
    set_ball(&model, 0, 0.02, 0.03, 1, 0.1, 0.5);
    set_ball(&model, 1, 0, 0, -1, 0.1, 0.5); /* behind the camera */
    double before[2 * SPLAT_PARAMETERS];
    memcpy(before, model.parameters, sizeof before);
    const finetune_rates rates = {.position = 1e-3, .log_scale = 2e-3, .rotation = 3e-3, .logit = 4e-3, .colour = 5e-3};
    assert_true(finetune(&model, &target, 1, 1, &rates, NULL));
    const double *after = parameters_of(&model, 0);
    for (int k = 0; k < 3; k++) {
        /* towards black: smaller, fainter, darker */
        assert_true(fabs(after[SPLAT_LOG_SCALE + k] - before[SPLAT_LOG_SCALE + k] + 2e-3) < 1e-8 || k == 2);
        assert_true(fabs(after[SPLAT_COLOUR + k] - before[SPLAT_COLOUR + k] + 5e-3) < 1e-8);
        assert_true(fabs(fabs(after[k] - before[k]) - 1e-3) < 1e-8);
    }
    assert_true(fabs(after[SPLAT_LOGIT] - before[SPLAT_LOGIT] + 4e-3) < 1e-8);
    assert_memory_equal(parameters_of(&model, 1), &before[SPLAT_PARAMETERS], SPLAT_PARAMETERS * sizeof(double));
    splat_model_free(&model);
}
