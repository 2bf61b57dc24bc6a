/* Refinement: draws the context views, scatters the residuals back to the Gaussians that drew each pixel, and corrects
 * these Gaussians (SPEC.md, "Refinement"). A pass measures everything on one scene, then changes all of it at once. */
#ifndef T3R_REFINE_H
#define T3R_REFINE_H

#include <stdint.h>

#include "raster/raster_list.h"
#include "core/map_record.h"
#include "state/views.h"

/* Applies a correction to a Gaussian. */
void t3r_refine_apply(const t3r_correction *correction, t3r_gaussian *gaussian);

/* Runs `passes` passes over the scene in the arena. T3R_ERR_CANCELLED leaves the scene as the last whole pass made
 * it. */
t3r_status t3r_refine(t3r_runtime *rt, const t3r_view *views, uint32_t passes);

/* As t3r_refine(), of a map. A Gaussian doesn't change when no retained keyframe sees it as finely as its own keyframe
 * did. records: one a Gaussian; NULL: all change. */
t3r_status t3r_refine_scene(t3r_runtime *rt, const t3r_view *views, uint32_t passes, const t3r_map_record *records);

/* Returns the memory in which refinement draws a view of the working size. Others may use it before refinement runs. */
t3r_raster_room t3r_refine_room(const t3r_runtime *rt);

/* How far the scene in the arena is from the context views: mean squared residual a channel, levels^2 Q8, at most 2^24,
 * over the pixels that refinement counts. Works where t3r_refine() does: needs refine above 0. */
t3r_status t3r_refine_error(t3r_runtime *rt, const t3r_view *views, uint32_t *error_q8);

#endif
