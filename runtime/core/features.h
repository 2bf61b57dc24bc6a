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

/* What a head needs, 0 for one that every library has. */
static inline uint32_t t3r_feature_of_head(t3r_head head)
{
    return head == T3R_HEAD_LEARNED ? T3R_HAS_LEARNED : 0u;
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

/* Whether builds follow one another; the compiler knows that they do not where that is left out. */
static inline bool t3r_is_warm(const t3r_config *config)
{
    return T3R_FEATURE_WARM && config->warm != 0 && !t3r_is_stream(config);
}

/* What an allocation needs. */
static inline uint32_t t3r_feature_of_allocation(t3r_allocation allocation)
{
    return allocation == T3R_ALLOCATE_DENSITY || allocation == T3R_ALLOCATE_PIXEL ? 0u : T3R_HAS_ALLOCATIONS;
}

/* What a wavelet needs. */
static inline uint32_t t3r_feature_of_wavelet(t3r_wavelet wavelet)
{
    return wavelet == T3R_WAVELET_DB2 ? 0u : T3R_HAS_WAVELETS;
}

#endif
