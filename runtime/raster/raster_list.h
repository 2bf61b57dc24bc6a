/* Everything of a view that comes before its tiles: projection, depth order, counts. Rendering and refinement share it.
 */
#ifndef T3R_RASTER_LIST_H
#define T3R_RASTER_LIST_H

#include "raster_tile.h"

/* Where a view is listed: room for max_gaussians splats and their order, a table entry a tile, lists. */
typedef struct t3r_raster_room {
    t3r_splat *splats;
    uint32_t *order; /* histogram, then max_gaussians each of keys, keys, indices, indices */
    uint32_t *table;
    uint32_t *lists;
    uint64_t capacity; /* entries of lists; at least max_gaussians */
} t3r_raster_room;

/* Projects the scene (through the parallel hook), orders it and counts it into tiles; a culled Gaussian's splat has
 * z_q20 = 0. t3r_bin_pass() goes on from there. */
t3r_binning t3r_raster_list(const t3r_runtime *rt, const t3r_projection *projection, const t3r_raster_room *room);

/* Draws all tiles of the binning into the target (through the parallel hook), reporting progress; *passes: how many it
 * took. T3R_ERR_CANCELLED leaves the target part drawn. */
t3r_status t3r_raster_tiles(const t3r_runtime *rt, const t3r_binning *bin, const t3r_target *target, uint32_t *passes);

/* Where the histogram was: T3R_SORT_BYTES that are of no use to anyone once the view is listed. */
static inline void *t3r_raster_spare_histogram(const t3r_raster_room *room)
{
    return room->order;
}

/* Where the keys were: of no use to anyone once the view is listed, T3R_RASTER_SPARE_BYTES a Gaussian of max_gaussians.
 */
#define T3R_RASTER_SPARE_BYTES 8
static inline void *t3r_raster_spare(const t3r_raster_room *room)
{
    return room->order + T3R_SORT_BYTES / sizeof *room->order;
}

#endif
