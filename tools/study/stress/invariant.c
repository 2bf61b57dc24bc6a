/* SPDX-License-Identifier: Apache-2.0 */
#include "study/stress/invariant.h"

#include <math.h>

#define POSITION_MOST_Q20 (1 << 30)
#define EXPONENT_LEAST (-60)
#define EXPONENT_MOST 15
#define COLOUR_MOST_Q7 32640
#define OPACITY_MOST_Q15 32767

static bool in_range(const t3r_gaussian *g)
{
    for (int i = 0; i < 3; i++) {
        if (g->position_q20[i] < -POSITION_MOST_Q20 || g->position_q20[i] > POSITION_MOST_Q20 ||
            g->colour_q7[i] > COLOUR_MOST_Q7) {
            return false;
        }
    }
    return g->factor_exponent >= EXPONENT_LEAST && g->factor_exponent <= EXPONENT_MOST &&
           g->opacity_q15 <= OPACITY_MOST_Q15;
}

bool stress_finite(const gaussian_shape *shape)
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        sum += log(shape->scale[i]); /* as in a .ply */
    }
    for (int i = 0; i < 4; i++) {
        sum += shape->rotation[i];
    }
    return isfinite(sum);
}

const char *stress_broken_invariant(const t3r_scene *scene, uint32_t count, bool at_most)
{
    if (at_most ? scene->count == 0 || scene->count > count : scene->count != count) {
        return "the budget is not met";
    }
    for (uint32_t i = 0; i < scene->count; i++) {
        if (!in_range(&scene->gaussians[i])) {
            return "a Gaussian is out of range";
        }
        const gaussian_shape shape = gaussian_shape_of(&scene->gaussians[i]);
        if (!stress_finite(&shape)) {
            return "a Gaussian is not finite";
        }
    }
    return NULL;
}
