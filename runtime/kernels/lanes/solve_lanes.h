/* SPDX-License-Identifier: Apache-2.0 */
/* Corrections, LANES Gaussians at a time, with the steps of solve.c, one 32-bit lane per Gaussian. Included after a
 * header of lanes, in a file that names the function SOLVE. */
#ifndef T3R_KERNELS_LANES_SOLVE_LANES_H
#define T3R_KERNELS_LANES_SOLVE_LANES_H

#include "core/fixed.h"
#include "kernels/lanes/vectors/records.h"
#include "kernels/solve_parts.h"

#define PARAMETERS T3R_REFINE_PARAMETERS

typedef int32_t ints __attribute__((vector_size(LANES * sizeof(int32_t))));
typedef uint32_t uints __attribute__((vector_size(LANES * sizeof(uint32_t))));

static inline T3R_LANES_TARGET ints all_of(int32_t x)
{
    return (ints)all(x);
}

static inline T3R_LANES_TARGET ints least(ints a, ints b)
{
    return (ints)OF_LANES(min_epi32)((lanes)a, (lanes)b);
}

static inline T3R_LANES_TARGET ints most(ints a, ints b)
{
    return (ints)OF_LANES(max_epi32)((lanes)a, (lanes)b);
}

static inline T3R_LANES_TARGET ints held(ints x, ints bound)
{
    return most(least(x, bound), -bound);
}

/* Returns b where the mask has ones, else a. */
static inline T3R_LANES_TARGET ints where(ints mask, ints b, ints a)
{
    return (ints)chosen((lanes)mask, (lanes)b, (lanes)a);
}

/* Shift; counts of 32 and more, or below 0, give 0, or the sign for right shifts of signed numbers. */
static inline T3R_LANES_TARGET ints left(ints x, ints by)
{
    return (ints)left_each((lanes)x, (lanes)by);
}

/* Shifts right by 1 and more, round-half-up. */
static inline T3R_LANES_TARGET ints rounded_right(ints x, ints by)
{
    return ((ints)signed_right_each((lanes)x, (lanes)(by - 1)) + 1) >> 1;
}

/* Returns t3r_scale32(). */
static inline T3R_LANES_TARGET ints scaled(ints x, ints up)
{
    return where(up < 0, rounded_right(x, -up), left(x, up));
}

/* Returns t3r_msb32(), and 0 for 0. */
static inline T3R_LANES_TARGET ints highest_bit(ints x)
{
    const quad of_nibble = OF_QUAD(setr_epi8)(0, 0, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3, 3);
    ints bit = {0};
    for (int32_t by = 16; by >= 4; by /= 2) {
        const ints high = (ints)((uints)x >> by), some = high > 0;
        x = where(some, high, x);
        bit += some & by;
    }
    return bit + (ints)OF_LANES(shuffle_epi8)(repeated(of_nibble), (lanes)x);
}

/* The sums of Gaussians by field: gradient, curvature, area, axes; pads by repeating the last Gaussian. */
#define FIRST_WORD (offsetof(t3r_refine_sums, gradient) / sizeof(int32_t))
#define WORDS (sizeof(t3r_refine_sums) / sizeof(int32_t) - FIRST_WORD)
enum { GRADIENT, CURVATURE = T3R_REFINE_MOMENTS_2, AREA = CURVATURE + T3R_REFINE_MOMENTS_4 };
_Static_assert(WORDS % 4 == 0 && sizeof(t3r_refine_sums) % sizeof(int32_t) == 0, "whole fours");

static inline T3R_LANES_TARGET void take(const t3r_refine_sums *sums, uint32_t count, ints words[WORDS])
{
    const uint8_t *from[LANES];
    for (uint32_t i = 0; i < LANES; i++) {
        from[i] = (const uint8_t *)&sums[T3R_MIN(i, count - 1)];
    }
    for (uint32_t first = 0; first < WORDS; first += 4) {
        lanes four[4];
        read_four(from, (FIRST_WORD + first) * sizeof(int32_t), four);
        for (uint32_t k = 0; k < 4; k++) {
            words[first + k] = (ints)four[k];
        }
    }
}

typedef struct equations {
    ints a[PARAMETERS][PARAMETERS], b[PARAMETERS], damping, a_up, b_up;
} equations;

static inline T3R_LANES_TARGET ints room_of(const ints *x, int count, int32_t bits)
{
    ints all = {0};
    for (int i = 0; i < count; i++) {
        all |= x[i] ^ (x[i] >> 31);
    }
    return where(all == 0, all_of(bits), bits - 1 - highest_bit(all));
}

