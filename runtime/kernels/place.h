/* SPDX-License-Identifier: Apache-2.0 */
/* Splats in the coordinates of a tile, for blending (SPEC.md, "Raster: blending"). */
#ifndef T3R_KERNEL_PLACE_H
#define T3R_KERNEL_PLACE_H

#include <stdint.h>

#include "blend.h"
#include "project.h"

/* The room for placed splats is a multiple of this; entries after the last may hold anything. */
#define T3R_PLACED 8

/* Places the splats of the first `count` >= 1 entries of a list, all of which overlap the tile at (left, top): on any
 * eight columns if the splat's box is no wider there, else on both halves of the tile. A half on which it draws
 * nothing is not marked as drawn. The second group of a splat with one group may hold anything. */
typedef void t3r_place_kernel(const t3r_splat *splats, const uint32_t *list, uint32_t count, uint32_t left,
                              uint32_t top, t3r_tile_splat *placed);
t3r_place_kernel t3r_place_c;

/* Places one splat. */
void t3r_place(const t3r_splat *splat, uint32_t left, uint32_t top, t3r_tile_splat *placed);

/* Sets only columns, rows, box and colour, which are all that scattering reads. */
void t3r_splat_span(const t3r_splat *splat, uint32_t left, uint32_t top, t3r_tile_splat *placed);

/* A splat whose centre is at most this far from a tile needs no test against its columns: within 24 + 16 px of the
 * centre, along both axes, the quadratic is below 5,400 and its partial sums below 10,300 (a, c <= 1 / 0.6), and Q17
 * holds 16,383. */
#define T3R_SMALL_SPLAT 24

#endif
