/* SPDX-License-Identifier: Apache-2.0 */
/* Aligns depth pictures of another lens, at colour's place or next to it. */
#ifndef TRIM3R_TOOLS_ALIGN_DEPTH_H
#define TRIM3R_TOOLS_ALIGN_DEPTH_H

#include <stddef.h>

#include "import/frames/posed_frame.h"
#include "pictures/picture.h"

/* Whether the two lenses see the same within half a pixel of colour's, at the corners of pictures of any size. Depth
 * then needs at most another size. */
bool align_depth_same(const posed_intrinsics *colour, const posed_intrinsics *depth, double width, double height,
                      double depth_width, double depth_height);

/* Draws the frame's depth, which frame->depth_lens saw from frame->from_depth, as seen by the camera of its colour
 * picture (register_depth.h), into `depth`. Returns 0, or -1 with a reason in error[]. */
int align_depth(const posed_frame *frame, const t3r_recorded_camera *colour, picture *depth, char *error,
                size_t error_bytes);

#endif
