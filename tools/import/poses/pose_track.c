#include "import/poses/pose_track.h"

#include <stdlib.h>

#include "host/grow.h"

bool pose_track_add(pose_track *track, int64_t stamp_ns, const rigid *pose)
{
    struct pose_track_item *grown = t3r_grow(track->items, track->count, &track->capacity, sizeof *grown);
    if (grown == NULL) {
        return false;
    }
    track->items = grown;
    track->items[track->count] = (struct pose_track_item){stamp_ns, track->count, *pose};
    track->count++;
    return true;
}

static int by_stamp(const void *left, const void *right)
{
    const struct pose_track_item *a = left, *b = right;
    if (a->stamp_ns != b->stamp_ns) {
        return a->stamp_ns < b->stamp_ns ? -1 : 1;
    }
    return a->order < b->order ? -1 : a->order > b->order;
}

void pose_track_sort(pose_track *track)
{
    if (track->count > 1) {
        qsort(track->items, track->count, sizeof *track->items, by_stamp);
    }
}

/* Returns the number of items not after `stamp_ns`. */
static size_t count_until(const pose_track *track, int64_t stamp_ns)
{
    size_t low = 0, high = track->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (track->items[middle].stamp_ns <= stamp_ns) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

bool pose_track_at(const pose_track *track, int64_t stamp_ns, int64_t near_ns, rigid *out)
{
    size_t until = count_until(track, stamp_ns);
    if (track->count == 0) {
        return false;
    }
    if (track->standing) {
        *out = track->items[track->count - 1].pose;
        return true;
    }
    const struct pose_track_item *before = until > 0 ? &track->items[until - 1] : NULL;
    const struct pose_track_item *after = until < track->count ? &track->items[until] : NULL;
    int64_t gap_before = before != NULL ? stamp_ns - before->stamp_ns : INT64_MAX;
    int64_t gap_after = after != NULL ? after->stamp_ns - stamp_ns : INT64_MAX;
    if (gap_before != 0 && before != NULL && after != NULL && after->stamp_ns - before->stamp_ns <= POSE_TRACK_GAP_NS) {
        *out = rigid_between(&before->pose, &after->pose,
                             (double)gap_before / (double)(after->stamp_ns - before->stamp_ns));
        return true;
    }
    const struct pose_track_item *nearest = gap_before <= gap_after ? before : after;
    *out = nearest->pose;
    return (gap_before <= gap_after ? gap_before : gap_after) <= near_ns;
}

void pose_track_free(pose_track *track)
{
    free(track->items);
    *track = (pose_track){0};
}
