/* SPDX-License-Identifier: Apache-2.0 */
/* Steps of rendering and refinement before a view's tiles are drawn: projection, depth order and counts by tile. */
#ifndef T3R_RASTER_LIST_H
#define T3R_RASTER_LIST_H

#include "raster_tile.h"

/* Working memory for one view: room for max_gaussians splats and their order, one table entry per tile, and lists. */
typedef struct t3r_raster_room {
    t3r_splat *splats;
    uint32_t *order; /* histogram, then two key and two index buffers of max_gaussians each */
    uint32_t *table;
    uint32_t *lists;
    uint64_t capacity; /* entries of lists, at least max_gaussians */
} t3r_raster_room;

/* Every pixel of a view. */
extern const t3r_lattice t3r_all_pixels;

/* Projects the scene (through the parallel hook), orders the splats and counts them into the tiles of the lattice's
 * picture. The splat of a culled Gaussian has z_q20 = 0. t3r_bin_pass() fills the lists next. */
t3r_binning t3r_raster_list(const t3r_runtime *rt, const t3r_projection *projection, const t3r_lattice *lattice,
                            const t3r_raster_room *room);

/* Draws all tiles of the binning into the target (through the parallel hook) and reports progress. *passes is the
 * number of passes taken. T3R_ERR_CANCELLED leaves the target partly drawn. */
t3r_status t3r_raster_tiles(const t3r_runtime *rt, const t3r_binning *bin, const t3r_target *target, uint32_t *passes);

/* Returns the T3R_SORT_BYTES of the histogram, which are unused once the view is listed. */
static inline void *t3r_raster_spare_histogram(const t3r_raster_room *room)
{
    return room->order;
}

/* Returns the memory of the keys, which is unused once the view is listed: T3R_RASTER_SPARE_BYTES for each of
 * max_gaussians. */
#define T3R_RASTER_SPARE_BYTES 8
static inline void *t3r_raster_spare(const t3r_raster_room *room)
{
    return room->order + T3R_SORT_BYTES / sizeof *room->order;
}

#endif
