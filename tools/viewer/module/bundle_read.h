/* SPDX-License-Identifier: Apache-2.0 */
/* Finds the parts of a bundle (bundle_layout.h) in the module's memory. */
#ifndef TRIM3R_TOOLS_VIEWER_BUNDLE_READ_H
#define TRIM3R_TOOLS_VIEWER_BUNDLE_READ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "bundle_layout.h"
#include "scene/seen_gaussian.h"
#include "trim3r.h"

typedef struct frame_data {
    t3r_camera camera;
    uint64_t depth_unit_q40;
    bool is_partial;                    /* its picture does not reach all pixels */
    const uint8_t *rgb, *depth, *shown; /* depth: NULL = none; shown: NULL = all */
} frame_data;

typedef struct bundle_data {
    t3r_config config;
    uint32_t frames;
    frame_data frame[BUNDLE_MOST_FRAMES];
    const uint8_t *weights, *gaussians, *far, *harmonics;
    uint32_t weight_bytes, gaussian_count, far_count;
    t3r_scene_frame scene_frame;
    seen_traits traits;
} bundle_data;

/* Reads a bundle, aligned to 16, that stays where it is. Returns false if it is damaged. */
bool bundle_read(const uint8_t *bytes, size_t count, bundle_data *out);
/* Returns a Gaussian of its scene. */
t3r_gaussian bundle_gaussian(const bundle_data *bundle, uint32_t index);
/* Returns how many times as far away it is as it says: t3r_scene_far. */
double bundle_times(const bundle_data *bundle, uint32_t index);
/* Returns the harmonics of that Gaussian; NULL at degree 0. */
const int16_t *bundle_harmonics(const bundle_data *bundle, uint32_t index);

#endif
