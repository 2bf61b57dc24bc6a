/* SPDX-License-Identifier: Apache-2.0 */
#include "study/rivals/tuning/finetune.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "core/fixed.h"
#include "study/rivals/tuning/photometric.h"

/* values from 3D Gaussian Splatting */
#define MOMENTUM 0.9
#define MEMORY 0.999
#define LEAST 1e-15

const finetune_rates finetune_rates_default = {
    .position = 0.002, .log_scale = 0.2, .rotation = 0.01, .logit = 0.05, .colour = 0.01};
/* The position's rate is 3DGS's last one, 1.6e-6 of the cameras' extent, with which PUP and LightGaussian fine-tune;
 * the extent is taken for a scene unit. The colour's is that of its harmonic, 0.0025, times 0.2821. */
const finetune_rates finetune_rates_published = {
    .position = 1.6e-6, .log_scale = 0.005, .rotation = 0.001, .logit = 0.05, .colour = 0.0007};

/* Number of Gaussians that a thread takes at a time. */
#define CHUNK 256u

/* A context view, with what its thread needs. */
typedef struct tuned_view {
    splat_view view;
    photometric loss;
    splat_gradient *flat;      /* derivatives of the view's splats */
    float *rgb, *rgb_gradient; /* width x height x 3 */
    bool failed;               /* out of memory */
} tuned_view;

typedef struct tuner {
    splat_model *model;
    tuned_view *views;
    uint32_t view_count;   /* number of opened views */
    double *mean, *square; /* of the derivatives, for every parameter */
    double rate[SPLAT_PARAMETERS];
    double mean_bias, square_bias; /* of this iteration */
    t3r_threads *threads;
} tuner;

static void tuner_close(tuner *t)
{
    for (uint32_t v = 0; v < t->view_count; v++) {
        splat_view_close(&t->views[v].view);
        photometric_close(&t->views[v].loss);
        free(t->views[v].flat);
        free(t->views[v].rgb);
        free(t->views[v].rgb_gradient);
    }
    free(t->views);
    free(t->mean);
    free(t->square);
}

static bool view_open(tuned_view *v, const finetune_target *target, uint32_t count)
{
    const splat_camera *camera = &target->camera;
    const size_t values = (size_t)camera->width * camera->height * 3;
    bool opened = splat_view_open(&v->view, camera, count);
    opened &= photometric_open(&v->loss, target->rgb, camera->width, camera->height);
    v->flat = malloc(((size_t)count + 1) * sizeof *v->flat);
    v->rgb = malloc(values * sizeof *v->rgb);
    v->rgb_gradient = malloc(values * sizeof *v->rgb_gradient);
    return opened && v->flat != NULL && v->rgb != NULL && v->rgb_gradient != NULL;
}

static bool tuner_open(tuner *t, splat_model *model, const finetune_target *targets, uint32_t count,
                       t3r_threads *threads)
{
    const size_t parameters = ((size_t)model->count + 1) * SPLAT_PARAMETERS;
    *t = (tuner){.model = model, .threads = threads};
    t->views = calloc(count, sizeof *t->views);
    t->mean = calloc(parameters, sizeof *t->mean);
    t->square = calloc(parameters, sizeof *t->square);
    bool opened = t->views != NULL && t->mean != NULL && t->square != NULL;
    while (opened && t->view_count < count) {
        const uint32_t v = t->view_count++;
        opened = view_open(&t->views[v], &targets[v], model->count);
    }
    return opened;
}

static void run(const tuner *t, uint32_t count, t3r_thread_task *task, void *context)
{
    if (t->threads != NULL) {
        t3r_threads_run(t->threads, count, task, context);
        return;
    }
    for (uint32_t i = 0; i < count; i++) {
        task(context, i, 0);
    }
}

/* Draws a view and computes the derivatives of its loss with respect to its splats. */
static void differentiate_view(void *context, uint32_t index, uint32_t worker)
{
    (void)worker;
    const tuner *t = context;
    tuned_view *v = &t->views[index];
    v->failed = !splat_view_project(&v->view, t->model);
    if (v->failed) {
        return;
    }
    memset(v->flat, 0, t->model->count * sizeof *v->flat);
    splat_view_draw(&v->view, v->rgb, NULL);
    (void)photometric_loss(&v->loss, PHOTOMETRIC_SIMILARITY, v->rgb, v->rgb_gradient);
    splat_view_differentiate(&v->view, v->rgb, v->rgb_gradient, v->flat);
}

/* Moves the parameters of a Gaussian against their derivatives: Kingma and Ba 2015, algorithm 1. */
static void step(const tuner *t, uint32_t index, const double gradient[SPLAT_PARAMETERS])
{
    const size_t first = (size_t)index * SPLAT_PARAMETERS;
    double *parameters = &t->model->parameters[first], *mean = &t->mean[first], *square = &t->square[first];
    for (int k = 0; k < SPLAT_PARAMETERS; k++) {
        const double g = gradient[k];
        mean[k] = MOMENTUM * mean[k] + (1 - MOMENTUM) * g;
        square[k] = MEMORY * square[k] + (1 - MEMORY) * g * g;
        parameters[k] -= t->rate[k] * (mean[k] / t->mean_bias) / (sqrt(square[k] / t->square_bias) + LEAST);
    }
    for (int k = SPLAT_COLOUR; k < SPLAT_PARAMETERS; k++) {
        parameters[k] = fmin(fmax(parameters[k], 0), 1);
    }
}

static void step_chunk(void *context, uint32_t chunk, uint32_t worker)
{
    (void)worker;
    const tuner *t = context;
    const uint32_t first = chunk * CHUNK, end = T3R_MIN(first + CHUNK, t->model->count);
    for (uint32_t i = first; i < end; i++) {
        const double *parameters = &t->model->parameters[(size_t)i * SPLAT_PARAMETERS];
        double gradient[SPLAT_PARAMETERS] = {0};
        for (uint32_t v = 0; v < t->view_count; v++) {
            const splat *s = &t->views[v].view.splats[i];
            if (s->left <= s->right) {
                splat_chain(&t->views[v].view.camera, parameters, &t->views[v].flat[i], gradient);
            }
        }
        step(t, i, gradient);
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

/* Sets what Adam needs in iteration `i`. */
static void set_iteration(tuner *t, uint32_t i)
{
    t->mean_bias = 1 - pow(MOMENTUM, i + 1);
    t->square_bias = 1 - pow(MEMORY, i + 1);
}

/* Returns whether the iteration was complete. */
static bool iterate(tuner *t)
{
    run(t, t->view_count, differentiate_view, t);
    for (uint32_t v = 0; v < t->view_count; v++) {
        if (t->views[v].failed) {
            return false;
        }
    }
    run(t, (t->model->count + CHUNK - 1) / CHUNK, step_chunk, t);
    return true;
}

bool finetune(splat_model *model, const finetune_target *targets, uint32_t target_count, uint32_t iterations,
              const finetune_rates *rates, t3r_threads *threads)
{
    tuner t;
    bool done = tuner_open(&t, model, targets, target_count, threads);
    for (int k = 0; k < SPLAT_PARAMETERS; k++) {
        t.rate[k] = rate_of(rates, k);
    }
    for (uint32_t i = 0; i < iterations && done; i++) {
        set_iteration(&t, i);
        done = iterate(&t);
        cli_progress("fine-tuning", i + 1, iterations);
    }
    tuner_close(&t);
    return done;
}