static inline T3R_LANES_TARGET void normal_equations(const ints words[WORDS], equations *e)
{
    const ints down = most(highest_bit(most(words[AREA], all_of(1)) - 1) - 5, all_of(0)); /* t3r_refine_shift() */
    const ints damping = 4 * most((ints)signed_right_each(all(128 * DAMPING), (lanes)down), all_of(1));
    const ints most_up = DAMPING_BITS - highest_bit(damping);
    e->b_up = room_of(words + GRADIENT, T3R_REFINE_MOMENTS_2, GRADIENT_BITS);
    e->a_up = least(room_of(words + CURVATURE, T3R_REFINE_MOMENTS_4, CURVATURE_BITS), most_up);
    e->damping = scaled(damping, e->a_up);
    ints g[T3R_REFINE_MOMENTS_2], c[T3R_REFINE_MOMENTS_4];
    for (int k = 0; k < T3R_REFINE_MOMENTS_2; k++) {
        g[k] = scaled(words[GRADIENT + k], e->b_up);
    }
    for (int k = 0; k < T3R_REFINE_MOMENTS_4; k++) {
        c[k] = scaled(words[CURVATURE + k], e->a_up);
    }
    const ints m = c[T3R_M_1], x = c[T3R_M_X], y = c[T3R_M_Y];
    const ints xx = c[T3R_M_X2], xy = c[T3R_M_XY], yy = c[T3R_M_Y2];
    e->a[0][0] = 4 * m;
    e->a[1][0] = 4 * x;
    e->a[1][1] = 4 * xx;
    e->a[2][0] = 4 * y;
    e->a[2][1] = 4 * xy;
    e->a[2][2] = 4 * yy;
    e->a[3][0] = 4 * xx - 2 * m;
    e->a[3][1] = 4 * c[T3R_M_X3] - 2 * x;
    e->a[3][2] = 4 * c[T3R_M_X2Y] - 2 * y;
    e->a[3][3] = 4 * c[T3R_M_X4] - 4 * xx + m;
    e->a[4][0] = 8 * xy;
    e->a[4][1] = 8 * c[T3R_M_X2Y];
    e->a[4][2] = 8 * c[T3R_M_XY2];
    e->a[4][3] = 8 * c[T3R_M_X3Y] - 4 * xy;
    e->a[4][4] = 16 * c[T3R_M_X2Y2];
    e->a[5][0] = 4 * yy - 2 * m;
    e->a[5][1] = 4 * c[T3R_M_XY2] - 2 * x;
    e->a[5][2] = 4 * c[T3R_M_Y3] - 2 * y;
    e->a[5][3] = 4 * c[T3R_M_X2Y2] - 2 * xx - 2 * yy + m;
    e->a[5][4] = 8 * c[T3R_M_XY3] - 4 * xy;
    e->a[5][5] = 4 * c[T3R_M_Y4] - 4 * yy + m;
    e->b[0] = 4 * g[0];
    e->b[1] = 4 * g[1];
    e->b[2] = 4 * g[2];
    e->b[3] = 4 * g[3] - 2 * g[0];
    e->b[4] = 8 * g[4];
    e->b[5] = 4 * g[5] - 2 * g[0];
}

typedef struct inverse_root {
    ints root, straight, up;
} inverse_root;

static inline T3R_LANES_TARGET inverse_root inverse_root_of(ints d)
{
    const ints up = (31 - highest_bit(d)) >> 1;
    const uints f = (uints)left(d, 2 * up) >> 16;
    uints y = ROOT_C0 - ((f * (ROOT_C1 - ((f * ROOT_C2) >> 16))) >> 16);
    for (int step = 0; step < 2; step++) {
        const uints half = y >> 1, square = (half * half) >> 14;
        const uints part = (f * square) >> 15;
        y = (half * ((3u << 15) - part)) >> 15;
    }
    const ints root = least((ints)y, all_of(UINT16_MAX));
    return (inverse_root){root, (ints)((f * (uints)root) >> 15), up};
}

static inline T3R_LANES_TARGET ints correlation_of(ints a, const inverse_root *i, const inverse_root *j)
{
    const ints whole = all_of(INT16_MAX), half = (held(scaled(a, i->up + j->up - 17), whole) * i->root) >> 16;
    return held((half * j->root) >> 14, whole);
}

/* Packs two 16-bit numbers per lane, for products of pairs. */
static inline T3R_LANES_TARGET lanes paired(ints even, ints odd)
{
    return OF_LANES(blend_epi16)((lanes)even, (lanes)(odd << 16), 0xaa);
}

/* Inputs of the sweeps. */
typedef struct unit_system {
    lanes a_q15[PARAMETERS][PARAMETERS / 2]; /* pairs in a row */
    ints b[PARAMETERS];                      /* right sides, plus half for rounding */
    ints most[PARAMETERS];                   /* bounds of the unknowns */
} unit_system;

