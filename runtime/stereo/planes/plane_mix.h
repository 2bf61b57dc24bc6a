/* SPDX-License-Identifier: Apache-2.0 */
/* Depth from labels (SPEC.md, "Stereo: planes"). */
#ifndef T3R_PLANE_MIX_H
#define T3R_PLANE_MIX_H

#include "plane_labels.h"

/* Gives each filled pixel a mix of its labels and its own depth. length: of the path to each pixel's source, as
 * t3r_fill_surroundings() returns it. */
void t3r_plane_mix(const t3r_plane_labels *labels, const uint16_t *length);

#endif
