/* SPDX-License-Identifier: Apache-2.0 */
/* Fills pixels that stereo could not match with the depth of the surroundings (SPEC.md, "Stereo: filling"). */
#ifndef T3R_STEREO_FILL_H
#define T3R_STEREO_FILL_H

#include <stddef.h>

#include "state/views.h"

/* Cells along a view's longer side, for the slopes of surfaces. */
#define T3R_STEREO_FILL_CELLS 8u
#define T3R_STEREO_FILL_SUMS_BYTES 72 /* a cell; stereo_fill.c asserts it */

/* Bytes of work, aligned to 64: sums of cells; planes of sources, costs and luma. Fewer than matching takes. */
#define T3R_STEREO_FILL_CELLS_BYTES ((size_t)T3R_STEREO_FILL_CELLS * T3R_STEREO_FILL_CELLS * T3R_STEREO_FILL_SUMS_BYTES)
#define T3R_STEREO_FILL_BYTES(width, height)                                                                           \
    (T3R_UP_(T3R_STEREO_FILL_CELLS_BYTES) + T3R_UP_(T3R_PIXELS_(width, height) * 4) +                                  \
     T3R_UP_(T3R_PIXELS_(width, height) * 2) + T3R_UP_(T3R_PIXELS_(width, height)))

/* Fills each pixel that shows something and has no depth, with match confidence T3R_STEREO_FILLED. It takes the depth
 * of the nearest pixel that has one, continued along the plane of the depths around that pixel. Steps of luma add to
 * the length of the path. A view without any depth doesn't change. */
void t3r_stereo_fill(const t3r_view *view, void *work);

/* Computes the luma of a view's pixels (SPEC.md, "Wavelet"). */
void t3r_stereo_luma(const t3r_view *view, uint8_t *luma);

#endif
