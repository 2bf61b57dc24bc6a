/* SPDX-License-Identifier: Apache-2.0 */
/* Splats in the coordinates of a tile, for blending (SPEC.md, "Raster: blending"). */
#ifndef T3R_KERNEL_PLACE_H
#define T3R_KERNEL_PLACE_H

#include <stdint.h>

#include "blend.h"
#include "project.h"

/* The room for placed splats is a multiple of this; entries after the last may hold anything. */
#define T3R_PLACED 8

/* A tile: its first pixel in its picture, whose pixels are 2^spread pixels of the camera apart, spread 0 or 1. */
typedef struct t3r_tile_place {
    uint32_t left, top, spread;
    int32_t left_q12, top_q12; /* the same pixel, in pixels of the camera */
} t3r_tile_place;

static inline t3r_tile_place t3r_tile_place_of(uint32_t left, uint32_t top, uint32_t spread)
{
    return (t3r_tile_place){left, top, spread, (int32_t)(left << (12 + spread)), (int32_t)(top << (12 + spread))};
}

/* Returns the distance of a splat's centre from a tile up to which it needs no test against the tile's columns: at most
 * 39 px from the centre, along both axes, the quadratic is below 5,400 and its partial sums below 10,300 (a, c <=
 * 1 / 0.6), and Q17 holds 16,383. */
#define T3R_NEAR_MOST_Q12 (39 << 12)
static inline int32_t t3r_near_q12(uint32_t spread)
{
    return T3R_NEAR_MOST_Q12 - (int32_t)((T3R_TILE_SIDE - 1) << (12 + spread));
}

/* Places the splats of the first `count` >= 1 entries of a list, all of which overlap the tile: on any eight columns if
 * the splat's box is no wider there, else on both halves of the tile. A half on which it draws nothing is not marked as
 * drawn. The second group of a splat with one group may hold anything. Boxes are in pixels of the picture, centres and
 * conics in those of the camera. */
typedef void t3r_place_kernel(const t3r_splat *splats, const uint32_t *list, uint32_t count, const t3r_tile_place *tile,
                              t3r_tile_splat *placed);
t3r_place_kernel t3r_place_c;

/* Places one splat. */
void t3r_place(const t3r_splat *splat, const t3r_tile_place *tile, t3r_tile_splat *placed);

/* Sets only columns, rows, box and colour, which are all that scattering reads. */
void t3r_splat_span(const t3r_splat *splat, uint32_t left, uint32_t top, t3r_tile_splat *placed);

#endif
