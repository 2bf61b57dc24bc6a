/* SPDX-License-Identifier: Apache-2.0 */
/* Dense depth maps of COLMAP (patch_match_stereo), next to a model of undistorted pictures. */
#ifndef TRIM3R_TOOLS_COLMAP_DEPTH_H
#define TRIM3R_TOOLS_COLMAP_DEPTH_H

#include "import/frames/posed_frame.h"

/* Sets the frame's depth to the map of that picture, if there is one; a geometric map wins over a photometric one. -1:
 * out of memory. */
int colmap_depth_find(const char *directory, const char *image, posed_frame *frame);
/* Sets the depth step that lengths are rounded to, unless depth_unit is given; call when all maps are found. The
 * largest median of a sample of the maps becomes an eighth of the 16-bit range. */
void colmap_depth_set_unit(const char *directory, posed_folder *folder);
/* Adds a remark on maps that lie in a folder below. -1: out of memory. */
int colmap_depth_tell(const char *directory, posed_folder *folder);

#endif
