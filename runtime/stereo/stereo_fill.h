/* SPDX-License-Identifier: Apache-2.0 */
/* Fills pixels that stereo could not match with the depth of the surroundings (SPEC.md, "Stereo: filling"). */
#ifndef T3R_STEREO_FILL_H
#define T3R_STEREO_FILL_H

#include <stddef.h>

#include "state/views.h"

/* Cells along a view's longer side, for the slopes of surfaces. */
#define T3R_STEREO_FILL_CELLS 8u
#define T3R_STEREO_FILL_SUMS_BYTES 72 /* a cell; stereo_fill.c asserts it */

/* Bytes of work, aligned to 64: lengths of paths; sums of cells; planes of sources and luma. */
#define T3R_STEREO_FILL_CELLS_BYTES ((size_t)T3R_STEREO_FILL_CELLS * T3R_STEREO_FILL_CELLS * T3R_STEREO_FILL_SUMS_BYTES)
#define T3R_STEREO_FILL_LENGTHS_BYTES(width, height) T3R_UP_(T3R_PIXELS_(width, height) * 2)
#define T3R_STEREO_FILL_BYTES(width, height)                                                                           \
    (T3R_STEREO_FILL_LENGTHS_BYTES(width, height) + T3R_UP_(T3R_STEREO_FILL_CELLS_BYTES) +                             \
     T3R_UP_(T3R_PIXELS_(width, height) * 4) + T3R_UP_(T3R_PIXELS_(width, height)))

/* Fills each pixel that shows something and has no depth, with match confidence T3R_STEREO_FILLED. It takes the depth
 * of the nearest pixel that has one, continued along the plane of the depths around that pixel. Steps of luma add to
 * the length of the path. A view without any depth doesn't change. Returns each pixel's length of the path to its
 * source, in the first T3R_STEREO_FILL_LENGTHS_BYTES of the work: 5 a straight step, UINT16_MAX where there is no path.
 */
const uint16_t *t3r_stereo_fill(const t3r_view *view, void *work);

/* Computes the luma of a view's pixels (SPEC.md, "Wavelet"). */
void t3r_stereo_luma(const t3r_view *view, uint8_t *luma);

#endif
