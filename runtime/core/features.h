/* The features of this build (trim3r_features.h), and which of them settings ask for. */
#ifndef T3R_CORE_FEATURES_H
#define T3R_CORE_FEATURES_H

#include <stdbool.h>

#include "trim3r.h"

/* Whether this library has all of these T3R_HAS_... */
static inline bool t3r_has(uint32_t features)
{
    return (features & ~T3R_FEATURES_BUILT) == 0;
}

/* The feature that a setting needs, and from which value. */
#define T3R_NEED_(name, kind, low, high, usual, feature, from, ...)                                                    \
    T3R_FEATURE_OF_##name = T3R_HAS_##feature, T3R_FROM_##name = (from),
enum { T3R_SETTINGS(T3R_NEED_) T3R_NEEDS_COUNT };

/* What a value of a setting needs of the library, T3R_HAS_... */
#define T3R_NEED(name, value) ((value) >= T3R_FROM_##name ? (uint32_t)T3R_FEATURE_OF_##name : 0u)

/* What a head needs, 0 for one that every library has. */
static inline uint32_t t3r_feature_of_head(t3r_head head)
{
    return T3R_NEED(head, head);
}

/* Whether builds follow one another; the compiler knows that they do not where that is left out. */
static inline bool t3r_is_warm(const t3r_config *config)
{
    return T3R_FEATURE_STREAMS && config->warm != 0 && config->stream == 0;
}

/* Whether depth is made of the colours; the compiler knows that it is not where stereo is left out. */
static inline bool t3r_is_by_stereo(const t3r_config *config)
{
    return T3R_FEATURE_STEREO && config->depth == T3R_DEPTH_STEREO;
}

/* Whether a map follows a camera, likewise. */
static inline bool t3r_is_stream(const t3r_config *config)
{
    return T3R_FEATURE_STREAMS && config->stream != 0;
}

#endif
