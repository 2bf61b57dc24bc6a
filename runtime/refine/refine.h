/* SPDX-License-Identifier: Apache-2.0 */
/* Refinement: draws the context views, scatters the residuals back to the Gaussians that drew each pixel, and corrects
 * these Gaussians (SPEC.md, "Refinement"). A pass measures everything on one scene, then changes all of it at once. */
#ifndef T3R_REFINE_H
#define T3R_REFINE_H

#include <stdint.h>

#include "core/map_record.h"
#include "kernels/solve.h"
#include "state/views.h"

/* Where the cameras of the live views are, in scene units. */
typedef struct t3r_viewpoints {
    uint32_t count;
    int32_t position_q20[T3R_MAX_VIEWS][3];
} t3r_viewpoints;

/* Applies the part of a correction that is of the colour. */
void t3r_refine_apply_colour(const t3r_correction *correction, t3r_gaussian *gaussian);

/* Applies a correction to a Gaussian, which comes no nearer to a camera than 7/8 of its distance. */
void t3r_refine_apply(const t3r_correction *correction, const t3r_viewpoints *from, t3r_gaussian *gaussian);

/* The passes of a refinement. The first `parts` of `count` compare one pixel in 2 x 2, another one in each pass and
 * view; the others compare every pixel. parts <= count. */
typedef struct t3r_passes {
    uint32_t count, parts;
} t3r_passes;

/* Refines the scene in the arena. T3R_ERR_CANCELLED leaves the scene after the last pass that was done. */
t3r_status t3r_refine(t3r_runtime *rt, const t3r_view *views, t3r_passes passes);

/* Refines a map. A Gaussian changes only if a retained keyframe sees it as finely as its own keyframe did. records:
 * one per Gaussian; NULL: all change. round: of keyframes that are shown to the map again; 0 = the newest is new. */
t3r_status t3r_refine_scene(t3r_runtime *rt, const t3r_view *views, t3r_passes passes, uint32_t round,
                            const t3r_map_record *records);

/* Computes the distance of the scene in the arena from the context views: mean squared residual per channel, levels^2
 * Q8, at most 2^24, over the pixels that refinement counts. Works where t3r_refine() does: needs refine above 0. */
t3r_status t3r_refine_error(t3r_runtime *rt, const t3r_view *views, uint32_t *error_q8);

#endif
