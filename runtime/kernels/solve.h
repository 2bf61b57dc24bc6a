/* From the sums of Gaussians to their corrections (SPEC.md, "Refinement"). */
#ifndef T3R_KERNEL_SOLVE_H
#define T3R_KERNEL_SOLVE_H

#include <stdint.h>

#include "scatter.h"

/* Parameters of a Gaussian's appearance: log opacity; shift along its two surface axes; log scale and shear in them. */
#define T3R_REFINE_PARAMETERS 6
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

/* The corrections of `count` Gaussians, each a share of the damped Gauss-Newton step, as large as the answer to the
 * correction of the pass before allows, with momentum: a part of that correction (Polyak, "Some methods of speeding up
 * the convergence of iteration methods", 1964). corrections: those of the pass before, 0 in the first pass, and then
 * the new ones. Sums are below 2^31 as t3r_refine_sums says; records lie one behind the other, aligned to 4 and 2
 * bytes. */
typedef void t3r_solve_kernel(const t3r_refine_sums *sums, uint32_t count, t3r_correction *corrections);
t3r_solve_kernel t3r_solve_c;

#endif
