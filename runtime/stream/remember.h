/* SPDX-License-Identifier: Apache-2.0 */
/* Chooses the keyframes that a stream remembers, and keeps the Gaussians that they show from idling. */
#ifndef T3R_REMEMBER_H
#define T3R_REMEMBER_H

#include "stream_map.h"
#include "trim3r.h"

/* Remembers the keyframe whose planes are in `old` before it leaves the live ones. Without room it replaces the
 * keyframe that the map needs least: a Gaussian counts in equal parts for all that show it about as finely as its own
 * keyframe. Does nothing with `remember` 0, or if the keyframe has no depth. */
void t3r_remember(t3r_runtime *rt, const t3r_view *old, const t3r_camera *camera, const uint16_t gain_q14[3]);

/* Keeps each Gaussian that a remembered keyframe shows about as finely as its own below the idle count at which
 * refinement omits it. */
void t3r_remembered_hold(const t3r_runtime *rt, t3r_map *map);

#endif
