/* SPDX-License-Identifier: Apache-2.0 */
/* The innermost loop of refinement: adds the pixels of a tile to the sums of one splat (SPEC.md, "Refinement"). */
#ifndef T3R_KERNEL_SCATTER_H
#define T3R_KERNEL_SCATTER_H

#include <stdint.h>

#include "blend.h"
#include "project.h"

/* Numbers of monomials x^i y^j with i + j <= 2 and with i + j <= 4, in the order 1 x y xx xy yy xxx xxy xyy yyy xxxx
 * ... */
#define T3R_REFINE_MOMENTS_2 6
#define T3R_REFINE_MOMENTS_4 15

/* Index of x^k y^l. */
enum t3r_moment {
    T3R_M_1,
    T3R_M_X,
    T3R_M_Y,
    T3R_M_X2,
    T3R_M_XY,
    T3R_M_Y2,
    T3R_M_X3,
    T3R_M_X2Y,
    T3R_M_XY2,
    T3R_M_Y3,
    T3R_M_X4,
    T3R_M_X3Y,
    T3R_M_X2Y2,
    T3R_M_XY3,
    T3R_M_Y4
};

/* Change of a splat's own coordinates, in deviations, a pixel to the right and down: e = K d, K = T^T S^-1 with the
 * first two columns of T, so that d q = -e . step for a shift by `step` of them. */
typedef struct t3r_splat_axes {
    int16_t right_q15[2], down_q15[2];
} t3r_splat_axes;

/* |K| <= t / (t^2 + 0.3) < 0.913 for each singular value t of T */
#define T3R_AXIS_MOST_Q15 30147

/* Sums over one Gaussian's pixels in all views, shifted right by t3r_refine_shift(area). They are integers, so the
 * order of adding doesn't matter. (x, y) are the splat's own coordinates: a pixel's offset from the mean, in
 * deviations. */
typedef struct t3r_refine_sums {
    int32_t colour[3];                       /* sum of w r, levels, Q11 */
    int32_t weight;                          /* sum of w, Q15 */
    int32_t gradient[T3R_REFINE_MOMENTS_2];  /* sum of (g . r) x^i y^j, levels^2, Q7 */
    int32_t curvature[T3R_REFINE_MOMENTS_4]; /* sum of |g|^2 x^i y^j, levels^2, Q7 */
    uint32_t area;                           /* pixels of the splat's boxes in the views added so far, below 2^28 */
    t3r_splat_axes axes;                     /* of x and y, in this view */
} t3r_refine_sums;

/* Sets the axes in the sums of `count` splats from the Gaussians that they were projected from, all in order. Those of
 * culled splats may become anything. */
typedef void t3r_axes_kernel(const t3r_projection *projection, const t3r_gaussian *gaussians, const t3r_splat *splats,
                             uint32_t count, t3r_refine_sums *sums);
t3r_axes_kernel t3r_axes_c;

/* Returns the right shift of sums over `area` pixels, ceil(log2 area) - 6, at least 0, which bounds them by the sums
 * of 64 pixels. */
static inline uint32_t t3r_refine_shift(uint32_t area)
{
    return area <= 64 ? 0 : 26u - (uint32_t)__builtin_clz(area - 1);
}

/* A tile being refined: first drawn, then unblended from the last splat to the first. */
typedef struct t3r_wanted {
    t3r_tile pixels;                                      /* as drawn; on the way back, colours behind the current
                                                           * splat */
    int16_t residual_q4[3][T3R_TILE_SIDE][T3R_TILE_SIDE]; /* target - drawn, levels: +-4080 */
    uint16_t counts[T3R_TILE_SIDE][T3R_TILE_SIDE];        /* 65,535, or 0 where a pixel doesn't count */
} t3r_wanted;

/* A splat in its tile. Its coordinates are modulo 2^16: they matter only where a weight is not 0, and fit there. */
typedef struct t3r_scatter_splat {
    const t3r_tile_splat *span; /* only colour, columns and rows are read */
    const t3r_blended_row *rows;
    uint32_t scale;        /* leading zeros common to all 16-bit weights of the rows: 0..15 */
    int16_t origin_q13[2]; /* x and y of the first pixel of the first group */
    int16_t right_q13[2], down_q13[2];
    uint32_t pixels; /* of the splat's box in the tile, at most the area of the sums; bounds what it adds */
} t3r_scatter_splat;

/* Removes the splat from the tile: the colours behind it become those behind the previous splat, which are its own
 * mixed over them. sums: where its pixels are added, or NULL. Nothing needs more alignment than its type. */
typedef void t3r_scatter_kernel(t3r_wanted *restrict tile, const t3r_scatter_splat *splat,
                                t3r_refine_sums *restrict sums);
t3r_scatter_kernel t3r_scatter_c;

/* Computes residuals of `count` pixels of a tile's row and channel, at most T3R_TILE_SIDE: of levels 2^spread apart
 * times the gain, less drawn colours. spread: 0 or 1. */
typedef void t3r_compare_row_kernel(const uint8_t *restrict shown, uint32_t spread, uint16_t gain_q14,
                                    const uint16_t *restrict drawn_q7, uint32_t count, int16_t *restrict residual_q4);
t3r_compare_row_kernel t3r_compare_row_c;

#endif
