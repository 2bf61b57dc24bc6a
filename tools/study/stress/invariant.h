/* SPDX-License-Identifier: Apache-2.0 */
/* Invariants of every scene, for any frames. */
#ifndef TRIM3R_TOOLS_STRESS_INVARIANT_H
#define TRIM3R_TOOLS_STRESS_INVARIANT_H

#include "reconstruction/reconstruction.h"
#include "scene/gaussian_shape.h"

/* Returns NULL, or the invariant that the scene breaks: `count` Gaussians (at_most: 1..count), each within the
 * ranges of t3r_gaussian and finite when written to a file. */
const char *stress_broken_invariant(const t3r_scene *scene, uint32_t count, bool at_most);

/* Whether a scene file can hold the shape: logarithms of its scales, and its rotation. Always true for factors
 * within their range. */
bool stress_finite(const gaussian_shape *shape);

#endif
