/* SPDX-License-Identifier: Apache-2.0 */
/* Which keyframes a stream remembers, and which Gaussians they hold. */
#ifndef T3R_REMEMBER_H
#define T3R_REMEMBER_H

#include "stream_map.h"
#include "trim3r.h"

/* The keyframe of the slot is remembered before another takes its planes. Where there is no room it takes the place of
 * the one that the map needs least: a Gaussian counts for all that show it about as finely as its own keyframe, by
 * equal parts. Nothing happens with `remember` 0, and where the slot holds no depth. */
void t3r_remember(t3r_runtime *rt, uint32_t slot);

/* A Gaussian that a remembered keyframe shows about as finely as its own is not idle enough to be left out of
 * refinement. */
void t3r_remembered_hold(const t3r_runtime *rt, t3r_map *map);

#endif
