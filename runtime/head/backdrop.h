/* SPDX-License-Identifier: Apache-2.0 */
/* The backdrop: wide Gaussians far away in all directions, in the colours of the borders of the context views. So a
 * view in any direction is not black. It has no depth, and refinement corrects its colours alone (SPEC.md, "Backdrop").
 */
#ifndef T3R_BACKDROP_H
#define T3R_BACKDROP_H

#include "state/state.h"
#include "state/views.h"

#define T3R_BACKDROP_DISTANCE_Q20 (256 << 20) /* scene units */

/* The budget from which a face of the cube of directions has n x n Gaussians: 16 times as many as all six have. */
#define T3R_BACKDROP_BUDGET(n) (16u * 6 * (n) * (n))
#define T3R_BACKDROP_MOST_SIDE 3u

/* Returns n, the Gaussians along a side of a face of the cube; 0: the scene has no backdrop. */
static inline uint32_t t3r_backdrop_side(const t3r_config *config, uint32_t budget)
{
    uint32_t n = T3R_FEATURE_BACKDROP && config->backdrop && !t3r_is_stream(config) ? T3R_BACKDROP_MOST_SIDE : 0;
    while (n > 0 && budget < T3R_BACKDROP_BUDGET(n)) {
        n--;
    }
    return n;
}

/* Returns how many Gaussians of its budget a build's rim and backdrop take, at most 24 a view and 54. */
uint32_t t3r_backdrop_count(const t3r_runtime *rt, const t3r_view *views);

/* Writes the rim and the backdrop after the scene's Gaussians, which leave room for it in their budget. */
void t3r_add_backdrop(t3r_runtime *rt, const t3r_view *views);

#endif
