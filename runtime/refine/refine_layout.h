/* Where refinement works. */
#ifndef T3R_REFINE_LAYOUT_H
#define T3R_REFINE_LAYOUT_H

#include "raster/raster_list.h"
#include "refine_bands.h"
#include "refine_tile.h"

/* The refinement work, cut up. The first four parts and the least lists always fit; sums take what they can use of the
 * rest, lists what is left. */
typedef struct t3r_refine_layout {
    t3r_raster_room room;
    t3r_correction *corrections; /* of all Gaussians: the pass before's, as far as this one's are not there yet */
    t3r_refine_sums *sums;
    uint32_t slice; /* Gaussians whose sums fit */
    t3r_refine_borders borders;
    t3r_wanted *wanted; /* of each band but the first */
    uint32_t *kept;     /* what bands keep while they draw, of each `kept_words` */
    uint32_t kept_words;
} t3r_refine_layout;

t3r_refine_layout t3r_refine_layout_of(const t3r_runtime *rt);

#endif
