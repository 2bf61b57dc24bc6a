/* From the sums of Gaussians to their corrections (SPEC.md, "Refinement"). */
#ifndef T3R_KERNEL_SOLVE_H
#define T3R_KERNEL_SOLVE_H

#include <stdint.h>

#include "scatter.h"

/* Parameters of a Gaussian's appearance: log opacity; shift along its two surface axes; log scale and shear in them. */
#define T3R_REFINE_PARAMETERS 6

/* What a pass changes in a Gaussian. */
typedef struct t3r_correction {
    int16_t colour_q7[3];
    int16_t step_q16[T3R_REFINE_PARAMETERS];
    int16_t share_q14; /* of the Gauss-Newton step, 1/32..1/2; 0: none before */
} t3r_correction;

/* The corrections of `count` Gaussians, each a share of the damped Gauss-Newton step, as large as the answer to the
 * correction of the pass before allows, with momentum: a part of that correction (Polyak, "Some methods of speeding up
 * the convergence of iteration methods", 1964). corrections: those of the pass before, 0 in the first pass, and then
 * the new ones. Sums are below 2^31 as t3r_refine_sums says; records lie one behind the other, aligned to 4 and 2
 * bytes. */
typedef void t3r_solve_kernel(const t3r_refine_sums *sums, uint32_t count, t3r_correction *corrections);
t3r_solve_kernel t3r_solve_c;

#endif
