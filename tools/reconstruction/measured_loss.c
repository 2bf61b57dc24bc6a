/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/measured_loss.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/fixed.h"
#include "geometry/quaternion.h"
#include "loss/budget_choice.h"
#include "state/state.h"

#define TRIALS 6        /* scenes that are built between the least number and the budget */
#define LEAST_PART 400u /* at least 1 / LEAST_PART of the points is kept */
#define STEP_PART 16u   /* the search ends at steps of 1 / STEP_PART */

/* The error of a new view of all points, as a share of the views' disagreement. A view halfway between two others is
 * half as far from them as they are from each other: shifts of the surface, by wrong depth or poses, are half as long,
 * and their squared error is a quarter. Stereo takes the depth at which its views disagree least. */
#define SHARE_BY_SENSOR 0.25
#define SHARE_BY_STEREO 1.0
#define LEAST_ERROR 1.0 /* levels^2, 48 dB: no new view is expected to be better */

#define COVERED_Q15 22937u /* alpha 0.7: pixels of a view that the scene of all points covers, as `eval` has them */
#define COVERED_LEAST 256u /* with fewer such pixels there is nothing to compare */

/* The loss is this many times the measured difference, less an allowance: a part of a small difference is noise that
 * fewer Gaussians average, and a large one is known to a factor only. Chosen on the training scenes. */
#define LOSS_FACTOR 2.0
#define LOSS_ALLOWANCE 0.5 /* dB */

/* Percentages of new views of the training scenes that stayed within a bound (docs/study/tuning.md). */
#define HELD_MEASURED 97
#define HELD_MEASURED_BELOW 90 /* bounds below HELD_FROM */
#define HELD_FROM 0.5          /* dB */
#define HELD_PREDICTED 84

typedef struct search {
    t3r_runtime *runtime;
    t3r_request request;
    t3r_scene *scene;
    char *reason;
    uint32_t width, height, views;
    t3r_camera camera[T3R_MAX_VIEWS]; /* halfway between neighbours */
    uint8_t *reference;               /* the scene of all points from there, a picture after the other */
    uint16_t *alpha;                  /* likewise */
    uint8_t *drawn;                   /* one picture of the scene that is tried */
    double error;                     /* expected of a new view of the reference, levels^2 */
    double max_loss;
    measured_loss *found;
} search;

int measured_loss_held(const measured_loss *loss, double max_loss)
{
    return loss->builds == 0 ? HELD_PREDICTED : max_loss < HELD_FROM ? HELD_MEASURED_BELOW : HELD_MEASURED;
}

static t3r_camera halfway(const t3r_camera *a, const t3r_camera *b)
{
    t3r_camera camera = *a;
    double product = 0, q[4];
    for (int i = 0; i < 4; i++) {
        product += (double)a->rotation_q30[i] * b->rotation_q30[i];
    }
    for (int i = 0; i < 4; i++) { /* the shorter way */
        q[i] = (double)a->rotation_q30[i] + (product < 0 ? -1 : 1) * (double)b->rotation_q30[i];
    }
    quaternion_normalise(q);
    for (int i = 0; i < 4; i++) {
        camera.rotation_q30[i] = (int32_t)rint(ldexp(q[i], 30));
    }
    for (int i = 0; i < 3; i++) {
        camera.position_q32[i] = a->position_q32[i] / 2 + b->position_q32[i] / 2;
    }
    return camera;
}

/* Places the views; neighbours are those of t3r_disagreement_q8(). */
static void place(search *s, uint32_t context_views)
{
    t3r_camera camera[T3R_MAX_VIEWS];
    for (uint32_t v = 0; v < context_views; v++) {
        (void)t3r_view_camera(s->runtime, v, &camera[v]); /* every view was added */
    }
    s->views = context_views == 2 ? 1 : context_views;
    for (uint32_t v = 0; v < s->views; v++) {
        s->camera[v] = halfway(&camera[v], &camera[(v + 1) % context_views]);
    }
}

static t3r_status build(search *s, uint32_t gaussians)
{
    s->request.gaussians = gaussians;
    const t3r_status status = t3r_rebuild(s->runtime, &s->request, s->scene);
    if (status != T3R_OK) {
        (void)t3r_rebuild_error(status, s->runtime, &s->request, s->scene, s->reason, T3R_ERROR_BYTES);
    }
    s->found->builds += status == T3R_OK;
    return status;
}

/* Draws a view; alpha may be NULL. */
static t3r_status draw(const search *s, uint32_t view, uint8_t *rgb, uint16_t *alpha)
{
    const t3r_target target = {
        .width = s->width,
        .height = s->height,
        .rgb = rgb,
        .rgb_stride_bytes = s->width * 3,
        .alpha_q15 = alpha,
        .alpha_stride_bytes = s->width * 2,
    };
    const t3r_status status = t3r_render(s->runtime, &s->camera[view], &target);
    if (status != T3R_OK) {
        (void)t3r_render_error(status, s->runtime, &s->camera[view], &target, s->reason, T3R_ERROR_BYTES);
    }
    return status;
}

