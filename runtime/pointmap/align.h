/* Poses of context views, corrected until the views agree (SPEC.md, "Between views"). */
#ifndef T3R_ALIGN_H
#define T3R_ALIGN_H

#include <stdbool.h>

#include "core/features.h"
#include "core/fixed.h"
#include "state/state.h"

/* Whether a configuration's scenes are of aligned views: of two and more, with a sensor's depth, and not where poses
 * must be those of a build or keyframe before. */
static inline bool t3r_aligns(const t3r_config *config)
{
    return T3R_FEATURE_COMPARISON && config->align != 0 && !t3r_is_by_stereo(config) && !t3r_is_warm(config) &&
           !t3r_is_stream(config);
}

#define T3R_ALIGN_LEVELS 5u
#define T3R_ALIGN_ROUNDS 6u                                        /* a level, at most; the first one only measures */
#define T3R_ALIGN_STEPS (T3R_ALIGN_LEVELS * T3R_ALIGN_ROUNDS + 2u) /* of the progress, at most */

/* How many pixels with depth of a view are compared with each other view in a round, about. They lie on a grid of at
 * most four times as many places, with depth or without. With fewer, the poses of a still scene follow the noise of its
 * captures. views: 2..T3R_MAX_VIEWS. */
static inline uint32_t t3r_align_pixels(uint32_t views)
{
    return T3R_MAX((1u << 11) / views, 1u << 8);
}

/* Moves the cameras of the views and `views[v].pose` by what lets the views show the same surfaces in the same colours.
 * They stay as they were given where that is not clearly so. The poses must be those given, in the frame of `rt`;
 * bridged depth and marks must not be there yet. steps: those of the whole stage, of which the first T3R_ALIGN_STEPS
 * are reported here. T3R_ERR_CANCELLED leaves the poses anywhere between. */
t3r_status t3r_align_views(t3r_runtime *rt, t3r_view *views, uint32_t steps);

#endif
