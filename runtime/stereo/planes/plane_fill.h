/* SPDX-License-Identifier: Apache-2.0 */
/* Fills pixels that stereo could not match along the planes of matched pixels (SPEC.md, "Stereo: planes"). */
#ifndef T3R_PLANE_FILL_H
#define T3R_PLANE_FILL_H

#include <stddef.h>

#include "plane_search.h"

/* Bytes of work, aligned to 64; fewer than matching takes. */
#define T3R_PLANE_FILL_BYTES(width, height)                                                                            \
    (T3R_PLANE_SEARCH_BYTES + T3R_UP_(T3R_PIXELS_(width, height) * 2) + 2 * T3R_UP_(T3R_PIXELS_(width, height)))

/* Fills pixels that show something and have no depth, with match confidence T3R_STEREO_FILLED. A pixel takes the plane
 * of the nearest matched pixels; steps of luma, and few pixels on a plane, lengthen the path. Pixels nearest to
 * matches on no plane are left to t3r_stereo_fill(). */
void t3r_plane_fill(const t3r_view *view, void *work);

#endif
