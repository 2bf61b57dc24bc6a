/* SPDX-License-Identifier: Apache-2.0 */
/* Costs of labels from the matched pixels of the view (SPEC.md, "Stereo: planes"). */
#ifndef T3R_PLANE_COSTS_H
#define T3R_PLANE_COSTS_H

#include "plane_labels.h"

/* Sets the costs of all labels of all cells, the share of matched pixels, and the cells that lie on planes. */
void t3r_plane_costs(const t3r_plane_labels *labels);

#endif
