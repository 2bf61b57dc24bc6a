#include "solve.h"

#include "core/fixed.h"

/* Neighbours correct the same pixels, so that no Gaussian takes all that its sums ask for: */
#define COLOUR_STEP_Q5 26    /* 0.8 of the weighted mean residual */
#define SHARE_FIRST_Q14 2816 /* 11/64 of the Gauss-Newton step in the first pass */
#define SHARE_LEAST_Q14 512  /* 1/32 */
#define SHARE_MOST_Q14 8192  /* 1/2 */
#define ASKED_MOST_Q16 (2 << 16)
#define RELATIVE_DAMPING_Q4 3
#define DAMPING 64         /* levels^2: below it a direction is noise */
#define MOMENTUM_Q4 3      /* of the pass before, added */
#define OPACITY_MOST 32767 /* largest step of log opacity, Q16: 1/2 */
#define SHIFT_MOST 32767   /* of the position, in deviations: 1/2 */
#define SHAPE_MOST 6554    /* of log scale and shear: 0.1 */
#define COLOUR_MOST 32640  /* with what is carried on, likewise the next */
#define STEP_MOST 32767
#define SWEEPS 8
#define SOLUTION_MOST_Q16 (8 << 16)

uint32_t t3r_refine_shift(uint32_t area)
{
    return area <= 64 ? 0 : t3r_msb32(area - 1) - 5;
}

typedef struct equations {
    int64_t a[T3R_REFINE_PARAMETERS][T3R_REFINE_PARAMETERS]; /* below 2^35 */
    int64_t b[T3R_REFINE_PARAMETERS];                        /* below 2^35 */
} equations;

/* The normal equations in phi = (1, x, y, xx - 1/2, 2 xy, yy - 1/2), both sides 4 times. Lower triangle first. */
static equations normal_equations(const t3r_refine_sums *s)
{
    const int64_t r = s->gradient[0];
    const int64_t m = s->curvature[0], x = s->curvature[1], y = s->curvature[2];
    const int64_t xx = s->curvature[3], xy = s->curvature[4], yy = s->curvature[5];
    const int64_t xxx = s->curvature[6], xxy = s->curvature[7], xyy = s->curvature[8], yyy = s->curvature[9];
    const int64_t xxxx = s->curvature[10], xxxy = s->curvature[11], xxyy = s->curvature[12];
    const int64_t xyyy = s->curvature[13], yyyy = s->curvature[14];
    equations e = {
        .a = {{4 * m},
              {4 * x, 4 * xx},
              {4 * y, 4 * xy, 4 * yy},
              {4 * xx - 2 * m, 4 * xxx - 2 * x, 4 * xxy - 2 * y, 4 * xxxx - 4 * xx + m},
              {8 * xy, 8 * xxy, 8 * xyy, 8 * xxxy - 4 * xy, 16 * xxyy},
              {4 * yy - 2 * m, 4 * xyy - 2 * x, 4 * yyy - 2 * y, 4 * xxyy - 2 * xx - 2 * yy + m, 8 * xyyy - 4 * xy,
               4 * yyyy - 4 * yy + m}},
        .b = {4 * r, 4 * (int64_t)s->gradient[1], 4 * (int64_t)s->gradient[2], 4 * (int64_t)s->gradient[3] - 2 * r,
              8 * (int64_t)s->gradient[4], 4 * (int64_t)s->gradient[5] - 2 * r},
    };
    for (int i = 0; i < T3R_REFINE_PARAMETERS; i++) {
        for (int j = i + 1; j < T3R_REFINE_PARAMETERS; j++) {
            e.a[i][j] = e.a[j][i];
        }
    }
    return e;
}

/* Gauss-Seidel, a fixed number of sweeps: the matrix is positive and its diagonal raised by 3/16, so they close in. */
static void solve(const equations *e, uint32_t shift, int32_t x_q16[T3R_REFINE_PARAMETERS])
{
    int64_t damping = 4 * (int64_t)T3R_MAX((128 * DAMPING) >> shift, 1);
    for (int i = 0; i < T3R_REFINE_PARAMETERS; i++) {
        x_q16[i] = 0;
    }
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        for (int i = 0; i < T3R_REFINE_PARAMETERS; i++) {
            /* roundings may leave a square's sum a little below 0 */
            int64_t square = T3R_MAX(e->a[i][i], 0);
            int64_t divisor = square + ((square * RELATIVE_DAMPING_Q4) >> 4) + damping;
            int64_t rest = e->b[i] * (1 << 16); /* below 2^51 */
            for (int j = 0; j < T3R_REFINE_PARAMETERS; j++) {
                rest -= j == i ? 0 : e->a[i][j] * x_q16[j]; /* below 2^35 x 2^19 */
            }
            int64_t x = t3r_round_div64(rest, divisor);
            x_q16[i] = (int32_t)t3r_clamp64(x, -SOLUTION_MOST_Q16, SOLUTION_MOST_Q16);
        }
    }
}

