/* SPDX-License-Identifier: Apache-2.0 */
#include "study/rivals/finetune.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "study/rivals/photometric.h"

/* values from 3D Gaussian Splatting */
#define MOMENTUM 0.9
#define MEMORY 0.999
#define LEAST 1e-15

const finetune_rates finetune_rates_default = {
    .position = 0.002, .log_scale = 0.1, .rotation = 0.06, .logit = 0.05, .colour = 0.01};

typedef struct tuner {
    splat_model *model;
    splat_view *views;
    photometric *losses;
    uint32_t view_count;  /* number of opened entries in both */
    splat_gradient *flat; /* derivatives of one view's splats */
    double *gradient;     /* of all parameters, like the next two */
    double *mean, *square;
    float *rgb, *rgb_gradient; /* for one view */
} tuner;

static void tuner_close(tuner *t)
{
    for (uint32_t v = 0; v < t->view_count; v++) {
        splat_view_close(&t->views[v]);
        photometric_close(&t->losses[v]);
    }
    free(t->views);
    free(t->losses);
    free(t->flat);
    free(t->gradient);
    free(t->mean);
    free(t->square);
    free(t->rgb);
    free(t->rgb_gradient);
}

static bool tuner_open(tuner *t, splat_model *model, const finetune_target *targets, uint32_t count)
{
    size_t parameters = ((size_t)model->count + 1) * SPLAT_PARAMETERS, values = 1;
    *t = (tuner){.model = model};
    t->views = calloc(count, sizeof *t->views);
    t->losses = calloc(count, sizeof *t->losses);
    bool opened = t->views != NULL && t->losses != NULL;
    for (; opened && t->view_count < count; t->view_count++) {
        const splat_camera *camera = &targets[t->view_count].camera;
        size_t own = (size_t)camera->width * camera->height * 3;
        values = own > values ? own : values;
        opened = splat_view_open(&t->views[t->view_count], camera, model->count);
        opened &=
            photometric_open(&t->losses[t->view_count], targets[t->view_count].rgb, camera->width, camera->height);
    }
    t->flat = malloc(((size_t)model->count + 1) * sizeof *t->flat);
    t->gradient = malloc(parameters * sizeof *t->gradient);
    t->mean = calloc(parameters, sizeof *t->mean);
    t->square = calloc(parameters, sizeof *t->square);
    t->rgb = malloc(values * sizeof *t->rgb);
    t->rgb_gradient = malloc(values * sizeof *t->rgb_gradient);
    return opened && t->flat != NULL && t->gradient != NULL && t->mean != NULL && t->square != NULL && t->rgb != NULL &&
           t->rgb_gradient != NULL;
}

static bool add_view(tuner *t, uint32_t v)
{
    splat_view *view = &t->views[v];
    if (!splat_view_project(view, t->model)) {
        return false;
    }
    memset(t->flat, 0, t->model->count * sizeof *t->flat);
    splat_view_draw(view, t->rgb, NULL);
    (void)photometric_loss(&t->losses[v], PHOTOMETRIC_SIMILARITY, t->rgb, t->rgb_gradient);
    splat_view_differentiate(view, t->rgb, t->rgb_gradient, t->flat);
    for (uint32_t i = 0; i < t->model->count; i++) {
        if (view->splats[i].left <= view->splats[i].right) {
            size_t at = (size_t)i * SPLAT_PARAMETERS;
            splat_chain(&view->camera, &t->model->parameters[at], &t->flat[i], &t->gradient[at]);
        }
    }
    return true;
}

/* Kingma and Ba 2015, algorithm 1. */
static void step(tuner *t, uint32_t iteration, const double rate[SPLAT_PARAMETERS])
{
    double mean_bias = 1 - pow(MOMENTUM, iteration + 1), square_bias = 1 - pow(MEMORY, iteration + 1);
    for (uint32_t i = 0; i < t->model->count; i++) {
        for (size_t k = 0, at = (size_t)i * SPLAT_PARAMETERS; k < SPLAT_PARAMETERS; k++, at++) {
            double g = t->gradient[at];
            t->mean[at] = MOMENTUM * t->mean[at] + (1 - MOMENTUM) * g;
            t->square[at] = MEMORY * t->square[at] + (1 - MEMORY) * g * g;
            double change = t->mean[at] / mean_bias / (sqrt(t->square[at] / square_bias) + LEAST);
            t->model->parameters[at] -= rate[k] * change;
        }
        for (int k = SPLAT_COLOUR; k < SPLAT_PARAMETERS; k++) {
            double *colour = &t->model->parameters[(size_t)i * SPLAT_PARAMETERS + (size_t)k];
            *colour = *colour < 0 ? 0 : *colour > 1 ? 1 : *colour;
        }
    }
}

static double rate_of(const finetune_rates *rates, int parameter)
{
    return parameter < SPLAT_LOG_SCALE  ? rates->position
           : parameter < SPLAT_ROTATION ? rates->log_scale
           : parameter < SPLAT_LOGIT    ? rates->rotation
           : parameter < SPLAT_COLOUR   ? rates->logit
                                        : rates->colour;
}

bool finetune(splat_model *model, const finetune_target *targets, uint32_t target_count, uint32_t iterations,
              const finetune_rates *rates)
{
    tuner t;
    double rate[SPLAT_PARAMETERS];
    for (int k = 0; k < SPLAT_PARAMETERS; k++) {
        rate[k] = rate_of(rates, k);
    }
    bool done = tuner_open(&t, model, targets, target_count);
    for (uint32_t i = 0; i < iterations && done; i++) {
        memset(t.gradient, 0, (size_t)model->count * SPLAT_PARAMETERS * sizeof *t.gradient);
        for (uint32_t v = 0; v < target_count && done; v++) {
            done = add_view(&t, v);
        }
        if (done) {
            step(&t, i, rate);
        }
        cli_progress("fine-tuning", i + 1, iterations);
    }
    tuner_close(&t);
    return done;
}
