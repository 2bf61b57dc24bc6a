/* The innermost loop of the rasterizer: one splat over eight columns of a tile (SPEC.md, "Raster: blending"). */
#ifndef T3R_KERNEL_BLEND_H
#define T3R_KERNEL_BLEND_H

#include <stdint.h>

#include "trim3r_arena.h"

#define T3R_LANES 8

/* A tile's pixels, row by row. Transmittance starts at T3R_ONE_Q16.
 *
 * Why 16 bits are enough for colour: a contribution needs a weight w >= 1 (Q16), which transmittance loses, so there
 * are at most 65,535; their weighted colours sum to at most 32,640 (Q7) and their roundings to half a step each,
 * 32,768. */
typedef struct t3r_tile {
    uint16_t transmittance_q16[T3R_TILE_SIDE][T3R_TILE_SIDE];
    uint16_t colour_q7[3][T3R_TILE_SIDE][T3R_TILE_SIDE];
} t3r_tile;

#define T3R_ONE_Q16 65535
#define T3R_HALF_Q16 32768
#define T3R_ALPHA_MOST_Q16 64881 /* 0.99 */
#define T3R_ALPHA_LEAST_Q16 257  /* 1/255 */
#define T3R_STOP_Q16 7           /* below 1e-4 a pixel takes no more: 6.55 rounded up */

/* A splat in the coordinates of eight columns, (0, 0) their topmost left pixel in the tile: q(i, j) = q + i gx + j gy +
 * i^2 a + i j b + j^2 c, Q17. */
typedef struct t3r_lane_splat {
    int32_t q, gx, gy, a, b, c;
    uint16_t opacity_q16;
    uint16_t colour_q7[3];
} t3r_lane_splat;

/* Alpha in Q16 of one pixel: opacity x exp(-q), at most 0.99, 0 where below 1/255. Exposed for tests. */
uint16_t t3r_alpha_q16(int32_t q_q17, uint16_t opacity_q16);

/* Blends a splat behind what the tile holds, over the columns column..column + 7 and the rows first..last. */
void t3r_blend_rows(t3r_tile *tile, const t3r_lane_splat *splat, uint32_t column, uint32_t first, uint32_t last);

#endif
