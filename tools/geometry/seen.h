/* SPDX-License-Identifier: Apache-2.0 */
/* Which pixels of a target show a surface that a context view saw too, by the frames' own depth. */
#ifndef TRIM3R_TOOLS_SEEN_H
#define TRIM3R_TOOLS_SEEN_H

#include <stdint.h>

#include "trim3r.h"

/* A view's own depth at the working size. */
typedef struct seen_view {
    const t3r_camera *camera; /* undistorted */
    const uint16_t *depth;    /* width x height steps, 0 = not measured */
    double unit;              /* of a step, in world units */
} seen_view;

/* Sets seen (width x height) to 255 where the target's depth puts a point into the picture of a context view that
 * measured this depth there, within 1/20 at the nearest pixel or one of its eight neighbours; else to 0. */
void seen_mask(uint8_t *seen, uint32_t width, uint32_t height, const seen_view *target, const seen_view *context,
               uint32_t context_count);

#endif
