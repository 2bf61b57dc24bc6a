/* SPDX-License-Identifier: Apache-2.0 */
/* Semi-global paths over labels (SPEC.md, "Stereo: planes"). */
#ifndef T3R_PLANE_PATHS_H
#define T3R_PLANE_PATHS_H

#include "plane_labels.h"

/* Sums each label's costs along the paths from the left, the right, above and below. */
void t3r_plane_paths(const t3r_plane_labels *labels);

#endif
