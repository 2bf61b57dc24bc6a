/* SPDX-License-Identifier: Apache-2.0 */
/* Correction of Gaussians: parts shared by plain C and the variants (SPEC.md, "Refinement"). */
#ifndef T3R_KERNEL_SOLVE_PARTS_H
#define T3R_KERNEL_SOLVE_PARTS_H

#include "core/fixed.h"
#include "solve.h"

/* Neighbours correct the same pixels, so a Gaussian takes only a part of its own solution. */
#define COLOUR_STEP_Q5 26    /* 0.8 of the weighted mean residual */
#define SHARE_FIRST_Q14 2816 /* 11/64 of the Gauss-Newton step in the first pass */
#define SHARE_LEAST_Q14 512  /* 1/32 */
#define SHARE_MOST_Q14 8192  /* 1/2 */
#define ASKED_MOST_Q16 (2 << 16)
#define RELATIVE_DAMPING_Q4 3
#define DAMPING 64         /* levels^2: below this a direction is noise */
#define MOMENTUM_Q4 3      /* part of the last pass's correction that is added */
#define OPACITY_MOST 32767 /* largest step of log opacity, Q16: 1/2 */
#define SHIFT_MOST 32767   /* largest shift of the position, in deviations, Q16: 1/2 */
#define SHAPE_MOST 6554    /* largest step of log scale and shear, Q16: 0.1 */
#define COLOUR_MOST 32640  /* with momentum; likewise the next */
#define STEP_MOST 32767
#define SWEEPS 8
#define UP_MOST 20 /* any larger shift gives too large a solution, and 64 bits hold this one */
/* 1 / sqrt f is about C0 - f (C1 - f C2) on [1/4, 1), with the least relative error, 2.4 %. Q15, for f in Q16. */
#define ROOT_C0 87518u
#define ROOT_C1 107655u
#define ROOT_C2 53693u
#define SOLUTION_MOST_Q16 (8 << 16)

#define CURVATURE_BITS 26 /* an entry of the matrix is at most 16 times the largest of them */
#define GRADIENT_BITS 27  /* likewise 8 times */
#define DAMPING_BITS 28

/* Solution of a Gaussian's equations. */
typedef struct t3r_solution {
    int32_t diagonal[T3R_REFINE_PARAMETERS]; /* of the undamped matrix, in its own scale */
    int32_t x_q16[T3R_REFINE_PARAMETERS];    /* at most +-SOLUTION_MOST_Q16 */
} t3r_solution;

/* Returns the share of the Gauss-Newton step `wanted` that this pass takes: Aitken's relaxation, for each Gaussian
 * separately (Irons and Tuck, "A version of the Aitken accelerator for computer iteration", 1969). The last pass took
 * a share of its whole step. The part of that step that is wanted again now shows what this share and those of all
 * neighbours achieved together; a reversed sign shows that it was too much. Steps are compared by their change of the
 * pictures, the diagonal of the equations. */
static inline int32_t t3r_share_q14(const t3r_solution *wanted, const t3r_correction *before)
{
    const int64_t last = before->share_q14;
    if (last == 0) {
        return SHARE_FIRST_Q14;
    }
    int32_t largest = 0;
    for (int i = 0; i < T3R_REFINE_PARAMETERS; i++) {
        largest = T3R_MAX(largest, wanted->diagonal[i]);
    }
    uint32_t shift = largest >> 17 == 0 ? 0 : t3r_msb32((uint32_t)largest) - 16;
    /* below 2^50.9; and 2^48.7, as momentum takes steps of the shape to SHAPE_MOST 16/13 = 8,066 and others to 2^15 */
    int64_t again = 0, before_squared = 0;
    _Static_assert(SHAPE_MOST <= 6554 && MOMENTUM_Q4 <= 3 && SHARE_MOST_Q14 <= 8192,
                   "the quotient below is in 64 bits");
    for (int i = 0; i < T3R_REFINE_PARAMETERS; i++) {
        int64_t weighed = (int64_t)(T3R_MAX(wanted->diagonal[i], 0) >> shift) * before->step_q16[i];
        again += weighed * t3r_clamp32(wanted->x_q16[i], -ASKED_MOST_Q16, ASKED_MOST_Q16);
        before_squared += weighed * before->step_q16[i];
    }
    if (before_squared == 0) {
        return (int32_t)last;
    }
    int64_t answered = before_squared - t3r_round_shift64(again, 14) * last;                     /* below 2^50.5 */
    int64_t share = answered <= 0 ? 2 * last : t3r_round_div64(before_squared * last, answered); /* below 2^61.7 */
    return (int32_t)t3r_clamp64(share, T3R_MAX(last / 4, SHARE_LEAST_Q14), T3R_MIN(2 * last, SHARE_MOST_Q14));
}

/* Returns this pass's change plus momentum of the last pass. Both are within 16 bits. */
static inline int16_t t3r_carried_on(int64_t change, int32_t before, int32_t most)
{
    return (int16_t)t3r_clamp64(change + t3r_round_shift32(before * MOMENTUM_Q4, 4), -most, most);
}

/* Computes the correction; s->weight > 0. */
static inline t3r_correction t3r_correction_of(const t3r_refine_sums *s, const t3r_solution *solution,
                                               const t3r_correction *before)
{
    t3r_correction c;
    for (int i = 0; i < 3; i++) {
        /* Q11 over Q15, to Q7 and times Q5 */
        int64_t change = t3r_round_div64((int64_t)s->colour[i] * (COLOUR_STEP_Q5 << 6), s->weight);
        c.colour_q7[i] = t3r_carried_on(change, before->colour_q7[i], COLOUR_MOST);
    }
    t3r_solution wanted = *solution;
    int32_t *x = wanted.x_q16;
    x[0] -= t3r_round_shift32(x[3] + x[5], 1); /* change of opacity by the halves in phi */
    const int32_t most[] = {OPACITY_MOST, SHIFT_MOST, SHIFT_MOST, SHAPE_MOST, SHAPE_MOST, SHAPE_MOST};
    const int32_t share = t3r_share_q14(&wanted, before);
    for (int i = 0; i < T3R_REFINE_PARAMETERS; i++) {
        int64_t taken = t3r_round_shift64((int64_t)x[i] * share, 14);
        c.step_q16[i] = t3r_carried_on(t3r_clamp64(taken, -most[i], most[i]), before->step_q16[i], STEP_MOST);
    }
    c.share_q14 = (int16_t)share;
    return c;
}

#endif
