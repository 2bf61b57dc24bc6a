#include "kernels/solve.h"

#include "core/fixed.h"
#include "core/memory.h"
#include "kernels/solve_parts.h"

/* The normal equations in phi = (1, x, y, xx - 1/2, 2 xy, yy - 1/2), with both sides times 4 and then scaled to 32
 * bits, each by its own power of two: a 2^a_up, b 2^b_up. */
typedef struct equations {
    int32_t a[T3R_REFINE_PARAMETERS][T3R_REFINE_PARAMETERS]; /* below 2^31; only the lower triangle */
    int32_t b[T3R_REFINE_PARAMETERS];                        /* below 2^30 */
    int32_t damping;
    int32_t a_up, b_up;
} equations;

/* Returns the left shift, negative for right, after which the largest takes `bits` bits. */
static int32_t room_of(const int32_t *x, uint32_t count, int32_t bits)
{
    uint32_t all = 0;
    for (uint32_t i = 0; i < count; i++) {
        all |= (uint32_t)(x[i] ^ (x[i] >> 31));
    }
    return all == 0 ? bits : bits - 1 - (int32_t)t3r_msb32(all);
}

static equations normal_equations(const t3r_refine_sums *s)
{
    const int32_t damping = 4 * (int32_t)T3R_MAX((128u * DAMPING) >> t3r_refine_shift(s->area), 1u);
    const int32_t most_up = DAMPING_BITS - (int32_t)t3r_msb32((uint32_t)damping);
    equations e = {.b_up = room_of(s->gradient, T3R_REFINE_MOMENTS_2, GRADIENT_BITS)};
    e.a_up = T3R_MIN(room_of(s->curvature, T3R_REFINE_MOMENTS_4, CURVATURE_BITS), most_up);
    e.damping = t3r_scale32(damping, e.a_up);
    int32_t g[T3R_REFINE_MOMENTS_2], c[T3R_REFINE_MOMENTS_4];
    for (int k = 0; k < T3R_REFINE_MOMENTS_2; k++) {
        g[k] = t3r_scale32(s->gradient[k], e.b_up);
    }
    for (int k = 0; k < T3R_REFINE_MOMENTS_4; k++) {
        c[k] = t3r_scale32(s->curvature[k], e.a_up);
    }
    const int32_t m = c[T3R_M_1], x = c[T3R_M_X], y = c[T3R_M_Y];
    const int32_t xx = c[T3R_M_X2], xy = c[T3R_M_XY], yy = c[T3R_M_Y2];
    const int32_t rows[T3R_REFINE_PARAMETERS][T3R_REFINE_PARAMETERS] = {
        {4 * m},
        {4 * x, 4 * xx},
        {4 * y, 4 * xy, 4 * yy},
        {4 * xx - 2 * m, 4 * c[T3R_M_X3] - 2 * x, 4 * c[T3R_M_X2Y] - 2 * y, 4 * c[T3R_M_X4] - 4 * xx + m},
        {8 * xy, 8 * c[T3R_M_X2Y], 8 * c[T3R_M_XY2], 8 * c[T3R_M_X3Y] - 4 * xy, 16 * c[T3R_M_X2Y2]},
        {4 * yy - 2 * m, 4 * c[T3R_M_XY2] - 2 * x, 4 * c[T3R_M_Y3] - 2 * y, 4 * c[T3R_M_X2Y2] - 2 * xx - 2 * yy + m,
         8 * c[T3R_M_XY3] - 4 * xy, 4 * c[T3R_M_Y4] - 4 * yy + m},
    };
    const int32_t right[T3R_REFINE_PARAMETERS] = {4 * g[0], 4 * g[1],           4 * g[2], 4 * g[3] - 2 * g[0],
                                                  8 * g[4], 4 * g[5] - 2 * g[0]};
    memcpy(e.a, rows, sizeof rows);
    memcpy(e.b, right, sizeof right);
    return e;
}

/* 1 / sqrt(d) = root 2^(up - 31), root in 2^15..2^16 - 1, and sqrt(d) = straight 2^-up, straight in the same range. */
typedef struct inverse_root {
    uint32_t root, straight;
    int32_t up; /* 0..15 */
} inverse_root;

/* Computes the inverse root. f = d 4^up / 2^32 is in [1/4, 1): 1 / sqrt f from a parabola, then two Newton steps y (3 -
 * f y^2) / 2. */
static inverse_root inverse_root_of(uint32_t d)
{
    const uint32_t up = (uint32_t)__builtin_clz(d) / 2, f_q16 = (d << (2 * up)) >> 16;
    uint32_t y_q15 = ROOT_C0 - ((f_q16 * (ROOT_C1 - ((f_q16 * ROOT_C2) >> 16))) >> 16);
    for (int step = 0; step < 2; step++) {
        const uint32_t half = y_q15 >> 1, square_q14 = (half * half) >> 14; /* y < 2.1: products below 2^32 */
        const uint32_t part_q15 = (f_q16 * square_q14) >> 15;               /* f y^2, near 1 */
        y_q15 = (half * ((3u << 15) - part_q15)) >> 15;
    }
    const uint32_t root = T3R_MIN(y_q15, (uint32_t)UINT16_MAX);
    return (inverse_root){root, (f_q16 * root) >> 15, (int32_t)up};
}

