/* SPDX-License-Identifier: Apache-2.0 */
/* Tiles: the splats that a tile lists, and drawing a tile from its list. */
#ifndef T3R_RASTER_TILE_H
#define T3R_RASTER_TILE_H

#include <stdbool.h>
#include <stdint.h>

#include "core/workers.h"
#include "kernels/kernels.h"
#include "raster_splat.h"
#include "splat_surface.h"

/* The tiles that a splat's box touches, bounds inclusive. A byte is enough: T3R_MAX_SIDE is 256 tiles. */
typedef struct t3r_tile_span {
    uint8_t x0, y0, x1, y1;
} t3r_tile_span;

static inline t3r_tile_span t3r_span_of(const t3r_splat *splat)
{
    return (t3r_tile_span){(uint8_t)(splat->x0 / T3R_TILE_SIDE), (uint8_t)(splat->y0 / T3R_TILE_SIDE),
                           (uint8_t)(splat->x1 / T3R_TILE_SIDE), (uint8_t)(splat->y1 / T3R_TILE_SIDE)};
}

/* The splats in depth order and the tiles of the target. */
typedef struct t3r_binning {
    const t3r_kernels *kernels;
    const t3r_projection *projection; /* of the splats, from the Gaussians at their indices: for depth alone */
    const t3r_gaussian *gaussians;
    const t3r_splat *splats;
    const uint32_t *order;
    const t3r_tile_span *spans; /* in the same order */
    uint32_t visible;
    uint32_t across, tiles;
    uint32_t *table; /* one entry per tile: its count, then the end of its list once a pass opens it */
    uint32_t *lists;
    uint64_t capacity; /* entries of lists, at least `visible` */
    uint32_t most;     /* maximum number of splats drawn per tile, from the start of its list */
} t3r_binning;

/* Returns the number of splats of the tile's list, which begins at `begin`, that are drawn. The tile's pass must be
 * open. */
static inline uint32_t t3r_list_length(const t3r_binning *binning, uint32_t begin, uint32_t tile)
{
    const uint32_t listed = binning->table[tile] - begin;
    return listed < binning->most ? listed : binning->most;
}

/* Counts every tile's splats into the table. */
void t3r_bin_count(const t3r_workers *workers, const t3r_binning *binning);

/* Fills the lists of all tiles from `first` on that fit, at least one. Returns the first remaining tile. Then table[t]
 * is the end of tile t's list, which starts where tile t - 1's ends (0 for `first`). */
uint32_t t3r_bin_pass(const t3r_workers *workers, const t3r_binning *binning, uint32_t first);

/* A tile while it is drawn. */
typedef struct t3r_drawn_tile {
    t3r_tile pixels;
    uint32_t depth_q20[T3R_TILE_SIDE][T3R_TILE_SIDE];
    t3r_tile_place place; /* its first pixel in the target */
    bool noted;           /* all its pixels have a depth, if depth is drawn */
    bool stopped;         /* further splats add nothing to what is drawn */
} t3r_drawn_tile;

/* Draw one tile: t3r_draw_begin() clears it, t3r_draw_list() blends its list front to back in any number of parts,
 * t3r_draw_end() writes it into the target. All parts but the last have a multiple of T3R_STOP_INTERVAL splats. */
void t3r_draw_begin(t3r_drawn_tile *tile, uint32_t tile_x, uint32_t tile_y);
void t3r_draw_list(t3r_drawn_tile *tile, const t3r_binning *bin, const uint32_t *list, uint32_t count,
                   const t3r_target *target);
void t3r_draw_end(const t3r_drawn_tile *tile, const t3r_target *target);

/* Steps of drawing, for callers that do more with a tile than writing it into a target. */

/* Splats between two checks of whether further ones add nothing. */
#define T3R_STOP_INTERVAL 16

void t3r_tile_clear(t3r_tile *tile);
/* Whether the transmittance of all pixels is below this one. */
bool t3r_tile_is_below(const t3r_tile *tile, uint16_t transmittance_q16);

#endif
