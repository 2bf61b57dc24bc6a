/* Dense depth maps of COLMAP (patch_match_stereo), beside a model of undistorted pictures. */
#ifndef TRIM3R_TOOLS_COLMAP_DEPTH_H
#define TRIM3R_TOOLS_COLMAP_DEPTH_H

#include "import/folders/posed_frame.h"

/* The map of a picture that the model names so becomes the frame's depth, where there is one; the geometric before the
 * photometric. -1: out of memory. */
int colmap_depth_find(const char *directory, const char *image, posed_frame *frame);
/* Once all are found: how long the steps are that lengths are rounded to, where depth_unit is not given: so that the
 * largest of some maps' medians is an eighth of the most that 16 bits hold. */
void colmap_depth_set_unit(const char *directory, posed_folder *folder);
/* Notes maps that lie in a folder below. -1: out of memory. */
int colmap_depth_tell(const char *directory, posed_folder *folder);

#endif
