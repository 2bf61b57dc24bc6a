/* SPDX-License-Identifier: Apache-2.0 */
/* A bundle in memory: the input of a page of `trim3r view` (bundle_layout.h). */
#ifndef TRIM3R_TOOLS_BUNDLE_H
#define TRIM3R_TOOLS_BUNDLE_H

#include <stddef.h>
#include <stdint.h>

#include "scene/scene_file.h"
#include "trim3r.h"

/* A frame of the working size, undistorted. */
typedef struct bundle_frame {
    t3r_camera camera;
    uint8_t *rgb;    /* 3 bytes a pixel */
    uint16_t *depth; /* steps; NULL = none */
    uint8_t *shown;  /* 255 = the recorded picture reaches the pixel, 0 = beyond the lens; NULL = it reaches all */
    uint64_t depth_unit_q40; /* world units per step */
} bundle_frame;

typedef struct bundle {
    t3r_config config; /* `views` context views, the first of the frames */
    const void *weights;
    size_t weight_bytes;
    const bundle_frame *frames;
    uint32_t frame_count;
    const scene_file *scene;
} bundle;

/* Returns the bytes, on the heap; NULL when memory is out or they exceed 1 GiB. */
uint8_t *bundle_bytes(const bundle *b, size_t *count);

#endif
