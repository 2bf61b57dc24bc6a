/* SPDX-License-Identifier: Apache-2.0 */
/* Alignment: correction of the poses of context views until the views agree (SPEC.md, "Between views"). */
#ifndef T3R_ALIGN_H
#define T3R_ALIGN_H

#include <stdbool.h>

#include "core/features.h"
#include "core/fixed.h"
#include "state/state.h"

/* Whether the configuration aligns views: two or more, with a sensor's depth, and unless poses must stay those of an
 * earlier build or keyframe. */
static inline bool t3r_aligns(const t3r_config *config)
{
    return T3R_FEATURE_COMPARISON && config->align != 0 && !t3r_is_by_stereo(config) && !t3r_is_warm(config) &&
           !t3r_is_stream(config);
}

#define T3R_ALIGN_LEVELS 5u
#define T3R_ALIGN_ROUNDS 6u /* rounds per level, at most; the first only measures */
#define T3R_ALIGN_STEPS (T3R_ALIGN_LEVELS * T3R_ALIGN_ROUNDS + 2u) /* steps of progress, at most */

/* Returns the approximate number of pixels with depth of a view that are compared with each other view in a round. The
 * grid has at most four times that number of places, including those without depth. With fewer pixels the poses of a
 * still scene would follow the noise of its captures. views: 2..T3R_MAX_VIEWS. */
static inline uint32_t t3r_align_pixels(uint32_t views)
{
    return T3R_MAX((1u << 11) / views, 1u << 8);
}

/* Corrects the cameras of the views, and `views[v].pose`, so that the views show the same surfaces in the same
 * colours. All stay as given unless the result is clearly better. The poses must be the given ones, in the frame of
 * `rt`. Depth must not be bridged nor marked yet. steps: number of the whole stage; the first T3R_ALIGN_STEPS of them
 * are reported here. T3R_ERR_CANCELLED leaves the poses of some round. */
t3r_status t3r_align_views(t3r_runtime *rt, t3r_view *views, uint32_t steps);

/* Corrects the camera of view v alone, and `views[v].pose`, from a guess on that may be off by a quarter of a radian or
 * of a scene unit. The guess is rt->given[v], with deviation 0, and both are set already; they change. Whether the
 * result is right, the caller finds out. T3R_ERR_CANCELLED leaves the pose of some round. */
t3r_status t3r_align_view(t3r_runtime *rt, t3r_view *views, uint32_t v);

#endif
