/* SPDX-License-Identifier: Apache-2.0 */
/* The map of a stream: its Gaussians and their records, seen by a keyframe, and cut to its cap. */
#ifndef T3R_STREAM_MAP_H
#define T3R_STREAM_MAP_H

#include <stdbool.h>
#include <stdint.h>

#include "budget/budget.h"
#include "core/map_record.h"
#include "core/workers.h"
#include "kernels/points.h"
#include "pointmap/pointmap.h"
#include "state/views.h"
#include "trim3r.h"

/* log2: a keyframe with pixels this much wider on the surface than a Gaussian's own does not update it. */
#define T3R_AFAR_Q8 128

/* Lower bound of keys in the map, 20 octaves: sure points of a keyframe outlast others only by a bounded time. */
#define T3R_MAP_KEY_LEAST (T3R_KEY_ZERO - (20 << 10))

/* The surroundings of a Gaussian reach so many pixels far, at most. */
#define T3R_MAP_MARGIN 16

/* Key of a Gaussian that leaves. Others' keys are at most T3R_KEY_ZERO. */
#define T3R_MAP_KEY_LEAVES UINT16_MAX

typedef struct t3r_map {
    t3r_gaussian *gaussians;
    t3r_map_record *records;
    uint32_t count;
} t3r_map;

t3r_map t3r_map_of(const t3r_runtime *rt);

/* Returns log2 of a pixel's width z / (fx + fy) on a surface at z, Q8. */
int32_t t3r_grain_q8(const t3r_view *view, int32_t z_q20);

/* Whether a Gaussian has the colour of the pixel, within 24 levels a channel in the mean. */
bool t3r_map_is_alike(const t3r_gaussian *g, const t3r_view *view, size_t pixel);

/* Returns the picture with T3R_MAP_MARGIN more pixels on each side. */
t3r_pinhole t3r_map_wide_picture(const t3r_view *view);

/* Updates every Gaussian from a keyframe: removes those that it sees through or sees far finer, and fades those whose
 * surroundings it does not see to half the density in `half_life` keyframes (0: never, else up to 1,024). `keyframes`:
 * number of earlier ones. looks: work, a byte for each Gaussian. Returns the number removed. */
uint32_t t3r_map_see(t3r_map *map, const t3r_pointmap *keyframe, uint32_t keyframes, uint32_t half_life,
                     const t3r_workers *workers, uint8_t *looks);

/* Notes which Gaussians a keyframe sees as t3r_map_see() does, and changes nothing else. */
void t3r_map_look(t3r_map *map, const t3r_pointmap *keyframe, const t3r_workers *workers, uint8_t *looks);

/* Removes the Gaussians that leave. Returns their number. */
uint32_t t3r_map_drop(t3r_map *map);

/* The Gaussians of the map and the points of a keyframe that are kept when they compete for `most` places. */
typedef struct t3r_map_cut {
    uint32_t threshold;  /* the largest key kept */
    uint32_t ties;       /* kept Gaussians with that key, the newest ones */
    uint32_t point_ties; /* kept points with that key, the first ones */
    uint32_t added;      /* kept points of the keyframe, those with its smallest keys */
    uint32_t kept;       /* kept Gaussians */
} t3r_map_cut;

/* Chooses by keys; the points' come from t3r_budget_keys(). */
t3r_map_cut t3r_map_compete(const t3r_map *map, const t3r_view *keyframe, const t3r_budget_settings *settings,
                            uint32_t most);

/* Notes another density around a Gaussian and scales its width with the spacing, 2^(-density / 2). */
void t3r_map_set_density(t3r_gaussian *g, t3r_map_record *record, int32_t density_q10);

/* Keeps a width within a quarter of the spacing and four times it. */
void t3r_map_hold_width(t3r_gaussian *g, const t3r_map_record *record);

/* Removes the Gaussians that are not kept and widens the others. */
void t3r_map_thin(t3r_map *map, const t3r_map_cut *cut);

/* Appends records of the `count` Gaussians just made of the keyframe's retained points; drops Gaussians beyond the
 * frame's range. Returns the number appended. */
uint32_t t3r_map_append(t3r_map *map, uint32_t count, const t3r_pointmap *keyframe, const t3r_budget_settings *settings,
                        const t3r_cluster *clusters);

/* Makes all Gaussians those of an earlier piece: a later keyframe in whose picture they are removes them, unless it
 * sees them in their colours. */
void t3r_map_begin_piece(t3r_map *map);

/* Moves Gaussian i to a position and to number *kept, and counts it; drops it if the position is out of the frame's
 * range. */
void t3r_map_place(t3r_map *map, uint32_t i, const int64_t position_q20[3], uint32_t *kept);

/* Moves all positions; Gaussians that leave the frame's range are removed. */
void t3r_map_move(t3r_map *map, const int64_t by_q20[3]);

#endif
