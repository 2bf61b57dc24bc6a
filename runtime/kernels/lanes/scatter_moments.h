/* SPDX-License-Identifier: Apache-2.0 */
/* The sums of scatter.c from factors of several pixels each. Included after the type `factor` and after the functions
 * that add to a sum, modulo 2^32: `added` the products of two factors' pixels, `added_alone` the pixels of one. */
#ifndef T3R_KERNELS_LANES_SCATTER_MOMENTS_H
#define T3R_KERNELS_LANES_SCATTER_MOMENTS_H

#include <stdbool.h>

#include "kernels/scatter.h"

typedef struct factors {
    factor product, square, x, y, xx, xy, yy;
    factor square_x, square_y, square_xx, square_xy, square_yy;
} factors;

/* Adds the orders 0 to 2 of squares, or of products. */
static inline __attribute__((always_inline)) void add_low(const factors *f, uint32_t count, bool of_squares,
                                                          uint32_t sums[T3R_REFINE_MOMENTS_2])
{
    uint32_t s0 = sums[T3R_M_1], s1 = sums[T3R_M_X], s2 = sums[T3R_M_Y];
    uint32_t s3 = sums[T3R_M_X2], s4 = sums[T3R_M_XY], s5 = sums[T3R_M_Y2];
    for (const factors *end = f + count; f != end; f++) {
        const factor term = of_squares ? f->square : f->product;
        s0 = added_alone(s0, term);
        s1 = added(s1, term, f->x);
        s2 = added(s2, term, f->y);
        s3 = added(s3, term, f->xx);
        s4 = added(s4, term, f->xy);
        s5 = added(s5, term, f->yy);
    }
    sums[T3R_M_1] = s0, sums[T3R_M_X] = s1, sums[T3R_M_Y] = s2;
    sums[T3R_M_X2] = s3, sums[T3R_M_XY] = s4, sums[T3R_M_Y2] = s5;
}

static void add_order_3(const factors *f, uint32_t count, uint32_t sums[T3R_REFINE_MOMENTS_4])
{
    uint32_t s0 = sums[T3R_M_X3], s1 = sums[T3R_M_X2Y], s2 = sums[T3R_M_XY2], s3 = sums[T3R_M_Y3];
    for (const factors *end = f + count; f != end; f++) {
        s0 = added(s0, f->square_x, f->xx);
        s1 = added(s1, f->square_x, f->xy);
        s2 = added(s2, f->square_x, f->yy);
        s3 = added(s3, f->square_y, f->yy);
    }
    sums[T3R_M_X3] = s0, sums[T3R_M_X2Y] = s1, sums[T3R_M_XY2] = s2, sums[T3R_M_Y3] = s3;
}

static void add_order_4(const factors *f, uint32_t count, uint32_t sums[T3R_REFINE_MOMENTS_4])
{
    uint32_t s0 = sums[T3R_M_X4], s1 = sums[T3R_M_X3Y], s2 = sums[T3R_M_X2Y2], s3 = sums[T3R_M_XY3];
    uint32_t s4 = sums[T3R_M_Y4];
    for (const factors *end = f + count; f != end; f++) {
        s0 = added(s0, f->square_xx, f->xx);
        s1 = added(s1, f->square_xx, f->xy);
        s2 = added(s2, f->square_xx, f->yy);
        s3 = added(s3, f->square_xy, f->yy);
        s4 = added(s4, f->square_yy, f->yy);
    }
    sums[T3R_M_X4] = s0, sums[T3R_M_X3Y] = s1, sums[T3R_M_X2Y2] = s2, sums[T3R_M_XY3] = s3, sums[T3R_M_Y4] = s4;
}

/* Adds factors to the sums of gradient and curvature. */
static inline void add_factors(const factors *f, uint32_t count, uint32_t gradient[T3R_REFINE_MOMENTS_2],
                               uint32_t curvature[T3R_REFINE_MOMENTS_4])
{
    add_low(f, count, false, gradient);
    add_low(f, count, true, curvature);
    add_order_3(f, count, curvature);
    add_order_4(f, count, curvature);
}

#endif
