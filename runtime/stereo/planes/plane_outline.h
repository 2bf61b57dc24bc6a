/* SPDX-License-Identifier: Apache-2.0 */
/* Removes matches of picture outlines (SPEC.md, "Stereo: planes"). */
#ifndef T3R_PLANE_OUTLINE_H
#define T3R_PLANE_OUTLINE_H

#include "stereo/match.h"

/* Removes the confidence of pixels near an end of a picture whose partner is equally near its own. At the end of a
 * picture there is a step of luma in both planes, and the two match whatever is there. */
void t3r_plane_outline(const t3r_match *match);

#endif
