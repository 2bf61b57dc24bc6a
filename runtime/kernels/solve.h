/* SPDX-License-Identifier: Apache-2.0 */
/* Corrections of Gaussians from their sums (SPEC.md, "Refinement"). */
#ifndef T3R_KERNEL_SOLVE_H
#define T3R_KERNEL_SOLVE_H

#include <stdint.h>

#include "scatter.h"

/* Parameters of a Gaussian's appearance: log opacity; shift along its two surface axes; log scale and shear in them. */
#define T3R_REFINE_PARAMETERS 6

/* A pass's change of a Gaussian. */
typedef struct t3r_correction {
    int16_t colour_q7[3];
    int16_t step_q16[T3R_REFINE_PARAMETERS];
    int16_t share_q14; /* share taken of the Gauss-Newton step, 1/32..1/2; 0: no earlier pass */
} t3r_correction;

/* Computes the corrections of `count` Gaussians. Each is a share of the damped Gauss-Newton step, chosen by the
 * response to the last pass's correction, plus momentum: a part of that correction (Polyak, "Some methods of speeding
 * up the convergence of iteration methods", 1964). corrections: holds the last pass's, 0 in the first pass, and is
 * replaced by the new ones. Sums are below 2^31 as t3r_refine_sums says. Records are consecutive, aligned to 4 and 2
 * bytes. */
typedef void t3r_solve_kernel(const t3r_refine_sums *sums, uint32_t count, t3r_correction *corrections);
t3r_solve_kernel t3r_solve_c;

#endif
