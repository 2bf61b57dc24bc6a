/* The tiles of a view shared out among workers.
 *
 * A band is a run of consecutive tiles that one task draws. A Gaussian may lie in several bands, and two tasks must not
 * add to the same sums: the first band that it lies in adds to the Gaussian's own sums, every later one to sums of its
 * own, kept for the Gaussians that reach into it across its border. When all bands are done these are added to the own
 * ones. Sums are integers, so neither the number of bands nor their order shows. */
#ifndef T3R_REFINE_BANDS_H
#define T3R_REFINE_BANDS_H

#include <stdint.h>

#include "core/workers.h"
#include "raster/raster_tile.h"
#include "refine.h"

typedef struct t3r_refine_band {
    uint32_t begin, end; /* tiles */
    uint32_t own_from;   /* a Gaussian whose first tile is this one or later adds to its own sums */
    uint32_t crossing;   /* Gaussians that reach in from an earlier band */
} t3r_refine_band;

/* Room for what crosses borders: every band but the first has `most` entries. */
typedef struct t3r_refine_borders {
    uint32_t bands, most;
    uint32_t *index; /* of the Gaussians that cross, ascending in each band */
    t3r_refine_sums *sums;
} t3r_refine_borders;

typedef struct t3r_refine_slice {
    t3r_refine_sums *sums; /* of Gaussian `first` on */
    uint32_t first, count;
} t3r_refine_slice;

/* Cuts the tiles begin..end - 1 of an open pass, the first of whose lists starts at `listed`, into at most
 * borders->bands bands, of about as many list entries each;
 * fewer where more Gaussians of the slice cross a border than there is room for. Clears the sums of those. Returns the
 * number of bands, at least 1. */
uint32_t t3r_refine_bands(const t3r_binning *bin, uint32_t begin, uint32_t end, uint32_t listed,
                          const t3r_refine_slice *slice, const t3r_refine_borders *borders,
                          t3r_refine_band bands[T3R_MAX_WORKERS]);

/* The sums to which band number `band` adds for Gaussian `index` of the slice; `across`: tiles a row. */
t3r_refine_sums *t3r_refine_sums_in(const t3r_refine_band *bands, uint32_t band, const t3r_refine_borders *borders,
                                    const t3r_refine_slice *slice, const t3r_splat *splat, uint32_t index,
                                    uint32_t across);

/* Adds the sums of all bands to the Gaussians' own. */
void t3r_refine_join(const t3r_refine_band *bands, uint32_t count, const t3r_refine_borders *borders,
                     const t3r_refine_slice *slice);

#endif
