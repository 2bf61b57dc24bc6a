/* SPDX-License-Identifier: Apache-2.0 */
/* Outlines that matched outlines (SPEC.md, "Stereo: planes"). */
#ifndef T3R_PLANE_OUTLINE_H
#define T3R_PLANE_OUTLINE_H

#include "stereo/match.h"

/* Where a picture ends there is a step of luma in both planes, and the two match, whatever is seen there. Pixels of
 * either plane near an end, whose partner is as near to its own, lose their confidence. */
void t3r_plane_outline(const t3r_match *match);

#endif
