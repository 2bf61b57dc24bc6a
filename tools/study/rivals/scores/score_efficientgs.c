/* SPDX-License-Identifier: Apache-2.0 */
/* EfficientGS: Streamlining Gaussian Splatting for Large-Scale High-Resolution Scene Representation. Liu et al., 2024
 * (arXiv:2404.12777), "Gaussian pruning": a Gaussian is dominant for a ray when its blending weight is among the K
 * largest there; Gaussians that are dominant for too few rays are removed. To meet a budget exactly, the score is the
 * number of rays; ties are broken by the sum of weights. */
#include <stdlib.h>
#include <string.h>

#include "study/rivals/scores/score.h"

#define NOBODY UINT32_MAX

typedef struct dominant {
    uint32_t gaussian[EFFICIENTGS_MOST]; /* by falling weight */
    float weight[EFFICIENTGS_MOST];
} dominant;

typedef struct ranking {
    dominant *pixels;
    uint32_t width;
    double *weights; /* per Gaussian, over all its pixels */
} ranking;

/* Inserts a Gaussian by weight; of equal weights the one drawn first stays first. */
static void enter(dominant *pixel, uint32_t gaussian, float weight)
{
    for (uint32_t k = 0; k < EFFICIENTGS_MOST; k++) {
        if (weight > pixel->weight[k]) {
            uint32_t moved = pixel->gaussian[k];
            float lighter = pixel->weight[k];
            pixel->gaussian[k] = gaussian;
            pixel->weight[k] = weight;
            gaussian = moved;
            weight = lighter;
        }
    }
}

static void rank(void *user, const splat_row *row)
{
    ranking *r = user;
    for (uint32_t i = 0; i < row->columns; i++) {
        float weight = row->alpha[i] * row->before[i];
        enter(&r->pixels[(size_t)row->y * r->width + row->x + i], row->gaussian, weight);
        r->weights[row->gaussian] += (double)weight;
    }
}

static bool count_rays(const splat_view *view, double *weights, double *score)
{
    size_t pixels = (size_t)view->camera.width * view->camera.height;
    ranking r = {.pixels = malloc(pixels * sizeof *r.pixels), .width = view->camera.width, .weights = weights};
    if (r.pixels == NULL) {
        return false;
    }
    for (size_t i = 0; i < pixels; i++) {
        for (uint32_t k = 0; k < EFFICIENTGS_MOST; k++) {
            r.pixels[i].gaussian[k] = NOBODY;
            r.pixels[i].weight[k] = 0;
        }
    }
    splat_view_walk(view, rank, &r);
    for (size_t i = 0; i < pixels; i++) {
        for (uint32_t k = 0; k < EFFICIENTGS_MOST; k++) {
            if (r.pixels[i].gaussian[k] != NOBODY) {
                score[r.pixels[i].gaussian[k]] += 1;
            }
        }
    }
    free(r.pixels);
    return true;
}

bool score_efficientgs(const splat_model *model, const splat_view *views, uint32_t view_count, double *score)
{
    double most = 0, *weights = calloc((size_t)model->count + 1, sizeof *weights);
    bool done = weights != NULL;
    memset(score, 0, model->count * sizeof *score);
    for (uint32_t v = 0; v < view_count && done; v++) {
        done = count_rays(&views[v], weights, score);
    }
    for (uint32_t i = 0; i < model->count && done; i++) {
        most = weights[i] > most ? weights[i] : most;
    }
    for (uint32_t i = 0; i < model->count && done && most > 0; i++) {
        score[i] += 0.5 * weights[i] / most;
    }
    free(weights);
    return done;
}
