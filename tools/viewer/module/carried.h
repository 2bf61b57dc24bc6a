/* SPDX-License-Identifier: Apache-2.0 */
/* A scene on its way from one module to another: from the one that builds to the one that draws, or to the one that
 * writes files. */
#ifndef TRIM3R_TOOLS_VIEWER_CARRIED_H
#define TRIM3R_TOOLS_VIEWER_CARRIED_H

#include "trim3r.h"

typedef struct carried {
    t3r_scene_frame frame;
    uint32_t count;
    uint32_t valid_points;
    uint32_t degree; /* of the harmonics, which follow the Gaussians if it is above 0 */
    uint32_t mip;    /* 1 = opacities are those of mip-splatting */
    t3r_gaussian gaussians[];
} carried;

/* Returns the numbers of a Gaussian's harmonics. */
static inline uint32_t carried_harmonics_count(uint32_t degree)
{
    return degree == 0 ? 0 : 3 * (degree + 1) * (degree + 1);
}

/* Returns the harmonics (Q12), Gaussian after Gaussian. */
static inline int16_t *carried_harmonics(const carried *scene)
{
    return (int16_t *)(uintptr_t)(scene->gaussians + scene->count);
}

#endif