/* The share of the Gauss-Newton step `wanted` that this pass takes: Aitken's relaxation, of each Gaussian by itself
 * (Irons and Tuck, "A version of the Aitken accelerator for computer iteration", 1969). Of the whole step before, of
 * which a share was taken, the part that is asked for again now says what that share and all neighbours' came to
 * together; the other way when it was too much. Steps are compared by what they change in the pictures, the diagonal of
 * the equations. */
static int32_t share_q14(const equations *e, const int32_t wanted_q16[T3R_REFINE_PARAMETERS],
                         const t3r_correction *before)
{
    const int64_t last = before->share_q14;
    if (last == 0) {
        return SHARE_FIRST_Q14;
    }
    int64_t largest = 0;
    for (int i = 0; i < T3R_REFINE_PARAMETERS; i++) {
        largest = T3R_MAX(largest, e->a[i][i]);
    }
    uint32_t shift = largest >> 17 == 0 ? 0 : t3r_msb64((uint64_t)largest) - 16;
    /* below 2^50.9; and 2^48.7, as momentum takes steps of the shape to SHAPE_MOST 16/13 = 8,066 and others to 2^15 */
    int64_t again = 0, before_squared = 0;
    _Static_assert(SHAPE_MOST <= 6554 && MOMENTUM_Q4 <= 3 && SHARE_MOST_Q14 <= 8192,
                   "the quotient below is in 64 bits");
    for (int i = 0; i < T3R_REFINE_PARAMETERS; i++) {
        int64_t weighed = (T3R_MAX(e->a[i][i], 0) >> shift) * before->step_q16[i];
        again += weighed * t3r_clamp32(wanted_q16[i], -ASKED_MOST_Q16, ASKED_MOST_Q16);
        before_squared += weighed * before->step_q16[i];
    }
    if (before_squared == 0) {
        return (int32_t)last;
    }
    int64_t answered = before_squared - t3r_round_shift64(again, 14) * last;                     /* below 2^50.5 */
    int64_t share = answered <= 0 ? 2 * last : t3r_round_div64(before_squared * last, answered); /* below 2^61.7 */
    return (int32_t)t3r_clamp64(share, T3R_MAX(last / 4, SHARE_LEAST_Q14), T3R_MIN(2 * last, SHARE_MOST_Q14));
}

/* This pass's own change, and the pass before goes on a little. Both are within 16 bits. */
static int16_t carried_on(int64_t change, int32_t before, int32_t most)
{
    return (int16_t)t3r_clamp64(change + t3r_round_shift32(before * MOMENTUM_Q4, 4), -most, most);
}

static t3r_correction correction_of(const t3r_refine_sums *s, const t3r_correction *before)
{
    t3r_correction c = {{0}, {0}, 0};
    if (s->weight <= 0) {
        return c;
    }
    for (int i = 0; i < 3; i++) {
        /* Q11 over Q15, to Q7 and times Q5 */
        int64_t change = t3r_round_div64((int64_t)s->colour[i] * (COLOUR_STEP_Q5 << 6), s->weight);
        c.colour_q7[i] = carried_on(change, before->colour_q7[i], COLOUR_MOST);
    }
    equations e = normal_equations(s);
    int32_t x[T3R_REFINE_PARAMETERS];
    solve(&e, t3r_refine_shift(s->area), x);
    x[0] -= t3r_round_shift32(x[3] + x[5], 1); /* what phi's halves mean for the opacity */
    const int32_t most[] = {OPACITY_MOST, SHIFT_MOST, SHIFT_MOST, SHAPE_MOST, SHAPE_MOST, SHAPE_MOST};
    const int32_t share = share_q14(&e, x, before);
    for (int i = 0; i < T3R_REFINE_PARAMETERS; i++) {
        int64_t taken = t3r_round_shift64((int64_t)x[i] * share, 14);
        c.step_q16[i] = carried_on(t3r_clamp64(taken, -most[i], most[i]), before->step_q16[i], STEP_MOST);
    }
    c.share_q14 = (int16_t)share;
    return c;
}

void t3r_solve_c(const t3r_refine_sums *sums, uint32_t count, t3r_correction *corrections)
{
    for (uint32_t i = 0; i < count; i++) {
        corrections[i] = correction_of(&sums[i], &corrections[i]);
    }
}
