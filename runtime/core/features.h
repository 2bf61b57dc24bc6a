/* Features of this build (trim3r_features.h), and which of them settings need. */
#ifndef T3R_CORE_FEATURES_H
#define T3R_CORE_FEATURES_H

#include <stdbool.h>

#include "trim3r.h"

/* Whether this library has all of these T3R_HAS_... features. */
static inline bool t3r_has(uint32_t features)
{
    return (features & ~T3R_FEATURES_BUILT) == 0;
}

/* Returns the feature that a head needs, 0 for a head that every library has. */
static inline uint32_t t3r_feature_of_head(t3r_head head)
{
    return head == T3R_HEAD_LEARNED ? T3R_HAS_LEARNED : head == T3R_HEAD_MOMENT ? T3R_HAS_MOMENT : 0u;
}

/* Whether builds follow one another; a constant false in builds without the feature. */
static inline bool t3r_is_warm(const t3r_config *config)
{
    return T3R_FEATURE_WARM && config->warm != 0;
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

/* Returns the feature that an allocation needs, or 0. */
static inline uint32_t t3r_feature_of_allocation(t3r_allocation allocation)
{
    return allocation == T3R_ALLOCATE_DENSITY || allocation == T3R_ALLOCATE_PIXEL ? 0u : T3R_HAS_ALLOCATIONS;
}

/* Returns the feature that a wavelet needs, or 0. */
static inline uint32_t t3r_feature_of_wavelet(t3r_wavelet wavelet)
{
    return wavelet == T3R_WAVELET_DB2 ? 0u : T3R_HAS_WAVELETS;
}

#endif
