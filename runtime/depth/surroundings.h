/* SPDX-License-Identifier: Apache-2.0 */
/* Fills pixels without depth with the depth of their surroundings (SPEC.md, "Stereo: filling"): what stereo could not
 * match, and what neither a sensor nor bridging gave. */
#ifndef T3R_SURROUNDINGS_H
#define T3R_SURROUNDINGS_H

#include <stddef.h>

#include "state/views.h"

/* Gives each pixel that shows something and has no depth the depth of the nearest pixel that has one, continued along
 * the plane of the depths around that pixel, and the source T3R_FILLED or T3R_BRIDGED. Steps of luma add to the length
 * of the path. A view without any depth doesn't change. work: T3R_SURROUNDINGS_BYTES_. Returns each pixel's length of
 * the path to its source, in the first T3R_SURROUNDINGS_LENGTHS_ of the work: 5 a straight step, UINT16_MAX where there
 * is no path. */
const uint16_t *t3r_fill_surroundings(const t3r_view *view, t3r_depth_source source, void *work);

/* Computes the luma of a view's pixels (SPEC.md, "Wavelet"). */
void t3r_luma_of_view(const t3r_view *view, uint8_t *luma);

#endif
