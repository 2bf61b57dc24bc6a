/* SPDX-License-Identifier: Apache-2.0 */
/* The linear equations of alignment. */
#ifndef T3R_ALIGN_SOLVE_H
#define T3R_ALIGN_SOLVE_H

#include "misalignment.h"

/* Solves A x = b for a symmetric, positive semidefinite A. a: its upper triangle, row by row, entries below 2^62; b in
 * Q4, |b| below 2^62. x is Q30, clamped to +-T3R_ALIGN_STEP_MOST_Q30. Along a direction with curvature 2^-8 of the
 * others', the error is about 2^-8 of the step; later rounds correct it. */
#define T3R_ALIGN_STEP_MOST_Q30 (1 << 26)
void t3r_align_solve(const int64_t a[T3R_ALIGN_PRODUCTS], const int64_t b_q4[T3R_ALIGN_UNKNOWNS],
                     int32_t x_q30[T3R_ALIGN_UNKNOWNS]);

#endif
