/* SPDX-License-Identifier: Apache-2.0 */
/* What every scene must keep, whatever the frames were. */
#ifndef TRIM3R_TOOLS_STRESS_INVARIANT_H
#define TRIM3R_TOOLS_STRESS_INVARIANT_H

#include "reconstruction/reconstruction.h"
#include "scene/gaussian_shape.h"

/* NULL, or the invariant that the scene breaks: `count` Gaussians (at_most: 1..count), each within the ranges of
 * t3r_gaussian and finite as files hold it. */
const char *stress_broken_invariant(const t3r_scene *scene, uint32_t count, bool at_most);

/* Whether a scene file can hold it: logarithms of its scales, and its rotation. Of factors within their range it always
 * can. */
bool stress_finite(const gaussian_shape *shape);

#endif