/* Draws the reference and counts the pixels that it covers. */
static t3r_status draw_reference(const search *s, size_t *covered)
{
    const size_t pixels = (size_t)s->width * s->height;
    t3r_status status = T3R_OK;
    *covered = 0;
    for (uint32_t v = 0; v < s->views && status == T3R_OK; v++) {
        uint16_t *alpha = s->alpha + v * pixels;
        status = draw(s, v, s->reference + v * pixels * 3, alpha);
        for (size_t i = 0; i < pixels && status == T3R_OK; i++) {
            *covered += alpha[i] > COVERED_Q15;
        }
    }
    return status;
}

/* Builds so many Gaussians and measures what they lose: their difference from the reference, as if it added to its
 * error. */
static t3r_status try_number(search *s, uint32_t gaussians)
{
    const size_t pixels = (size_t)s->width * s->height;
    uint64_t squares = 0, values = 0;
    t3r_status status = build(s, gaussians);
    for (uint32_t v = 0; v < s->views && status == T3R_OK; v++) {
        const uint8_t *reference = s->reference + v * pixels * 3;
        const uint16_t *alpha = s->alpha + v * pixels;
        status = draw(s, v, s->drawn, NULL);
        for (size_t i = 0; i < pixels && status == T3R_OK; i++) {
            for (size_t c = 3 * i; c < 3 * i + 3 && alpha[i] > COVERED_Q15; c++) {
                const int32_t off = s->drawn[c] - reference[c];
                squares += (uint32_t)(off * off);
                values++;
            }
        }
    }
    if (status == T3R_OK) {
        const double difference = 10 * log10(1 + (double)squares / (double)values / s->error);
        s->found->loss = fmax(LOSS_FACTOR * difference - LOSS_ALLOWANCE, 0);
    }
    return status;
}

/* Halves the gap between too few and enough, in octaves. */
static t3r_status find_least(search *s, uint32_t few, uint32_t most)
{
    uint32_t enough = most, tried = 0;
    t3r_status status = T3R_OK;
    for (int i = 0; i < TRIALS && status == T3R_OK && enough - few > T3R_MAX(enough / STEP_PART, 1u); i++) {
        tried = (uint32_t)sqrt((double)few * enough);
        status = try_number(s, tried);
        *(s->found->loss <= s->max_loss ? &enough : &few) = tried;
    }
    return status == T3R_OK && tried != enough ? try_number(s, enough) : status;
}

/* Builds the number that the runtime predicts. */
static t3r_status predict(search *s, uint32_t most)
{
    s->request.max_loss_q8 = (uint32_t)(s->max_loss * 256 + 0.5);
    const t3r_status status = build(s, most);
    s->found->builds = 0;
    return status;
}

static t3r_status search_least(search *s, uint32_t points, uint32_t most)
{
    size_t covered = 0;
    t3r_status status = build(s, points);
    if (status == T3R_OK) {
        status = draw_reference(s, &covered);
    }
    if (status == T3R_OK && covered < COVERED_LEAST) {
        return predict(s, most);
    }
    return status == T3R_OK ? find_least(s, T3R_MIN(T3R_MAX(points / LEAST_PART, 1u), most), most) : status;
}

t3r_status measured_loss_build(t3r_runtime *runtime, const t3r_config *config, const t3r_request *request,
                               double max_loss, t3r_scene *scene, measured_loss *found, char *reason)
{
    const size_t pixels = (size_t)config->width * config->height;
    search s = {.runtime = runtime, .request = *request, .scene = scene, .reason = reason, .max_loss = max_loss};
    t3r_view views[T3R_MAX_VIEWS];
    *found = (measured_loss){0};
    s.found = found;
    s.width = config->width;
    s.height = config->height;
    t3r_views_of(runtime, views);
    const uint32_t disagreement_q8 = t3r_disagreement_as_given_q8(runtime, views);
    if (disagreement_q8 == 0) {
        return predict(&s, request->gaussians);
    }
    const double share = config->depth == T3R_DEPTH_STEREO ? SHARE_BY_STEREO : SHARE_BY_SENSOR;
    s.error = fmax(share * disagreement_q8 / 256, LEAST_ERROR);
    place(&s, config->views);
    s.reference = malloc(s.views * pixels * 3);
    s.alpha = malloc(s.views * pixels * sizeof *s.alpha);
    s.drawn = malloc(pixels * 3);
    t3r_status status = T3R_ERR_ARENA;
    if (s.reference != NULL && s.alpha != NULL && s.drawn != NULL) {
        status = search_least(&s, scene->valid_points, request->gaussians);
    } else {
        snprintf(reason, T3R_ERROR_BYTES, "out of memory");
    }
    free(s.reference);
    free(s.alpha);
    free(s.drawn);
    return status;
}
