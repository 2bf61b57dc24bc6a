/* SPDX-License-Identifier: Apache-2.0 */
#include "viewer/start_view.h"

#include <math.h>
#include <stdlib.h>

#include "import/viewpoint.h"
#include "scene/scene_turn.h"

#define DEGREES 60 /* horizontal angle */

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Finds the middle and half the size of the scene along an axis, in scene units: of the range without a twentieth of
 * the Gaussians at each end, widened by a quarter. */
static void find_range(const scene_file *scene, const double axis[3], double *values, double *middle, double *half)
{
    for (uint32_t i = 0; i < scene->count; i++) {
        const int32_t *at = scene->gaussians[i].position_q20;
        values[i] = ldexp(axis[0] * at[0] + axis[1] * at[1] + axis[2] * at[2], -20);
    }
    qsort(values, scene->count, sizeof *values, compare);
    const double low = values[scene->count / 20], high = values[scene->count - 1 - scene->count / 20];
    *middle = (low + high) / 2;
    *half = (high - low) / 2 * 1.25;
}

int start_view(const scene_file *scene, uint32_t width, uint32_t height, t3r_camera *out)
{
    (void)viewpoint_from_angle(DEGREES, width, height, out);
    const scene_turn upright = scene_turn_between(SCENE_AXES_AS_THEY_ARE, SCENE_AXES_RDF, scene->up);
    double middle[3], half[3], *values = malloc(scene->count * sizeof *values);
    if (values == NULL) {
        return -1;
    }
    for (int axis = 0; axis < 3; axis++) { /* right, down and forward of the camera */
        find_range(scene, upright.matrix + 3 * axis, values, &middle[axis], &half[axis]);
    }
    free(values);
    const double wide = half[0] * out->fx_q16 / (width << 15);
    const double high = half[1] * out->fy_q16 / (height << 15);
    middle[2] -= half[2] + fmax(wide, high);
    for (int axis = 0; axis < 3; axis++) {
        double at = 0;
        for (int i = 0; i < 3; i++) { /* the inverse of the turn */
            at += upright.matrix[3 * i + axis] * middle[i];
        }
        out->position_q32[axis] = scene->frame.origin_q32[axis] + llround(ldexp(at, scene->frame.exponent + 32));
    }
    for (int i = 0; i < 4; i++) {
        const double turned = i == 0 ? upright.rotation[0] : -upright.rotation[i];
        out->rotation_q30[i] = (int32_t)llround(ldexp(turned, 30));
    }
    return 0;
}
