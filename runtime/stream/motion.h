/* SPDX-License-Identifier: Apache-2.0 */
/* Rigid motions in the map's frame: what takes one pose of a camera to another one. */
#ifndef T3R_MOTION_H
#define T3R_MOTION_H

#include <stdbool.h>

#include "core/scene_frame.h"
#include "stream_map.h"
#include "trim3r.h"

typedef struct t3r_motion {
    int32_t quaternion_q30[4]; /* of length 1 */
    int32_t rotation_q30[9];   /* row-major, the same rotation */
    int32_t from_q20[3];       /* the centre of the rotation, scene units */
    int32_t to_q20[3];         /* its place afterwards */
} t3r_motion;

/* Computes the motion from one camera to another. Returns false if one of them is not valid, or out of the frame's
 * range: a restored arena may hold any cameras. */
bool t3r_motion_between(const t3r_camera *from, const t3r_camera *to, const t3r_scene_frame *frame, t3r_motion *motion);

/* Moves a camera. If it leaves the range of positions, it stops at the bound, far out of the frame's range. One that is
 * not valid, or out of the frame's range, stays as it is. */
void t3r_move_camera(const t3r_motion *motion, const t3r_scene_frame *frame, t3r_camera *camera);

/* Moves the Gaussians and turns them. Removes those that leave the frame's range. */
void t3r_move_map(const t3r_motion *motion, t3r_map *map);

#endif
