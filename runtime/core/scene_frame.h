/* SPDX-License-Identifier: Apache-2.0 */
/* The scene's fixed-point frame: the first context camera's centre is the origin, and a power of two brings the median
 * depth into [1, 2) scene units. So a scene 0.07 units wide and one in map coordinates have the same relative
 * precision. */
#ifndef T3R_SCENE_FRAME_H
#define T3R_SCENE_FRAME_H

#include <stdint.h>

#include "fixed.h"
#include "trim3r.h"

#define T3R_POSITION_MOST_Q20 (1 << 30) /* 1024 scene units */
#define T3R_EXPONENT_LEAST (-24)
#define T3R_EXPONENT_MOST 24

/* A rigid pose in fixed point, computed once from a t3r_camera. */
typedef struct t3r_pose {
    int32_t rotation_q30[9]; /* row-major, camera to scene */
    int32_t position_q20[3]; /* scene units */
} t3r_pose;

/* Computes the camera's pose in the frame. Returns T3R_ERR_CAMERA when the camera is more than 1024 scene units from
 * the origin along an axis. */
t3r_status t3r_pose_in_scene(const t3r_camera *camera, const t3r_scene_frame *frame, t3r_pose *pose);

/* Converts a view's depth steps to scene units: depth_q20 = (raw x mantissa) / 2^shift, rounded. */
typedef struct t3r_depth_scale {
    uint32_t mantissa; /* 2^31..2^32 - 1 */
    uint32_t shift;    /* 0..62 */
} t3r_depth_scale;
t3r_depth_scale t3r_depth_scale_of(uint64_t depth_unit_q40, int32_t exponent);

/* Returns the depth of a raw step, Q20, at most T3R_POSITION_MOST_Q20 - 1. */
static inline int32_t t3r_depth_q20(t3r_depth_scale scale, uint16_t raw)
{
    int64_t z = t3r_round_shift64((int64_t)raw * scale.mantissa, scale.shift); /* the product is below 2^48 */
    return (int32_t)T3R_MIN(z, (int64_t)T3R_POSITION_MOST_Q20 - 1);
}

/* Returns the raw steps up to a depth below 2^31, rounded down, at most 65,535. With a shift above 32 they are a
 * multiple of 2^(shift - 32). */
static inline uint32_t t3r_depth_steps(t3r_depth_scale scale, uint32_t z_q20)
{
    const uint32_t shift = T3R_MIN(scale.shift, 32u); /* below 2^63; the quotient is below 2^32, times at most 2^30 */
    const uint64_t steps = ((uint64_t)z_q20 << shift) / scale.mantissa << (scale.shift - shift);
    return (uint32_t)T3R_MIN(steps, (uint64_t)UINT16_MAX);
}

#endif
