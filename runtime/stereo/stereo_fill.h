/* Depth for what stereo could not match: that of the surroundings (SPEC.md, "Stereo: filling"). */
#ifndef T3R_STEREO_FILL_H
#define T3R_STEREO_FILL_H

#include <stddef.h>

#include "state/views.h"

/* Cells a view's longer side is cut into, for the slopes of surfaces */
#define T3R_STEREO_FILL_CELLS 8u
#define T3R_STEREO_FILL_SUMS_BYTES 72 /* of a cell; stereo_fill.c asserts it */

/* Bytes of work, aligned to 64: sums of cells; planes of sources, costs and luma. Less than what matching takes. */
#define T3R_STEREO_FILL_CELLS_BYTES ((size_t)T3R_STEREO_FILL_CELLS * T3R_STEREO_FILL_CELLS * T3R_STEREO_FILL_SUMS_BYTES)
#define T3R_STEREO_FILL_BYTES(width, height)                                                                           \
    (T3R_UP_(T3R_STEREO_FILL_CELLS_BYTES) + T3R_UP_(T3R_PIXELS_(width, height) * 4) +                                  \
     T3R_UP_(T3R_PIXELS_(width, height) * 2) + T3R_UP_(T3R_PIXELS_(width, height)))

/* Fills each pixel that is not empty and has no depth, with match confidence T3R_STEREO_FILLED. It takes the depth of
 * the nearest pixel that has one, continued along the plane of the depths about that pixel. Steps of luma count as
 * length of the path there. In a view without any depth nothing is filled. */
void t3r_stereo_fill(const t3r_view *view, void *work);

/* The luma of a view's pixels (SPEC.md, "Wavelet"). */
void t3r_stereo_luma(const t3r_view *view, uint8_t *luma);

#endif
