/* SPDX-License-Identifier: Apache-2.0 */
/* Chooses the recorded frames that show most of a target's surface: `eval --views` adds them to a triplet's own. */
#ifndef TRIM3R_TOOLS_NEAREST_VIEWS_H
#define TRIM3R_TOOLS_NEAREST_VIEWS_H

#include <stdbool.h>
#include <stdint.h>

#include "recording/recording.h"
#include "trim3r.h"

/* The place of a frame's camera. */
typedef struct view_place {
    bool usable; /* it has pose and intrinsics, and depth if a sensor measures it */
    int64_t position_q32[3];
    int32_t axis_q30[3]; /* the direction of view, of length 1 */
} view_place;

/* Returns the place of a camera in its documented range. */
view_place view_place_of(const t3r_camera *camera);

/* Returns the median of a frame's valid depths in world units; 0 if none is valid. */
double view_median_depth(const t3r_frame *frame);

/* Returns the distance of two views: the root of (distance of the centres / depth)^2 + (distance of the directions
 * as unit vectors)^2. A camera that moves sideways by `depth` (> 0) shifts the picture of objects at that depth as
 * much as one that turns by about a radian. Rolling about the viewing direction does not count. */
double view_distance(const view_place *a, const view_place *b, double depth);

/* Adds frames to the context_count in context[], until there are `wanted`: the usable ones of the `count` places
 * that are nearest to the target and not in context[] yet, nearest first, the lower index first among equals, never
 * the target. Returns the number of frames, fewer than `wanted` if the recording has no more. */
uint32_t nearest_views(const view_place *places, uint32_t count, uint32_t target, double depth, uint32_t wanted,
                       uint32_t *context, uint32_t context_count);

#endif
