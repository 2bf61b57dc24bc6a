/* The small equations of alignment. */
#ifndef T3R_ALIGN_SOLVE_H
#define T3R_ALIGN_SOLVE_H

#include "misalignment.h"

/* x with A x = b, of a symmetric A that is at least weakly positive definite: its upper triangle row after row, entries
 * below 2^62; b in Q4, |b| below 2^62. x is in Q30, held within +-T3R_ALIGN_STEP_MOST_Q30. Its error is some 2^-8 of
 * the step along a direction that A bounds 2^8 times less than others: rounds that follow make up for it. */
#define T3R_ALIGN_STEP_MOST_Q30 (1 << 26)
void t3r_align_solve(const int64_t a[T3R_ALIGN_PRODUCTS], const int64_t b_q4[T3R_ALIGN_UNKNOWNS],
                     int32_t x_q30[T3R_ALIGN_UNKNOWNS]);

#endif
