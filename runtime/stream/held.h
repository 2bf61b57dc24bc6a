/* SPDX-License-Identifier: Apache-2.0 */
/* The live keyframe that a frame is about to replace: held until the frame is taken, and put back if it is refused. */
#ifndef T3R_HELD_H
#define T3R_HELD_H

#include <stdint.h>

#include "state/views.h"
#include "trim3r.h"

typedef struct t3r_held {
    uint32_t slot, views; /* live keyframes before the frame */
    t3r_camera camera;
    uint64_t depth_unit_q40;
} t3r_held;

/* Copies the planes of the slot, if it holds a keyframe. They stay until stage wavelet. */
t3r_held t3r_hold(const t3r_runtime *rt, uint32_t slot);

/* Returns a view of the copied planes, without texture, pose and mask. */
t3r_view t3r_held_view(const t3r_runtime *rt);

/* Puts the keyframe back into its slot. */
void t3r_put_back(t3r_runtime *rt, const t3r_held *held);

/* Empties the slot, when a frame failed after the copied planes were overwritten. */
void t3r_give_up(t3r_runtime *rt, const t3r_held *held);

#endif
