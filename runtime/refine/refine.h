/* Refinement: the context views are drawn, what they miss is scattered back to the Gaussians that drew it, and these
 * are corrected (SPEC.md, "Refinement"). Everything of one pass is measured on one scene; then all of it changes at
 * once. */
#ifndef T3R_REFINE_H
#define T3R_REFINE_H

#include <stdint.h>

#include "raster/raster_list.h"
#include "core/map_record.h"
#include "core/views.h"

/* Parameters of a Gaussian's appearance: log opacity; shift along its two surface axes; log scale and shear in them. */
#define T3R_REFINE_PARAMETERS 6
/* Monomials e_x^i e_y^j with i + j <= 2, and with i + j <= 4, in the order 1 x y xx xy yy xxx xxy xyy yyy xxxx ... */
#define T3R_REFINE_MOMENTS_2 6
#define T3R_REFINE_MOMENTS_4 15

/* What one Gaussian's pixels add up to, over all views, shifted right by t3r_refine_shift(area). Integers, so the order
 * of adding does not show. */
typedef struct t3r_refine_sums {
    int32_t colour[3];                       /* sum of w r, levels, Q11 */
    int32_t weight;                          /* sum of w, Q15 */
    int32_t gradient[T3R_REFINE_MOMENTS_2];  /* sum of (g . r) e^ij, levels^2, Q7 */
    int32_t curvature[T3R_REFINE_MOMENTS_4]; /* sum of |g|^2 e^ij, levels^2, Q7 */
    uint32_t area;                           /* pixels of its boxes in the views added so far, below 2^28 */
} t3r_refine_sums;

/* What a pass changes in a Gaussian. */
typedef struct t3r_correction {
    int16_t colour_q7[3];
    int16_t step_q16[T3R_REFINE_PARAMETERS];
    int16_t share_q14; /* of the Gauss-Newton step, 1/32..1/2; 0: none before */
} t3r_correction;

/* Sums of so many pixels are kept shifted right by ceil(log2 area) - 6, at least 0: 64 pixels' worth at most. */
uint32_t t3r_refine_shift(uint32_t area);

/* A share of the damped Gauss-Newton step of one Gaussian, as large as the answer to the correction `before` allows,
 * with momentum (Polyak, "Some methods of speeding up the convergence of iteration methods", 1964): a part of `before`,
 * which is 0 in the first pass. */
t3r_correction t3r_refine_solve(const t3r_refine_sums *sums, const t3r_correction *before);

/* Takes that step. */
void t3r_refine_apply(const t3r_correction *correction, t3r_gaussian *gaussian);

/* All passes over the scene in the arena. T3R_ERR_CANCELLED leaves it somewhere between two passes. */
t3r_status t3r_refine(t3r_runtime *rt, const t3r_view *views);

/* The same of a map: Gaussians of which none of the keyframes at hand has as much to tell as their own had stay as they
 * are. records: one a Gaussian; NULL: all change. */
t3r_status t3r_refine_scene(t3r_runtime *rt, const t3r_view *views, const t3r_map_record *records);

/* The room in which refinement draws a view of the working size: whoever draws one before can use it. */
t3r_raster_room t3r_refine_room(const t3r_runtime *rt);

/* How far the scene in the arena is from the context views: mean squared residual a channel, levels^2 Q8, at most 2^24,
 * over the pixels that refinement counts. Works where t3r_refine() does: needs refinements. */
t3r_status t3r_refine_error(t3r_runtime *rt, const t3r_view *views, uint32_t *error_q8);

#endif
