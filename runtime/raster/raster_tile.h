/* Tiles: which splats each one lists, and how a tile is drawn from its list. */
#ifndef T3R_RASTER_TILE_H
#define T3R_RASTER_TILE_H

#include <stdbool.h>
#include <stdint.h>

#include "core/workers.h"
#include "kernels/kernels.h"
#include "raster_splat.h"

/* The tiles that a splat's box reaches, inclusive: T3R_MAX_SIDE is 256 tiles. */
typedef struct t3r_tile_span {
    uint8_t x0, y0, x1, y1;
} t3r_tile_span;

static inline t3r_tile_span t3r_span_of(const t3r_splat *splat)
{
    return (t3r_tile_span){(uint8_t)(splat->x0 / T3R_TILE_SIDE), (uint8_t)(splat->y0 / T3R_TILE_SIDE),
                           (uint8_t)(splat->x1 / T3R_TILE_SIDE), (uint8_t)(splat->y1 / T3R_TILE_SIDE)};
}

/* The splats in depth order, and the tiles of the target. */
typedef struct t3r_binning {
    const t3r_kernels *kernels;
    const t3r_splat *splats;
    const uint32_t *order;
    const t3r_tile_span *spans; /* in that order, too */
    uint32_t visible;
    uint32_t across, tiles;
    uint32_t *table; /* an entry a tile: counts, then list ends as passes open */
    uint32_t *lists;
    uint64_t capacity; /* entries of lists; at least `visible` */
    uint32_t most;     /* splats that a tile is drawn from, the first of its list */
} t3r_binning;

/* How many splats of a list that begins at `begin` the tile is drawn from, once its pass is open. */
static inline uint32_t t3r_list_length(const t3r_binning *binning, uint32_t begin, uint32_t tile)
{
    const uint32_t listed = binning->table[tile] - begin;
    return listed < binning->most ? listed : binning->most;
}

/* Counts every tile's splats into the table. */
void t3r_bin_count(const t3r_workers *workers, const t3r_binning *binning);

/* Fills the lists of as many tiles from `first` on as there is room for, at least one; returns the first tile
 * left over. Afterwards table[t] is the end of tile t's list, which starts where tile t - 1's ends (0 for `first`). */
uint32_t t3r_bin_pass(const t3r_workers *workers, const t3r_binning *binning, uint32_t first);

/* A tile on its way into the target. */
typedef struct t3r_drawn_tile {
    t3r_tile pixels;
    uint32_t depth_q20[T3R_TILE_SIDE][T3R_TILE_SIDE];
    uint32_t left, top; /* its first pixel in the target */
    bool stopped;       /* all its pixels are done: whatever is blended now adds nothing */
} t3r_drawn_tile;

/* Draws one tile: begun empty, its list blended front to back in any number of parts, written into the target. Parts
 * but the last are a multiple of T3R_STOP_INTERVAL long. */
void t3r_draw_begin(t3r_drawn_tile *tile, uint32_t tile_x, uint32_t tile_y);
void t3r_draw_list(t3r_drawn_tile *tile, const t3r_kernels *kernels, const t3r_splat *splats, const uint32_t *list,
                   uint32_t count, const t3r_target *target);
void t3r_draw_end(const t3r_drawn_tile *tile, const t3r_target *target);

/* The steps of drawing, for whoever blends a tile along with it. */

/* Every so many splats a tile looks whether all its pixels are done. */
#define T3R_STOP_INTERVAL 16

void t3r_tile_clear(t3r_tile *tile);
bool t3r_tile_stopped(const t3r_tile *tile);

#endif
