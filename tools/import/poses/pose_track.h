/* SPDX-License-Identifier: Apache-2.0 */
/* The poses of one object over time, interpolated at any time between them. */
#ifndef TRIM3R_TOOLS_POSE_TRACK_H
#define TRIM3R_TOOLS_POSE_TRACK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "geometry/rigid.h"

#define POSE_TRACK_GAP_NS INT64_C(2000000000) /* neighbours farther apart are not interpolated */

typedef struct pose_track {
    struct pose_track_item {
        int64_t stamp_ns;
        size_t order; /* of two items at one time the later one wins */
        rigid pose;
    } * items;
    size_t count, capacity;
    bool standing; /* holds at all times */
} pose_track;

/* Returns false when out of memory. */
bool pose_track_add(pose_track *track, int64_t stamp_ns, const rigid *pose);
/* Sorts the track; call once, when all poses are added. */
void pose_track_sort(pose_track *track);
/* Finds the pose at a time: the pose of exactly that time, else interpolated between its neighbours, else the nearest
 * within near_ns. */
bool pose_track_at(const pose_track *track, int64_t stamp_ns, int64_t near_ns, rigid *out);
void pose_track_free(pose_track *track);

#endif
