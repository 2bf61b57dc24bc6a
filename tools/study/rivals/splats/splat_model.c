/* SPDX-License-Identifier: Apache-2.0 */
#include "study/rivals/splats/splat_model.h"

#include <math.h>
#include <stdlib.h>

#include "scene/gaussian_shape.h"
#include "scene/scene_file.h"

#define COLOUR_ONE 32640.0   /* 255 in Q7 */
#define OPACITY_ONE 32768.0  /* 1 in Q15 */
#define OPACITY_MOST 32767.0 /* the record's largest */
#define POSITION_MOST 1073741824.0

static double clamped(double x, double low, double high)
{
    return !(x >= low) ? low : x > high ? high : x; /* NaN becomes low */
}

static void load(double p[SPLAT_PARAMETERS], const t3r_gaussian *g)
{
    gaussian_shape shape = gaussian_shape_of(g);
    /* half a step from 0 and 1, where the logit is infinite */
    double opacity = clamped(g->opacity_q15 / OPACITY_ONE, 0.5 / OPACITY_ONE, OPACITY_MOST / OPACITY_ONE);
    for (int i = 0; i < 3; i++) {
        p[SPLAT_POSITION + i] = ldexp(g->position_q20[i], -20);
        p[SPLAT_LOG_SCALE + i] = log(shape.scale[i]);
        p[SPLAT_COLOUR + i] = g->colour_q7[i] / COLOUR_ONE;
    }
    for (int i = 0; i < 4; i++) {
        p[SPLAT_ROTATION + i] = shape.rotation[i];
    }
    p[SPLAT_LOGIT] = log(opacity / (1 - opacity));
}

bool splat_model_of(splat_model *model, const t3r_gaussian *gaussians, uint32_t count)
{
    model->count = count;
    model->surfaces = scene_surfaces(gaussians, count);
    model->parameters = malloc(((size_t)count + 1) * SPLAT_PARAMETERS * sizeof *model->parameters);
    if (model->parameters == NULL) {
        return false;
    }
    for (uint32_t i = 0; i < count; i++) {
        load(&model->parameters[(size_t)i * SPLAT_PARAMETERS], &gaussians[i]);
    }
    return true;
}

void splat_model_free(splat_model *model)
{
    free(model->parameters);
    *model = (splat_model){0};
}

void splat_model_store(const double p[SPLAT_PARAMETERS], t3r_gaussian *g)
{
    double scale[3], sum = 0;
    for (int i = 0; i < 3; i++) {
        double steps = nearbyint(ldexp(p[SPLAT_POSITION + i], 20));
        g->position_q20[i] = (int32_t)clamped(steps, -POSITION_MOST, POSITION_MOST);
        g->colour_q7[i] = (uint16_t)nearbyint(clamped(p[SPLAT_COLOUR + i], 0, 1) * COLOUR_ONE);
        scale[i] = exp(p[SPLAT_LOG_SCALE + i]);
        sum += scale[i];
    }
    if (isfinite(sum)) {
        (void)gaussian_shape_set(g, scale, &p[SPLAT_ROTATION]);
    }
    g->opacity_q15 = (uint16_t)fmin(nearbyint(OPACITY_ONE / (1 + exp(-p[SPLAT_LOGIT]))), OPACITY_MOST);
}
