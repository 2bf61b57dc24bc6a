/* SPDX-License-Identifier: Apache-2.0 */
/* Range checks of settings, and values for settings left open. */
#ifndef T3R_CONFIG_H
#define T3R_CONFIG_H

#include <stdbool.h>

#include "core/fault.h"
#include "core/fixed.h"
#include "trim3r.h"

/* Checks a configuration. After T3R_ERR_CONFIG or T3R_ERR_UNSUPPORTED t3r_config_error() returns the reason. */
t3r_status t3r_config_check(const t3r_config *config);

/* Does the same, and writes the sentence of what is wrong. */
t3r_status t3r_config_fault(const t3r_config *config, t3r_fault *fault);

/* Returns the configuration with values for the settings left open. */
t3r_config t3r_settled(const t3r_config *config);

/* Returns the maximum number of splats drawn a tile. */
static inline uint32_t t3r_tile_splats_of(const t3r_config *config)
{
    return config->tile_splats != 0 ? config->tile_splats : UINT32_MAX;
}

/* Returns the passes of refinement in a build that follows another (t3r_config.warm). */
static inline uint32_t t3r_following_passes_of(const t3r_config *config)
{
    return (config->refine + 1) / 2;
}

/* Returns the passes for a stream's keyframe. Fitted passes take T3R_STREAM_REFINE: each keyframe corrects what
 * earlier ones did. */
static inline uint32_t t3r_keyframe_passes_of(const t3r_config *config, bool follows)
{
    const uint32_t passes = config->fit_passes ? T3R_MIN(config->refine, T3R_STREAM_REFINE) : config->refine;
    return follows ? (passes + 1) / 2 : passes;
}

/* Returns an upper bound of the arena's bytes for fields in range. It is generous, and in 64 bits because sums in
 * size_t may wrap. */
uint64_t t3r_most_arena_bytes(const t3r_config *config);

#endif
