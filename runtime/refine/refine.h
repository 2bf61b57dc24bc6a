/* Refinement: the context views are drawn, what they miss is scattered back to the Gaussians that drew it, and these
 * are corrected (SPEC.md, "Refinement"). Everything of one pass is measured on one scene; then all of it changes at
 * once. */
#ifndef T3R_REFINE_H
#define T3R_REFINE_H

#include <stdint.h>

#include "raster/raster_list.h"
#include "core/map_record.h"
#include "state/views.h"

/* A Gaussian takes the step of its correction. */
void t3r_refine_apply(const t3r_correction *correction, t3r_gaussian *gaussian);

/* So many passes over the scene in the arena. T3R_ERR_CANCELLED leaves it somewhere between two passes. */
t3r_status t3r_refine(t3r_runtime *rt, const t3r_view *views, uint32_t passes);

/* The same of a map. A Gaussian stays as it is when no retained keyframe sees it as finely as its own keyframe did.
 * records: one a Gaussian; NULL: all change. */
t3r_status t3r_refine_scene(t3r_runtime *rt, const t3r_view *views, uint32_t passes, const t3r_map_record *records);

/* The room in which refinement draws a view of the working size: whoever draws one before can use it. */
t3r_raster_room t3r_refine_room(const t3r_runtime *rt);

/* How far the scene in the arena is from the context views: mean squared residual a channel, levels^2 Q8, at most 2^24,
 * over the pixels that refinement counts. Works where t3r_refine() does: needs refine above 0. */
t3r_status t3r_refine_error(t3r_runtime *rt, const t3r_view *views, uint32_t *error_q8);

#endif
