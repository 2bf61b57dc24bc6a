/* SPDX-License-Identifier: Apache-2.0 */
/* Costs of labels from the other picture: a plane sweep (SPEC.md, "Stereo: planes"). */
#ifndef T3R_PLANE_SWEEP_H
#define T3R_PLANE_SWEEP_H

#include "kernels/kernels.h"
#include "plane_labels.h"

/* Luma and the census of both views */
#define T3R_PLANE_SWEEP_BYTES(width, height)                                                                           \
    (T3R_UP_(T3R_PIXELS_(width, height)) + 2 * T3R_UP_(T3R_PIXELS_(width, height) * T3R_CENSUS_BYTES))

/* Adds what cells look like on each label in the other view: how many more census comparisons differ there than on the
 * best label. Labels that the other view does not see cost nothing. Takes T3R_PLANE_SWEEP_BYTES of the cut. */
void t3r_plane_sweep(const t3r_plane_labels *labels, const t3r_kernels *kernels, const t3r_camera *camera,
                     const t3r_view *other, const t3r_camera *other_camera, t3r_cut *cut);

#endif
