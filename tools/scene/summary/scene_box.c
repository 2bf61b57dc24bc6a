/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/summary/scene_box.h"

#include <math.h>
#include <stdlib.h>

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int scene_box_of(const scene_file *scene, scene_up up, scene_box *out)
{
    const uint32_t surfaces = scene_surfaces(scene->gaussians, scene->count);
    const uint32_t count = surfaces > 0 ? surfaces : scene->count;
    double *values = malloc(count * sizeof *values);
    if (values == NULL) {
        return -1;
    }
    out->upright = scene_turn_between(SCENE_AXES_AS_THEY_ARE, SCENE_AXES_RDF, up);
    for (int axis = 0; axis < 3; axis++) {
        const double *row = out->upright.matrix + 3 * axis;
        for (uint32_t i = 0; i < count; i++) {
            const int32_t *at = scene->gaussians[i].position_q20;
            values[i] = ldexp(row[0] * at[0] + row[1] * at[1] + row[2] * at[2], scene->frame.exponent - 20);
        }
        qsort(values, count, sizeof *values, compare);
        const double low = values[count / 20], high = values[count - 1 - count / 20];
        out->middle[axis] = (low + high) / 2;
        out->half[axis] = (high - low) / 2 * 1.25;
    }
    free(values);
    return 0;
}

void scene_box_world(const scene_box *box, const scene_file *scene, const double upright[3], double world[3])
{
    for (int axis = 0; axis < 3; axis++) {
        world[axis] = ldexp((double)scene->frame.origin_q32[axis], -32);
        for (int i = 0; i < 3; i++) { /* the inverse of the turn */
            world[axis] += box->upright.matrix[3 * i + axis] * upright[i];
        }
    }
}
