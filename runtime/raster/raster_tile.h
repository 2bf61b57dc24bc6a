/* Tiles: which splats each one lists, and how a tile is drawn from its list. */
#ifndef T3R_RASTER_TILE_H
#define T3R_RASTER_TILE_H

#include <stdbool.h>
#include <stdint.h>

#include "kernels/blend.h"
#include "raster_splat.h"

/* The splats in depth order, and the tiles of the target. */
typedef struct t3r_binning {
    const t3r_splat *splats;
    const uint32_t *order;
    uint32_t visible;
    uint32_t across, tiles;
    uint32_t *table; /* an entry a tile: counts, then list ends as passes open */
    uint32_t *lists;
    uint64_t capacity; /* entries of lists; at least `visible` */
} t3r_binning;

/* Counts every tile's splats into the table. */
void t3r_bin_count(const t3r_binning *binning);

/* Fills the lists of as many tiles from `first` on as there is room for, at least one; returns the first tile
 * left over. Afterwards table[t] is the end of tile t's list, which starts where tile t - 1's ends (0 for `first`). */
uint32_t t3r_bin_pass(const t3r_binning *binning, uint32_t first);

/* Draws one tile from its list (front to back) into the target. */
void t3r_draw_tile(const t3r_splat *splats, const uint32_t *list, uint32_t count, uint32_t tile_x, uint32_t tile_y,
                   const t3r_target *target);

/* The steps of t3r_draw_tile(), for whoever blends a tile along with it. */

/* Every so many splats a tile looks whether all its pixels are done. */
#define T3R_STOP_INTERVAL 16

/* Where a splat is blended in a tile that it overlaps: eight columns at a time, wherever they lie when its box is no
 * wider, else each half of the tile; rows first..last. */
typedef struct t3r_tile_blocks {
    uint32_t count, column; /* of the first block; the next is T3R_LANES further */
    uint32_t first, last;
} t3r_tile_blocks;

void t3r_tile_clear(t3r_tile *tile);
bool t3r_tile_stopped(const t3r_tile *tile);
t3r_tile_blocks t3r_blocks_of(const t3r_splat *splat, uint32_t left, uint32_t top);

/* The splat in the coordinates of eight columns of the tile at (left, top); false when it draws nothing on them. */
bool t3r_tile_lane(const t3r_splat *splat, uint32_t left, uint32_t top, uint32_t column, t3r_lane_splat *lane);

#endif
