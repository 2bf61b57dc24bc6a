/* Poses of one thing over time, asked for at any time between them. */
#ifndef TRIM3R_TOOLS_POSE_TRACK_H
#define TRIM3R_TOOLS_POSE_TRACK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "geometry/rigid.h"

#define POSE_TRACK_GAP_NS INT64_C(2000000000) /* between neighbours farther apart nothing is interpolated */

typedef struct pose_track {
    struct pose_track_item {
        int64_t stamp_ns;
        size_t order; /* of two at one time the later one counts */
        rigid pose;
    } * items;
    size_t count, capacity;
    bool standing; /* holds at all times */
} pose_track;

/* false: out of memory. */
bool pose_track_add(pose_track *track, int64_t stamp_ns, const rigid *pose);
/* Once, when all are added. */
void pose_track_sort(pose_track *track);
/* The pose of that time: that of the same time, else between its neighbours, else the nearest within near_ns. */
bool pose_track_at(const pose_track *track, int64_t stamp_ns, int64_t near_ns, rigid *out);
void pose_track_free(pose_track *track);

#endif
