/* SPDX-License-Identifier: Apache-2.0 */
/* Pictures of lenses that a recording cannot hold, as a pinhole would have taken them. */
#ifndef TRIM3R_TOOLS_STRAIGHTEN_H
#define TRIM3R_TOOLS_STRAIGHTEN_H

#include "import/frames/posed_frame.h"
#include "import/poses/lens.h"
#include "pictures/picture.h"

/* Whether a recording cannot hold the lens: k4 to k6 are not 0, or coefficients are beyond the runtime's range. */
bool posed_is_bent(const posed_intrinsics *in);
/* Returns the lens of that camera, with all its coefficients. */
lens posed_lens(const posed_intrinsics *in, const t3r_recorded_camera *camera);

/* Redraws a picture of the lens, or a smaller or larger one of the same view, for the pinhole of the same focal length
 * and principal point: colour by bilinear interpolation, 16-bit depth by the nearest sample. Pixels that the lens does
 * not see become 0, in colour also invalid. Returns 0, or -1 with a reason in error[]: also if that is more than half
 * of the picture. */
int straighten(const lens *l, picture *p, char *error, size_t error_bytes);
/* Sets little-endian depth of the pinhole's view to 0, none, where the lens sees nothing. */
void straighten_hide(const lens *l, uint32_t width, uint32_t height, uint8_t *depth_z16);

#endif
