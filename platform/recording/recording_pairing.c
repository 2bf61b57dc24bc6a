/* SPDX-License-Identifier: Apache-2.0 */
/* Decides which messages belong to one instant. */
#include "recording_index.h"

#include <stdlib.h>
#include <string.h>

#include "host/reason.h"

#define RESTART_NS INT64_C(1000000000) /* stamps that go back so far are of a clock that began again */

static int by_stamp(const void *left, const void *right)
{
    const t3r_indexed_message *a = left, *b = right;
    if (a->stamp_ns != b->stamp_ns) {
        return a->stamp_ns < b->stamp_ns ? -1 : 1;
    }
    if (a->log_ns != b->log_ns) {
        return a->log_ns < b->log_ns ? -1 : 1;
    }
    return a->order < b->order ? -1 : a->order > b->order;
}

/* Returns the first message not before `stamp` and, of those of that stamp, not logged before `log`, in a stream sorted
 * by both; the stream's count if there is none. */
static size_t first_from(const t3r_stream *stream, int64_t stamp, int64_t log)
{
    size_t low = 0, high = stream->kept;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        const t3r_indexed_message *message = &stream->messages[middle];
        if (message->stamp_ns < stamp || (message->stamp_ns == stamp && message->log_ns < log)) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

/* Returns the message of the same stamp, of several the one logged nearest to `of`; else the message of the nearest
 * stamp; of two equally near the earlier. */
static size_t nearest(const t3r_stream *stream, const t3r_indexed_message *of)
{
    size_t after = first_from(stream, of->stamp_ns, of->log_ns);
    if (after == 0) {
        return stream->kept > 0 ? 0 : T3R_NO_MESSAGE;
    }
    if (after == stream->kept) {
        return after - 1;
    }
    const t3r_indexed_message *next = &stream->messages[after], *last = next - 1;
    int64_t gap_after = next->stamp_ns - of->stamp_ns, gap_before = of->stamp_ns - last->stamp_ns;
    if (gap_after == 0 && gap_before == 0) {
        gap_after = next->log_ns - of->log_ns;
        gap_before = of->log_ns - last->log_ns;
    }
    return gap_after < gap_before ? after : after - 1;
}

static int by_value(const void *left, const void *right)
{
    const int64_t *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

/* Returns the stamps of all colour images, ascending; NULL when memory is out. */
static int64_t *sorted_stamps(const t3r_stream *colour)
{
    int64_t *stamps = malloc((colour->kept + 1) * sizeof *stamps);
    for (size_t i = 0; stamps != NULL && i < colour->kept; i++) {
        stamps[i] = colour->messages[i].stamp_ns;
    }
    if (stamps != NULL) {
        qsort(stamps, colour->kept, sizeof *stamps, by_value);
    }
    return stamps;
}

/* ---- clocks that go back or stand ---- */

/* Whether messages were stamped by a clock that began again: their stamps, in the file's order, go back far, or go back
 * at all where some repeat. Writers that store messages slightly out of order do neither. */
static bool clock_restarts(const t3r_stream *stream, bool repeats)
{
    int64_t latest = INT64_MIN;
    for (size_t i = 0; i < stream->kept; i++) {
        const int64_t stamp = stream->messages[i].stamp_ns;
        if (i > 0 && (stamp < latest - RESTART_NS || (repeats && stamp < latest))) {
            return true;
        }
        latest = stamp > latest ? stamp : latest;
    }
    return false;
}

/* Whether messages were stamped by a clock that stood still, though they were logged one after another. */
static bool clock_stands(const t3r_stream *stream)
{
    size_t same = 1;
    while (same < stream->kept && stream->messages[same].stamp_ns == stream->messages[0].stamp_ns) {
        same++;
    }
    return stream->kept > 1 && same == stream->kept &&
           stream->messages[0].log_ns != stream->messages[stream->kept - 1].log_ns;
}

static const char *const goes_back = "go back", *const repeat = "repeat";

/* Returns what is wrong with the stamps of the colour images; NULL: they tell the images apart. */
static const char *fault_of_colour(const t3r_stream *colour, const int64_t *sorted)
{
    size_t repeated = 0;
    for (size_t i = 1; i < colour->kept; i++) {
        repeated += sorted[i] == sorted[i - 1];
    }
    return clock_restarts(colour, repeated > 0) ? goes_back : 2 * repeated >= colour->kept ? repeat : NULL;
}

static bool is_static(const t3r_stream *stream)
{
    static const char end[] = "tf_static";
    const size_t count = strlen(stream->topic), tail = sizeof end - 1;
    return count >= tail && strcmp(stream->topic + count - tail, end) == 0;
}

/* Returns the same of another stream. Transforms have several clocks, some of them ahead. */
static const char *fault_of_companion(const t3r_stream *stream)
{
    const bool has_place = stream->use == T3R_USE_POSE || stream->use == T3R_USE_DEPTH;
    const bool has_transforms = stream->use == T3R_USE_TRANSFORMS && !is_static(stream);
    return has_place && clock_restarts(stream, false)              ? goes_back
           : (has_place || has_transforms) && clock_stands(stream) ? repeat
                                                                   : NULL;
}

/* Replaces the stamps of all messages by their log times. Returns whether those of the colour images ascend. */
static bool use_log_times(t3r_recording *recording)
{
    const t3r_stream *colour = &recording->streams[recording->colour];
    for (size_t i = 1; i < colour->kept; i++) {
        if (colour->messages[i].log_ns <= colour->messages[i - 1].log_ns) {
            return false;
        }
    }
    for (size_t s = 0; s < recording->stream_count; s++) {
        for (size_t i = 0; i < recording->streams[s].kept; i++) {
            recording->streams[s].messages[i].stamp_ns = recording->streams[s].messages[i].log_ns;
        }
    }
    recording->pairing.by_log = true;
    return true;
}

/* Whether messages of other topics are paired with the colour images by their stamps. */
static bool has_companions(const t3r_recording *recording)
{
    return recording->depth != T3R_NO_STREAM || recording->pose != T3R_NO_STREAM ||
           recording->transforms != T3R_NO_STREAM;
}

/* Replaces the stamps where they do not tell messages apart. Returns the stamps of the colour images, ascending, or
 * NULL with a reason. */
static int64_t *usable_stamps(t3r_recording *recording, char *error, size_t error_bytes)
{
    const t3r_stream *colour = &recording->streams[recording->colour];
    int64_t *stamps = sorted_stamps(colour);
    const char *fault = stamps != NULL && has_companions(recording) ? fault_of_colour(colour, stamps) : NULL;
    const char *topic = colour->topic;
    for (size_t i = 0; fault == NULL && stamps != NULL && i < recording->stream_count; i++) {
        fault = fault_of_companion(&recording->streams[i]);
        topic = recording->streams[i].topic;
    }
    if (fault != NULL) {
        free(stamps);
        if (!use_log_times(recording)) {
            t3r_reason(
                error, error_bytes,
                "the stamps of %s %s, and the log times of %s do not rise either: split the file where they do not",
                topic, fault, colour->topic);
            return NULL;
        }
        t3r_recording_remark(recording, "the stamps of %s %s: log times are used instead", topic, fault);
        stamps = sorted_stamps(colour);
    }
    if (stamps == NULL) {
        t3r_reason(error, error_bytes, "out of memory");
    }
    return stamps;
}

/* Returns the nearest message within near_ns, unless its stamp is exactly another colour image's; widens *worst_ns to
 * its distance. */
static size_t pair_near(const t3r_stream *stream, const t3r_indexed_message *of, const int64_t *taken,
                        size_t taken_count, int64_t near_ns, int64_t *worst_ns)
{
    size_t found = nearest(stream, of);
    if (found == T3R_NO_MESSAGE) {
        return found;
    }
    int64_t gap = stream->messages[found].stamp_ns - of->stamp_ns;
    gap = gap < 0 ? -gap : gap;
    if (gap > near_ns ||
        (gap > 0 && bsearch(&stream->messages[found].stamp_ns, taken, taken_count, sizeof *taken, by_value) != NULL)) {
        return T3R_NO_MESSAGE;
    }
    *worst_ns = gap > *worst_ns ? gap : *worst_ns;
    return found;
}

/* Returns the intrinsics in force at `stamp`: the message of the same stamp, else the last one before, else the
 * first. */
static size_t pair_standing(const t3r_stream *stream, int64_t stamp)
{
    size_t after = first_from(stream, stamp, INT64_MIN);
    if (stream->kept == 0) {
        return T3R_NO_MESSAGE;
    }
    bool same = after < stream->kept && stream->messages[after].stamp_ns == stamp;
    return same || after == 0 ? after : after - 1;
}

int t3r_recording_pair(t3r_recording *recording, char *error, size_t error_bytes)
{
    if (recording->colour == T3R_NO_STREAM) {
        return 0;
    }
    int64_t *taken = usable_stamps(recording, error, error_bytes);
    if (taken == NULL) {
        return -1;
    }
    static const t3r_stream none = {0};
    const t3r_stream *colour = &recording->streams[recording->colour];
    const t3r_stream *depth = &none, *pose = &none, *camera_info = &none, *depth_info = &none;
    const struct {
        size_t index;
        const t3r_stream **stream;
    } companions[] = {{recording->depth, &depth},
                      {recording->pose, &pose},
                      {recording->camera_info, &camera_info},
                      {recording->depth_camera_info, &depth_info}};
    for (size_t i = 0; i < sizeof companions / sizeof companions[0]; i++) {
        if (companions[i].index != T3R_NO_STREAM) {
            t3r_stream *stream = &recording->streams[companions[i].index];
            if (stream->kept > 1) {
                qsort(stream->messages, stream->kept, sizeof *stream->messages, by_stamp);
            }
            *companions[i].stream = stream;
        }
    }
    recording->links = calloc(colour->kept > 0 ? colour->kept : 1, sizeof *recording->links);
    recording->depth_z16 = calloc(depth->kept > 0 ? depth->kept : 1, sizeof *recording->depth_z16);
    recording->depth_beyond = calloc(1, sizeof *recording->depth_beyond);
    if (recording->links == NULL || recording->depth_z16 == NULL || recording->depth_beyond == NULL) {
        free(taken);
        return t3r_reason(error, error_bytes, "out of memory");
    }
    t3r_pairing_info *pairing = &recording->pairing;
    pairing->frames = (uint32_t)colour->kept;
    for (size_t i = 0; i < colour->kept; i++) {
        t3r_frame_links *links = &recording->links[i];
        const t3r_indexed_message *image = &colour->messages[i];
        links->depth = pair_near(depth, image, taken, colour->kept, recording->pair_ns, &pairing->worst_depth_gap_ns);
        links->pose = pair_near(pose, image, taken, colour->kept, recording->pair_ns, &pairing->worst_pose_gap_ns);
        links->camera_info = pair_standing(camera_info, image->stamp_ns);
        links->depth_camera_info = pair_standing(depth_info, image->stamp_ns);
        pairing->with_depth += links->depth != T3R_NO_MESSAGE;
        pairing->with_pose += links->pose != T3R_NO_MESSAGE;
        pairing->with_intrinsics += links->camera_info != T3R_NO_MESSAGE;
    }
    free(taken);
    return 0;
}
