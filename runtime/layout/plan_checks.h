/* SPDX-License-Identifier: Apache-2.0 */
/* The checks of plans. */
#ifndef T3R_PLAN_CHECKS_H
#define T3R_PLAN_CHECKS_H

#include "arena.h"
#include "core/config.h"
#include "core/fault.h"
#include "core/features.h"

/* Checks a configuration, for a sentence if one is wanted. */
#define T3R_CHECK_CONFIG(config, fault)                                                                                \
    T3R_PASS((fault) == NULL ? t3r_config_check(config) : t3r_config_fault((config), (fault)))

T3R_CHECKS t3r_plan_bytes_checks(const t3r_config *config, const size_t *min_bytes, const size_t *bytes,
                                 t3r_fault *fault)
{
    T3R_MISUSE(fault, config != NULL, T3R_ERR_ARGUMENT, "config is NULL");
    T3R_MISUSE(fault, min_bytes != NULL && bytes != NULL, T3R_ERR_ARGUMENT, "min_bytes or bytes is NULL");
    T3R_CHECK_CONFIG(config, fault);
    return T3R_OK;
}

/* Returns the configuration with room for `most` Gaussians and no larger budget. */
static inline t3r_config t3r_with_room_for(const t3r_config *config, uint32_t most)
{
    t3r_config changed = *config;
    changed.max_gaussians = most;
    changed.gaussians = T3R_MIN(config->gaussians, most);
    return changed;
}

T3R_CHECKS t3r_plan_within_checks(size_t bytes, const t3r_config *config, t3r_fault *fault)
{
    T3R_MISUSE(fault, config != NULL, T3R_ERR_ARGUMENT, "config is NULL");
    const t3r_config one = t3r_with_room_for(config, 1);
    T3R_CHECK(fault,
              config->max_gaussians <= T3R_MAX_GAUSSIANS && config->gaussians != 0 &&
                  config->gaussians <= config->max_gaussians,
              T3R_ERR_CONFIG,
              "config.gaussians is @ and config.max_gaussians is @: the first is 1..the second, which is at most #",
              config->gaussians, config->max_gaussians, T3R_MAX_GAUSSIANS);
    T3R_CHECK_CONFIG(&one, fault);
    t3r_layout layout;
    T3R_CHECK(fault, t3r_lay_out(&one, bytes, &layout) == T3R_OK, T3R_ERR_ARENA,
              "bytes is @: with one Gaussian alone the arena has at least @", bytes, layout.min_bytes);
    return T3R_OK;
}

#define T3R_PRESETS_NEED (T3R_HAS_LEARNED | T3R_HAS_LOSS)

T3R_CHECKS t3r_set_preset_checks(t3r_preset preset, const t3r_config *config, t3r_fault *fault)
{
    T3R_MISUSE(fault, config != NULL, T3R_ERR_ARGUMENT, "config is NULL");
    T3R_CHECK(fault, preset < T3R_PRESET_COUNT, T3R_ERR_ARGUMENT, "preset is @: a t3r_preset is 0..#", preset,
              T3R_PRESET_COUNT - 1);
    T3R_CHECK(fault, t3r_has(T3R_PRESETS_NEED), T3R_ERR_UNSUPPORTED,
              "a preset needs features that this library was built without: %", T3R_PRESETS_NEED & ~t3r_features());
    return T3R_OK;
}

#endif
