/* SPDX-License-Identifier: Apache-2.0 */
/* The innermost loop of the rasterizer: blends one splat over its rows of a tile, eight columns at a time (SPEC.md,
 * "Raster: blending"). */
#ifndef T3R_KERNEL_BLEND_H
#define T3R_KERNEL_BLEND_H

#include <stdint.h>

#include "trim3r_arena.h"

#define T3R_LANES 8 /* columns in a group */
#define T3R_TILE_GROUPS (T3R_TILE_SIDE / T3R_LANES)

/* A tile's pixels, row by row. Transmittance starts at T3R_ONE_Q16.
 *
 * Why 16 bits are enough for colour: a contribution needs a weight w >= 1 (Q16), which is taken from transmittance, so
 * there are at most 65,535; their weighted colours sum to at most 32,640 (Q7) and their roundings to half a step each,
 * 32,768. */
typedef struct t3r_tile {
    uint16_t transmittance_q16[T3R_TILE_SIDE][T3R_TILE_SIDE];
    uint16_t colour_q7[3][T3R_TILE_SIDE][T3R_TILE_SIDE];
} t3r_tile;

#define T3R_ONE_Q16 65535
#define T3R_HALF_Q16 32768
#define T3R_ALPHA_MOST_Q16 64881 /* 0.99 */
#define T3R_ALPHA_LEAST_Q16 257  /* 1/255 */
#define T3R_STOP_Q16 7           /* below 1e-4 a pixel is opaque: 6.55 rounded up */

/* A splat in a tile. Its quadratic from the top left pixel (0, 0) of eight columns is q(i, j) = q + i gx + j gy + i^2 a
 * + i j b + j^2 c, Q17; a, b and c are the same in both groups of columns. */
typedef struct t3r_tile_splat {
    struct {
        int32_t q, gx, gy;
    } group[T3R_TILE_GROUPS];
    int32_t a, b, c;
    uint16_t opacity_q16;
    uint16_t colour_q7[3];
    uint8_t column;      /* of the first group: 0..8; 0 with two groups */
    uint8_t groups;      /* 1, or 2 adjacent groups of eight columns */
    uint8_t drawn;       /* bit g: group g is drawn; other groups are skipped */
    uint8_t first, last; /* rows */
    uint8_t x0, x1;      /* columns of the splat's box in the tile, inclusive, for refinement */
} t3r_tile_splat;

/* A blended splat's part in eight columns of a row: weights w, which transmittance lost, and alphas, rounded down to
 * 15 bits and 0 where w is 0. A splat in a tile has the rows first..last of its first group, then those of its second.
 */
typedef struct t3r_blended_row {
    uint16_t weight_q16[T3R_LANES];
    int16_t alpha_q15[T3R_LANES];
} t3r_blended_row;

#define T3R_BLENDED_ROWS_MOST (T3R_TILE_GROUPS * T3R_TILE_SIDE) /* of a splat in a tile */

/* Returns the rows of a splat in a tile, over all its groups. */
static inline uint32_t t3r_rows_of(const t3r_tile_splat *splat)
{
    return splat->groups * (splat->last - splat->first + 1u);
}

/* Blends a splat behind the tile's earlier ones. Nothing needs more alignment than its type. */
typedef void t3r_blend_kernel(t3r_tile *tile, const t3r_tile_splat *splat);

/* Blends like t3r_blend_kernel and stores t3r_rows_of() blended rows, 0 where a group is not drawn. Returns the
 * bitwise or of the weights: 0 if the splat draws nothing. */
typedef uint16_t t3r_blend_keep_kernel(t3r_tile *restrict tile, const t3r_tile_splat *splat,
                                       t3r_blended_row *restrict rows);

t3r_blend_kernel t3r_blend_c;
t3r_blend_keep_kernel t3r_blend_keep_c;

/* Returns the alpha of one pixel in Q16: opacity x exp(-q), at most 0.99, 0 where below 1/255. Exposed for tests. */
uint16_t t3r_alpha_q16(int32_t q_q17, uint16_t opacity_q16);

#endif
