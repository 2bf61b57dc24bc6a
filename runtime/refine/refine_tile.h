/* One tile of a context view: drawn as the rasterizer draws it, its residuals scattered to the splats. */
#ifndef T3R_REFINE_TILE_H
#define T3R_REFINE_TILE_H

#include <stdbool.h>
#include <stdint.h>

#include "kernels/kernels.h"
#include "raster/raster_tile.h"
#include "refine_bands.h"
#include "structural.h"

/* A view to measure, and the slice of the scene whose sums there is room for. */
typedef struct t3r_refine_view {
    const t3r_kernels *kernels;
    const t3r_view *view;
    const t3r_splat *splats;
    t3r_refine_slice slice;
    const t3r_refine_borders *borders;
    const t3r_refine_band *bands;
    uint32_t band;      /* number of the band that is drawn */
    uint32_t across;    /* tiles a row */
    t3r_wanted *wanted; /* where the tile and what it lacks are held: too large for the stack */
    uint32_t *kept;     /* room for what is kept of the splats of a tile while it is drawn: T3R_KEPT_LEAST words or
                           more; the more there is, the less often a full tile is drawn again */
    uint32_t kept_words;
    const uint16_t *gain_q14;       /* of the view's three channels: what it shows is levelled first */
    const uint16_t *remembered;     /* the pixels of a remembered keyframe, which has no planes; NULL: it is a view's */
    const t3r_structure *structure; /* of the view, or NULL: what it lacks counts as it is */
    /* Asked before so many splats of a tile are drawn again; false ends the tile. */
    bool (*goes_on)(void *context, uint32_t splats);
    void *context;
} t3r_refine_view;

/* A splat's place in the list and its rows. */
#define T3R_KEPT_LEAST (1 + T3R_BLENDED_ROWS_MOST * (uint32_t)(sizeof(t3r_blended_row) / sizeof(uint32_t)))

/* Accumulates what the tile's pixels lack into the sums of the slice's Gaussians. Pixels without depth count for
 * nothing. */
void t3r_refine_tile(const t3r_refine_view *job, const uint32_t *list, uint32_t count, uint32_t tile_x,
                     uint32_t tile_y);

/* Draws the tile and accumulates nothing: its squared residuals, three channels, Q8, below 2^34; adds the pixels that
 * have depth, and so count, to *pixels. Of the job only kernels, view, splats, wanted and gain_q14
 * are read. */
uint64_t t3r_refine_tile_error(const t3r_refine_view *job, const uint32_t *list, uint32_t count, uint32_t tile_x,
                               uint32_t tile_y, uint32_t *pixels);

/* The same, and adds the tile to the sums of the view's levels, over those of job->structure as they are. */
void t3r_refine_tile_levels(const t3r_refine_view *job, const uint32_t *list, uint32_t count, uint32_t tile_x,
                            uint32_t tile_y, t3r_level_sums *sums);

#endif