static T3R_LANES_TARGET void sweep(const unit_system *s, ints y[PARAMETERS])
{
    lanes pairs[PARAMETERS / 2] = {all(0), all(0), all(0)};
    for (int step = 0; step < SWEEPS; step++) {
        for (int i = 0; i < PARAMETERS; i++) {
            uints rest = (uints)s->b[i];                /* modulo 2^32: the result is below 2^31 */
            for (int k = 1; k <= PARAMETERS / 2; k++) { /* the pair with the newest unknown last */
                const int pair = ((i + PARAMETERS - 1) / 2 + k) % (PARAMETERS / 2);
                rest -= (uints)OF_LANES(madd_epi16)(s->a_q15[i][pair], pairs[pair]);
            }
            const ints x = held((ints)rest >> 15, s->most[i]);
            pairs[i / 2] = i % 2 == 0 ? OF_LANES(blend_epi16)(pairs[i / 2], (lanes)x, 0x55)
                                      : OF_LANES(blend_epi16)(pairs[i / 2], (lanes)(x << 16), 0xaa);
        }
    }
    for (int i = 0; i < PARAMETERS; i++) {
        y[i] = i % 2 == 0 ? ((ints)pairs[i / 2] << 16) >> 16 : (ints)pairs[i / 2] >> 16;
    }
}

static inline T3R_LANES_TARGET ints correlation(const equations *e, int i, int j)
{
    return i == j ? all_of(0) : e->a[T3R_MAX(i, j)][T3R_MIN(i, j)];
}

/* Computes solve(); off the diagonal, the matrix becomes the correlations. */
static T3R_LANES_TARGET void solve(equations *e, ints x_q16[PARAMETERS])
{
    inverse_root root[PARAMETERS];
    ints top = {0};
    for (int i = 0; i < PARAMETERS; i++) {
        const ints square = most(e->a[i][i], all_of(0));
        const ints diagonal = square + (square >> 4) * RELATIVE_DAMPING_Q4 + e->damping;
        root[i] = inverse_root_of(diagonal - (diagonal == 0));
        const ints size = (ints)OF_LANES(abs_epi32)((lanes)e->b[i]);
        top = most(top, (highest_bit(size) + root[i].up) & (size != 0));
        for (int j = 0; j < i; j++) {
            e->a[i][j] = correlation_of(e->a[i][j], &root[i], &root[j]);
        }
    }
    unit_system s;
    for (int i = 0; i < PARAMETERS; i++) {
        const ints side = scaled(e->b[i], root[i].up + 14 - top);
        s.b[i] = (((side * (ints)((uints)root[i].root >> 1)) >> 19) << 15) + (1 << 14);
        const ints up = e->b_up - e->a_up + 28 - top - root[i].up, whole = all_of(INT16_MAX);
        s.most[i] = where(up < 0, least(rounded_right(root[i].straight, -up), whole), whole);
        for (int k = 0; k < PARAMETERS / 2; k++) {
            s.a_q15[i][k] = paired(correlation(e, i, 2 * k), correlation(e, i, 2 * k + 1));
        }
    }
    ints y[PARAMETERS];
    sweep(&s, y);
    for (int i = 0; i < PARAMETERS; i++) {
        const ints up = least(top + root[i].up + e->a_up - e->b_up - 40, all_of(UP_MOST));
        const ints x = y[i] * root[i].root;
        /* clamped before the shift, to a number that exceeds the bound but still fits */
        const ints bound = (ints)right_each(all(SOLUTION_MOST_Q16), (lanes)up) + 1;
        x_q16[i] = held(where(up < 0, rounded_right(x, -up), left(held(x, bound), up)), all_of(SOLUTION_MOST_Q16));
    }
}

static T3R_LANES_TARGET void correct(const t3r_refine_sums *sums, uint32_t count, t3r_correction *corrections)
{
    ints words[WORDS], x_q16[PARAMETERS];
    equations e;
    take(sums, count, words);
    normal_equations(words, &e);
    solve(&e, x_q16);
    for (uint32_t i = 0; i < count; i++) {
        if (sums[i].weight <= 0) {
            corrections[i] = (t3r_correction){{0}, {0}, 0};
            continue;
        }
        t3r_solution solution;
        for (int k = 0; k < PARAMETERS; k++) {
            solution.diagonal[k] = e.a[k][k][i];
            solution.x_q16[k] = x_q16[k][i];
        }
        corrections[i] = t3r_correction_of(&sums[i], &solution, &corrections[i]);
    }
}

T3R_LANES_TARGET void SOLVE(const t3r_refine_sums *sums, uint32_t count, t3r_correction *corrections)
{
    for (uint32_t i = 0; i < count; i += LANES) {
        correct(sums + i, T3R_MIN(count - i, LANES), corrections + i);
    }
}

#endif
