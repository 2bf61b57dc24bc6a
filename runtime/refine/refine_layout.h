/* SPDX-License-Identifier: Apache-2.0 */
/* Layout of the refinement work buffer. */
#ifndef T3R_REFINE_LAYOUT_H
#define T3R_REFINE_LAYOUT_H

#include "raster/raster_list.h"
#include "refine_bands.h"
#include "refine_tile.h"

/* The refinement work buffer, cut up. The first four parts and the smallest lists always fit. Sums take the rest up to
 * their full size, and lists the remainder. */
typedef struct t3r_refine_layout {
    t3r_raster_room room;
    t3r_correction *corrections; /* one per Gaussian; holds the previous pass's until this pass has solved its own */
    t3r_refine_sums *sums;
    uint32_t slice; /* Gaussians whose sums fit */
    t3r_refine_borders borders;
    t3r_wanted *wanted; /* one per band except the first */
    uint32_t *kept;     /* `kept_words` per band for the splats kept while a tile is drawn */
    uint32_t kept_words;
} t3r_refine_layout;

/* Returns the Gaussians whose sums fit into a refinement work buffer of so many bytes, 1..max_gaussians. */
uint32_t t3r_refine_slice_gaussians(const t3r_config *config, size_t bytes);

t3r_refine_layout t3r_refine_layout_of(const t3r_runtime *rt);

#endif
