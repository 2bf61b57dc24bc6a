/* SPDX-License-Identifier: Apache-2.0 */
/* The map of a stream: its Gaussians with what is noted beside each, seen by a keyframe, and cut to its cap. */
#ifndef T3R_STREAM_MAP_H
#define T3R_STREAM_MAP_H

#include <stdint.h>

#include "budget/budget.h"
#include "core/map_record.h"
#include "pointmap/pointmap.h"
#include "state/views.h"
#include "trim3r.h"

/* log2: pixels on the surface so much wider than its own do not update a Gaussian. */
#define T3R_AFAR_Q8 128

/* Keys below are held for so much, 20 octaves: sure points of a keyframe outlast others by a bounded time only. */
#define T3R_MAP_KEY_LEAST (T3R_KEY_ZERO - (20 << 10))

typedef struct t3r_map {
    t3r_gaussian *gaussians;
    t3r_map_record *records;
    uint32_t count;
} t3r_map;

t3r_map t3r_map_of(const t3r_runtime *rt);

/* log2 of a pixel's width z / (fx + fy) on a surface at z, Q8. */
int32_t t3r_grain_q8(const t3r_view *view, int32_t z_q20);

/* Looks at every Gaussian from a keyframe: those that it sees through and those of a surface that it sees far finer
 * leave, those that it does not see fade to half the density in `half_life` keyframes (0: never, else up to 1,024).
 * `keyframes` were seen before this one. Returns how many left. */
uint32_t t3r_map_see(t3r_map *map, const t3r_pointmap *keyframe, uint32_t keyframes, uint32_t half_life);

/* Who stays when the map's Gaussians and a keyframe's points compete for `most` places. */
typedef struct t3r_map_cut {
    uint32_t threshold; /* the largest key that stays */
    uint32_t ties;      /* Gaussians of that key that stay, the newest ones */
    uint32_t added;     /* points of the keyframe that stay: those of its smallest keys */
    uint32_t kept;      /* Gaussians that stay */
} t3r_map_cut;

/* The points' keys are those of t3r_budget_keys(). */
t3r_map_cut t3r_map_compete(const t3r_map *map, const t3r_view *keyframe, const t3r_budget_settings *settings,
                            uint32_t most);

/* Drops who does not stay and widens who does. */
void t3r_map_thin(t3r_map *map, const t3r_map_cut *cut);

/* The records of the `count` Gaussians just made of the keyframe's retained points, those beyond the frame's range left
 * out. Returns how many were appended. */
uint32_t t3r_map_append(t3r_map *map, uint32_t count, const t3r_pointmap *keyframe, const t3r_budget_settings *settings,
                        const t3r_cluster *clusters);

/* Moves all positions; who falls out of the frame's range leaves. */
void t3r_map_move(t3r_map *map, const int64_t by_q20[3]);

#endif
