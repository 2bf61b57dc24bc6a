/* SPDX-License-Identifier: Apache-2.0 */
/* Frames of a bag whose lens a recording cannot hold, as a pinhole would have taken them. */
#ifndef TRIM3R_TOOLS_BAG_STRAIGHT_H
#define TRIM3R_TOOLS_BAG_STRAIGHT_H

#include <stddef.h>

#include "import/poses/lens.h"
#include "pictures/picture.h"
#include "trim3r.h"

/* Redraws the colour of a frame (straighten.h) into `out`, which replaces what it held, and points the frame to it.
 * valid: as in picture.h, of the frame's pixels; NULL = all are. Returns 0, or -1 with a reason. */
int bag_straighten_colour(const lens *l, t3r_frame *frame, const uint8_t *valid, picture *out, char *error,
                          size_t error_bytes);
/* Does the same with depth of the same view. */
int bag_straighten_depth(const lens *l, t3r_frame *frame, picture *out, char *error, size_t error_bytes);

#endif