/* Returns a / sqrt(d_i d_j) in Q15: |a| 2^(ups) is below 2^32 and reduced to 15 bits first. */
static int16_t correlation_of(int32_t a, inverse_root i, inverse_root j)
{
    const int32_t a_q15 = t3r_clamp32(t3r_scale32(a, i.up + j.up - 17), -INT16_MAX, INT16_MAX);
    const int32_t half = (a_q15 * (int32_t)i.root) >> 16;
    return (int16_t)t3r_clamp32((half * (int32_t)j.root) >> 14, -INT16_MAX, INT16_MAX);
}

/* Solves (A + 3/16 diag A + damping) x = b in the unknowns x sqrt(diagonal), in which the diagonal is 1: Gauss-Seidel,
 * a fixed number of sweeps, without a division. The matrix is positive and its diagonal raised by 3/16, so it
 * converges, and no unknown exceeds 16 times the largest right side. */
static void solve(const equations *e, int32_t x_q16[T3R_REFINE_PARAMETERS])
{
    inverse_root root[T3R_REFINE_PARAMETERS];
    int16_t a_q15[T3R_REFINE_PARAMETERS][T3R_REFINE_PARAMETERS];
    int32_t top = 0; /* the highest bit of the largest right side, scaled */
    for (int i = 0; i < T3R_REFINE_PARAMETERS; i++) {
        const uint32_t square = (uint32_t)T3R_MAX(e->a[i][i], 0); /* rounding may leave it a little below 0 */
        const uint32_t diagonal = square + ((square >> 4) * RELATIVE_DAMPING_Q4) + (uint32_t)e->damping;
        root[i] = inverse_root_of(T3R_MAX(diagonal, 1u));
        const uint32_t size = (uint32_t)t3r_abs32(e->b[i]);
        top = size == 0 ? top : T3R_MAX(top, (int32_t)t3r_msb32(size) + root[i].up);
        a_q15[i][i] = 0;
        for (int j = 0; j < i; j++) {
            a_q15[i][j] = a_q15[j][i] = correlation_of(e->a[i][j], root[i], root[j]);
        }
    }
    int16_t b[T3R_REFINE_PARAMETERS], y[T3R_REFINE_PARAMETERS] = {0};
    int32_t most[T3R_REFINE_PARAMETERS]; /* bound of y: that of 8 for x, as far as it fits 16 bits */
    for (int i = 0; i < T3R_REFINE_PARAMETERS; i++) {
        const int32_t side = t3r_scale32(e->b[i], root[i].up + 14 - top); /* to 15 bits; at most 2^15 */
        b[i] = (int16_t)((side * (int32_t)(root[i].root >> 1)) >> 19);
        const int32_t up = e->b_up - e->a_up + 28 - top - root[i].up;
        most[i] = up >= 0 ? INT16_MAX : T3R_MIN(t3r_scale32((int32_t)root[i].straight, up), INT16_MAX);
    }
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        for (int i = 0; i < T3R_REFINE_PARAMETERS; i++) {
            uint32_t rest = ((uint32_t)(int32_t)b[i] << 15) + (1u << 14); /* modulo 2^32: the result is below 2^31 */
            for (int j = 0; j < T3R_REFINE_PARAMETERS; j++) {
                rest -= (uint32_t)(a_q15[i][j] * y[j]);
            }
            y[i] = (int16_t)t3r_clamp32((int32_t)rest >> 15, -most[i], most[i]);
        }
    }
    for (int i = 0; i < T3R_REFINE_PARAMETERS; i++) {
        /* y is 2^(25 - top) times its value, a root 2^(31 - up) times its value, x in Q16 */
        const int32_t up = top + root[i].up + e->a_up - e->b_up - 40;
        const int64_t x = t3r_scale64((int64_t)y[i] * root[i].root, T3R_MIN(up, UP_MOST));
        x_q16[i] = (int32_t)t3r_clamp64(x, -SOLUTION_MOST_Q16, SOLUTION_MOST_Q16);
    }
}

static t3r_correction corrected(const t3r_refine_sums *s, const t3r_correction *before)
{
    if (s->weight <= 0) {
        return (t3r_correction){{0}, {0}, 0};
    }
    const equations e = normal_equations(s);
    t3r_solution solution;
    for (int i = 0; i < T3R_REFINE_PARAMETERS; i++) {
        solution.diagonal[i] = e.a[i][i];
    }
    solve(&e, solution.x_q16);
    return t3r_correction_of(s, &solution, before);
}

void t3r_solve_c(const t3r_refine_sums *sums, uint32_t count, t3r_correction *corrections)
{
    for (uint32_t i = 0; i < count; i++) {
        corrections[i] = corrected(&sums[i], &corrections[i]);
    }
}
