/* SPDX-License-Identifier: Apache-2.0 */
/* LightGaussian: Unbounded 3D Gaussian Compression with 15x Reduction and 200+ FPS. Fan et al., NeurIPS 2024
 * (arXiv:2311.17245), section 3.2, "global significance": the sum over all pixels of the training views of 1(the
 * Gaussian meets the pixel's ray) x opacity x T x gamma(volume). T is the transmittance before the Gaussian, as the
 * authors' rasterizer has it. gamma(V) = (V_norm)^beta, V_norm the volume divided by the ninth decile of all volumes,
 * clamped to 0..1. A Gaussian meets a ray if it contributes to the pixel. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "study/rivals/scores/score.h"

static void add_hits(void *user, const splat_row *row)
{
    double *score = user;
    for (uint32_t i = 0; i < row->columns; i++) {
        score[row->gaussian] += row->alpha[i] > 0 ? (double)row->before[i] : 0;
    }
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Returns the logarithm of an ellipsoid's volume, the product of its axes, up to a factor that cancels. */
static double log_volume(const double *p)
{
    return p[SPLAT_LOG_SCALE] + p[SPLAT_LOG_SCALE + 1] + p[SPLAT_LOG_SCALE + 2];
}

/* Returns the ninth decile of the volumes; NaN if out of memory. */
static double ninth_decile(const splat_model *model)
{
    double *volumes = malloc(((size_t)model->count + 1) * sizeof *volumes);
    if (volumes == NULL) {
        return NAN;
    }
    for (uint32_t i = 0; i < model->count; i++) {
        volumes[i] = log_volume(&model->parameters[(size_t)i * SPLAT_PARAMETERS]);
    }
    qsort(volumes, model->count, sizeof *volumes, compare);
    double decile = volumes[(size_t)model->count * 9 / 10];
    free(volumes);
    return decile;
}

bool score_lightgaussian(const splat_model *model, const splat_view *views, uint32_t view_count, double *score)
{
    memset(score, 0, model->count * sizeof *score);
    for (uint32_t v = 0; v < view_count; v++) {
        splat_view_walk(&views[v], add_hits, score);
    }
    double decile = ninth_decile(model);
    if (isnan(decile)) {
        return false;
    }
    for (uint32_t i = 0; i < model->count; i++) {
        const double *p = &model->parameters[(size_t)i * SPLAT_PARAMETERS];
        double gamma = exp(LIGHTGAUSSIAN_BETA * fmin(log_volume(p) - decile, 0));
        score[i] *= gamma / (1 + exp(-p[SPLAT_LOGIT]));
    }
    return true;
}
