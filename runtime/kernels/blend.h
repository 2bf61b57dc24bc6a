/* The innermost loop of the rasterizer: one splat over eight columns of a tile (SPEC.md, "Raster: blending"). */
#ifndef T3R_KERNEL_BLEND_H
#define T3R_KERNEL_BLEND_H

#include <stdint.h>

#include "trim3r_arena.h"

#define T3R_LANES 8

/* A tile's pixels, row by row. Transmittance starts at T3R_ONE_Q15.
 *
 * Why 16 bits are enough for colour: a contribution needs a weight w >= 1 (Q15), which transmittance loses, so
 * there are at most 32,767; their weighted colours sum to at most 32,640 (Q7) and their roundings to 16,384. */
typedef struct t3r_tile {
    int16_t transmittance_q15[T3R_TILE_SIDE][T3R_TILE_SIDE];
    uint16_t colour_q7[3][T3R_TILE_SIDE][T3R_TILE_SIDE];
} t3r_tile;

#define T3R_ONE_Q15 32767
#define T3R_ALPHA_MOST_Q15 32440 /* 0.99 */
#define T3R_ALPHA_LEAST_Q15 129  /* the least at or above 1/255 */
#define T3R_STOP_Q15 4           /* below 1e-4 a pixel takes no more: 3.28 rounded up */

/* A splat in the coordinates of eight columns, (0, 0) their topmost left pixel in the tile: q(i, j) = q + i gx + j gy + i^2 a + i j b + j^2 c, Q17. */
typedef struct t3r_lane_splat {
    int32_t q, gx, gy, a, b, c;
    int16_t opacity_q15;
    int16_t colour_q7[3];
} t3r_lane_splat;

/* exp(-q) for q in Q17, as an opacity-weighted alpha in Q15: 0 where below 1/255. Exposed for tests. */
int16_t t3r_alpha_q15(int32_t q_q17, int16_t opacity_q15);

/* Blends a splat behind what the tile holds, over the columns column..column + 7 and the rows first..last. */
void t3r_blend_rows(t3r_tile *tile, const t3r_lane_splat *splat, uint32_t column, uint32_t first, uint32_t last);

#endif
