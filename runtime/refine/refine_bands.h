/* SPDX-License-Identifier: Apache-2.0 */
/* Cuts the tiles of a view into bands for workers.
 *
 * A band is a run of consecutive tiles that one task draws. A Gaussian may lie in several bands, and two tasks must not
 * add to the same sums. So the first band that a Gaussian lies in adds to the Gaussian's own sums. Each later band adds
 * to border sums, which it keeps for the Gaussians that reach in from an earlier band. When all bands are done, border
 * sums are added to the own sums. Sums are integers, so the number and order of bands don't change the result. */
#ifndef T3R_REFINE_BANDS_H
#define T3R_REFINE_BANDS_H

#include <stdint.h>

#include "core/workers.h"
#include "raster/raster_tile.h"
#include "refine.h"

typedef struct t3r_refine_band {
    uint32_t begin, end; /* tiles */
    uint32_t own_from;   /* Gaussians whose first tile is this one or later use their own sums */
    uint32_t crossing;   /* Gaussians that reach in from an earlier band */
} t3r_refine_band;

/* Border sums: `most` entries for each band but the first. */
typedef struct t3r_refine_borders {
    uint32_t bands, most;
    uint32_t *index; /* the Gaussians that cross, ascending in each band */
    t3r_refine_sums *sums;
} t3r_refine_borders;

typedef struct t3r_refine_slice {
    t3r_refine_sums *sums; /* sums[0] belongs to Gaussian `first` */
    uint32_t first, count;
} t3r_refine_slice;

/* Cuts the tiles begin..end - 1 of an open pass into bands with about the same number of list entries each, at most
 * borders->bands. The list of the first tile starts at `listed`. If more Gaussians of the slice cross a border than
 * fit, there are fewer bands. Clears the border sums in use. Returns the number of bands, at least 1. */
uint32_t t3r_refine_bands(const t3r_binning *bin, uint32_t begin, uint32_t end, uint32_t listed,
                          const t3r_refine_slice *slice, const t3r_refine_borders *borders,
                          t3r_refine_band bands[T3R_MAX_WORKERS]);

/* Returns the sums to which band number `band` adds for Gaussian `index` of the slice. across: tiles a row. */
t3r_refine_sums *t3r_refine_sums_in(const t3r_refine_band *bands, uint32_t band, const t3r_refine_borders *borders,
                                    const t3r_refine_slice *slice, const t3r_splat *splat, uint32_t index,
                                    uint32_t across);

/* Adds the border sums of all bands to the Gaussians' own sums. */
void t3r_refine_join(const t3r_refine_band *bands, uint32_t count, const t3r_refine_borders *borders,
                     const t3r_refine_slice *slice);

#endif
