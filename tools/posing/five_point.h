/* SPDX-License-Identifier: Apache-2.0 */
/* Essential matrices of five pairs of rays. */
#ifndef TRIM3R_TOOLS_POSING_FIVE_POINT_H
#define TRIM3R_TOOLS_POSING_FIVE_POINT_H

#include "posing/motion.h"

#define FIVE_POINT_MOST 10

/* Every e with x_b^T e x_a = 0 for five pairs, det e = 0 and 2 e e^T e = trace(e e^T) e, by the action matrix of
 * Stewenius, Engels, Nister (ISPRS 2006). Rays are x and y at depth 1. Returns how many; 0 also where the five are
 * degenerate. */
int five_point(double ray_a[5][2], double ray_b[5][2], double essentials[FIVE_POINT_MOST][9]);

/* The four motions (|t| = 1) that an essential matrix stands for. 0, or -1. */
int essential_motions(const double e[9], motion motions[4]);
/* [t]x r */
void essential_of(const motion *m, double e[9]);

#endif
