/* SPDX-License-Identifier: Apache-2.0 */
/* Features of this build (trim3r_features.h), and the features that settings need. */
#ifndef T3R_CORE_FEATURES_H
#define T3R_CORE_FEATURES_H

#include <stdbool.h>

#include "trim3r.h"

/* Whether this library has all of these T3R_HAS_... features. */
static inline bool t3r_has(uint32_t features)
{
    return (features & ~T3R_FEATURES_BUILT) == 0;
}

/* The feature that a setting needs, and the value from which it needs it. */
#define T3R_NEED_(name, kind, low, high, usual, feature, from, ...)                                                    \
    T3R_FEATURE_OF_##name = T3R_HAS_##feature, T3R_FROM_##name = (from),
enum { T3R_SETTINGS(T3R_NEED_) };

/* The feature, T3R_HAS_..., that a value of a setting needs. */
#define T3R_NEED(name, value) ((value) >= T3R_FROM_##name ? (uint32_t)T3R_FEATURE_OF_##name : 0u)

/* Returns the feature that a head needs; 0: none. */
static inline uint32_t t3r_feature_of_head(t3r_head head)
{
    return T3R_NEED(head, head);
}

/* Whether passes may compare a part of the pixels: those of streams, and those of config.fit_passes. */
#define T3R_FEATURE_PARTS (T3R_FEATURE_STREAMS || T3R_FEATURE_LOSS)

/* Whether builds follow one another; a constant false in builds without the feature. */
static inline bool t3r_is_warm(const t3r_config *config)
{
    return T3R_FEATURE_STREAMS && config->warm != 0 && config->stream == 0;
}

/* Whether depth comes from stereo; a constant false in builds without stereo. */
static inline bool t3r_is_by_stereo(const t3r_config *config)
{
    return T3R_FEATURE_STEREO && config->depth == T3R_DEPTH_STEREO;
}

/* Whether the scene is a stream's map; a constant false in builds without streams. */
static inline bool t3r_is_stream(const t3r_config *config)
{
    return T3R_FEATURE_STREAMS && config->stream != 0;
}

/* Whether surfaces that two views see are marked; a constant false in builds without comparison. */
static inline bool t3r_marks_covered(const t3r_config *config)
{
    return T3R_FEATURE_COMPARISON && config->redundancy != 0;
}

/* Whether depth that is missing after bridging is guessed; a constant false in builds without comparison. */
static inline bool t3r_guesses(const t3r_config *config)
{
    return T3R_FEATURE_COMPARISON && config->guess != 0 && !t3r_is_stream(config);
}

#endif
