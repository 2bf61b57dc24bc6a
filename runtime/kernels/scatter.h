/* The innermost loop of refinement: what the pixels of a tile add to the sums of one splat (SPEC.md, "Refinement"). */
#ifndef T3R_KERNEL_SCATTER_H
#define T3R_KERNEL_SCATTER_H

#include <stdbool.h>
#include <stdint.h>

#include "blend.h"

/* Monomials e_x^i e_y^j with i + j <= 2, and with i + j <= 4, in the order 1 x y xx xy yy xxx xxy xyy yyy xxxx ... */
#define T3R_REFINE_MOMENTS_2 6
#define T3R_REFINE_MOMENTS_4 15

/* Where x^k y^l stands. */
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

/* A tile as it is when all splats are drawn, and what the view shows beyond it. */
typedef struct t3r_wanted {
    t3r_tile drawn;
    int16_t residual_q4[3][T3R_TILE_SIDE][T3R_TILE_SIDE]; /* target - drawn, levels: +-4080 */
    uint16_t counts[T3R_TILE_SIDE][T3R_TILE_SIDE];        /* 65,535, or 0 where a pixel has no depth */
} t3r_wanted;

/* Exact sums over one splat's pixels in one tile, in the order of T3R_REFINE_MOMENTS_4. x^k y^l stands for the weight
 * C(p + k, k) C(s + l, l). p and s count what comes after the pixel: columns to the end of the splat's groups, and rows
 * to `last`. */
typedef struct t3r_tile_sums {
    int64_t gradient[T3R_REFINE_MOMENTS_2];  /* levels^2, Q3 */
    int64_t curvature[T3R_REFINE_MOMENTS_4]; /* levels^2, Q2 */
    int64_t colour[3];                       /* levels, Q19 */
    int64_t weight;                          /* Q15 */
    uint32_t scale;                          /* all of them times 2^scale, curvature 2^(2 scale) */
    uint32_t last;                           /* of the rows, the last with a weight that counts */
} t3r_tile_sums;

/* The sums of a splat just blended, whose weights these are. A weight counts in the splat's box and where the pixel
 * does. The scale is the most by which all weights that count stay below 2^16. tile: as it is after the splat. False:
 * no weight counts, and the sums may hold anything. */
typedef bool t3r_scatter_kernel(const t3r_wanted *want, const t3r_tile *tile, const t3r_tile_splat *splat,
                                const t3r_blend_weights *weights, t3r_tile_sums *sums);
t3r_scatter_kernel t3r_scatter_c;

#endif
