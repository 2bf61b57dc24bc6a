/* SPDX-License-Identifier: Apache-2.0 */
/* Refinement of one tile of a context view: draws it like the rasterizer and scatters its residuals to the splats. */
#ifndef T3R_REFINE_TILE_H
#define T3R_REFINE_TILE_H

#include <stdbool.h>
#include <stdint.h>

#include "kernels/kernels.h"
#include "raster/raster_tile.h"
#include "refine_bands.h"
#include "structural.h"

/* The view to measure, and the slice of the scene whose sums fit. */
typedef struct t3r_refine_view {
    const t3r_kernels *kernels;
    const t3r_view *view;
    const t3r_splat *splats;
    t3r_refine_slice slice;
    const t3r_refine_borders *borders;
    const t3r_refine_band *bands;
    uint32_t band;       /* index of the band being drawn */
    uint32_t across;     /* tiles a row */
    t3r_lattice lattice; /* the pixels that are compared */
    t3r_wanted *wanted;  /* the tile and its residuals, too large for the stack */
    uint32_t *kept; /* memory for the splats kept while a tile is drawn, at least T3R_KEPT_LEAST words; with more, a
                       full tile is drawn again less often */
    uint32_t kept_words;
    const uint16_t *gain_q14;       /* of r, g, b: they level the view first */
    const uint16_t *remembered;     /* pixels of a remembered keyframe, which has no planes; NULL: a live view */
    const t3r_structure *structure; /* of the view; NULL: residuals count unchanged */
    /* Called before `splats` splats of a tile are drawn again; false ends the tile. */
    bool (*goes_on)(void *context, uint32_t splats);
    void *context;
} t3r_refine_view;

/* Words for one splat: its entry and its rows. */
#define T3R_KEPT_LEAST (1 + T3R_BLENDED_ROWS_MOST * (uint32_t)(sizeof(t3r_blended_row) / sizeof(uint32_t)))

/* Adds the tile's residuals to the sums of the slice's Gaussians. Pixels without depth don't count. */
void t3r_refine_tile(const t3r_refine_view *job, const uint32_t *list, uint32_t count, uint32_t tile_x,
                     uint32_t tile_y);

/* Draws the tile without accumulating and returns the sum of its squared residuals over three channels, Q8, below 2^34.
 * Adds the number of pixels that count (those with depth) to *pixels. Reads only kernels, view, splats, wanted and
 * gain_q14 of the job. */
uint64_t t3r_refine_tile_error(const t3r_refine_view *job, const uint32_t *list, uint32_t count, uint32_t tile_x,
                               uint32_t tile_y, uint32_t *pixels);

/* Draws the tile like t3r_refine_tile_error() and adds it to the sums of the view's levels, relative to the current
 * job->structure levels. */
void t3r_refine_tile_levels(const t3r_refine_view *job, const uint32_t *list, uint32_t count, uint32_t tile_x,
                            uint32_t tile_y, t3r_level_sums *sums);

#endif
