/* SPDX-License-Identifier: Apache-2.0 */
/* Chooses the streams that make up the frames, and gives reasons for the others. */
#include <stdio.h>
#include <string.h>

#include "host/reason.h"
#include "recording_index.h"

#define NO_STREAM T3R_NO_STREAM
#define MOST_LEVELS 8u /* levels of a topic that are compared: bounds the cost of names full of slashes */

const char *const t3r_stream_use_names[T3R_USE_COUNT] = {
    "", "colour", "depth", "camera_info", "camera_info of depth", "pose", "transforms"};

/* Returns the length of the topic up to and including the slash before its name. An image_transport topic such as
 * /a/image_raw/compressed counts as the topic that it was made from. */
static size_t prefix_bytes(const t3r_stream *stream)
{
    size_t slashes[2] = {0, 0}; /* lengths up to the last slash and up to the one before */
    for (size_t i = 0; stream->topic[i] != '\0'; i++) {
        if (stream->topic[i] == '/') {
            slashes[1] = slashes[0];
            slashes[0] = i + 1;
        }
    }
    bool transported = strncmp(stream->topic + slashes[0], "compressed", 10) == 0;
    return stream->compressed && transported && slashes[1] > 1 ? slashes[1] : slashes[0];
}

static bool is_below(const t3r_stream *stream, const t3r_stream *of, size_t prefix)
{
    return prefix > 1 && strncmp(stream->topic, of->topic, prefix) == 0;
}

static bool has_role(const t3r_recording *recording, size_t i, t3r_stream_role role)
{
    return recording->streams[i].role == role;
}

/* Chooses the first stream that is neither compressed nor mono, else the first not mono, else the first. */
static size_t choose_colour(const t3r_recording *recording)
{
    size_t best = NO_STREAM;
    uint32_t best_rank = 3;
    for (size_t i = 0; i < recording->stream_count; i++) {
        const t3r_stream *stream = &recording->streams[i];
        uint32_t rank = stream->mono ? 2 : stream->compressed ? 1 : 0;
        if (stream->role == T3R_STREAM_COLOUR && rank < best_rank) {
            best = i;
            best_rank = rank;
        }
    }
    return best;
}

/* Chooses the first stream of this role below another stream's prefix, else the only one in the file. */
static size_t choose_companion(const t3r_recording *recording, t3r_stream_role role, size_t of)
{
    const t3r_stream *camera = &recording->streams[of];
    size_t prefix = prefix_bytes(camera), only = NO_STREAM, count = 0;
    for (size_t i = 0; i < recording->stream_count; i++) {
        if (has_role(recording, i, role)) {
            if (is_below(&recording->streams[i], camera, prefix)) {
                return i;
            }
            only = i;
            count++;
        }
    }
    return count == 1 ? only : NO_STREAM;
}

/* Ranks a depth stream among those below a prefix. */
static uint32_t depth_rank(const t3r_recording *recording, size_t i)
{
    const t3r_stream *stream = &recording->streams[i], *colour = &recording->streams[recording->colour];
    return 1 + (stream->compressed ? 0u : 1u) + (t3r_text_same(stream->frame_id, colour->frame_id) ? 2u : 0u);
}

static size_t prefix_above(const t3r_stream *stream, size_t prefix)
{
    do {
        prefix--;
    } while (prefix > 0 && stream->topic[prefix - 1] != '/');
    return prefix;
}

/* Chooses depth below the longest prefix of the colour topic that has any; if that is the root, only a single
 * stream. */
static size_t choose_depth(const t3r_recording *recording)
{
    const t3r_stream *colour = &recording->streams[recording->colour];
    size_t prefix = prefix_bytes(colour);
    for (uint32_t levels = 0; prefix > 1 && levels < MOST_LEVELS; levels++, prefix = prefix_above(colour, prefix)) {
        size_t best = NO_STREAM;
        uint32_t best_rank = 0;
        for (size_t i = 0; i < recording->stream_count; i++) {
            bool candidate =
                has_role(recording, i, T3R_STREAM_DEPTH) && is_below(&recording->streams[i], colour, prefix);
            if (candidate && depth_rank(recording, i) > best_rank) {
                best = i;
                best_rank = depth_rank(recording, i);
            }
        }
        if (best != NO_STREAM) {
            return best;
        }
    }
    return choose_companion(recording, T3R_STREAM_DEPTH, recording->colour);
}

/* Chooses the depth camera's own camera_info: the one below depth's prefix, if this is not colour's. */
static size_t choose_depth_info(const t3r_recording *recording)
{
    if (recording->depth == NO_STREAM) {
        return NO_STREAM;
    }
    const t3r_stream *depth = &recording->streams[recording->depth];
    for (size_t i = 0; i < recording->stream_count; i++) {
        if (has_role(recording, i, T3R_STREAM_CAMERA_INFO) &&
            is_below(&recording->streams[i], depth, prefix_bytes(depth))) {
            return i == recording->camera_info ? NO_STREAM : i;
        }
    }
    return NO_STREAM;
}

/* Finds the topic of that name and role. *found is unchanged without a name. */
static int find_named(const t3r_recording *recording, const char *topic, t3r_stream_role role, const char *what,
                      size_t *found, char *error, size_t error_bytes)
{
    bool there = false;
    for (size_t i = 0; topic != NULL && i < recording->stream_count; i++) {
        bool named = strcmp(recording->streams[i].topic, topic) == 0;
        there = there || named;
        if (named && has_role(recording, i, role)) {
            *found = i;
            return 0;
        }
    }
    if (topic == NULL) {
        return 0;
    }
    return t3r_reason(error, error_bytes, there ? "topic %s holds no %s" : "there is no topic %s (for %s)", topic,
                      what);
}

/* ---- uses, and reasons against them ---- */

static void mark(t3r_recording *recording, size_t i, t3r_stream_use use)
{
    if (i != NO_STREAM) {
        recording->streams[i].use = use;
    }
}

/* Whether frames need transforms: there are no other poses, or the poses belong to another frame than colour's. */
static bool needs_transforms(const t3r_recording *recording)
{
    t3r_text camera = recording->streams[recording->colour].frame_id;
    if (recording->pose == NO_STREAM) {
        return true;
    }
    t3r_text child = recording->streams[recording->pose].child_frame_id;
    return (child.count > 0 && !t3r_text_same(child, camera)) ||
           (recording->depth != NO_STREAM && !t3r_text_same(recording->streams[recording->depth].frame_id, camera));
}

static void say_why(t3r_recording *recording, t3r_stream *stream)
{
    static const t3r_stream_use uses[] = {[T3R_STREAM_COLOUR] = T3R_USE_COLOUR,
                                          [T3R_STREAM_DEPTH] = T3R_USE_DEPTH,
                                          [T3R_STREAM_CAMERA_INFO] = T3R_USE_CAMERA_INFO,
                                          [T3R_STREAM_POSE] = T3R_USE_POSE,
                                          [T3R_STREAM_TF] = T3R_USE_POSE};
    if (stream->unused[0] != '\0') {
        return;
    }
    if (stream->role == T3R_STREAM_OTHER) {
        const char *why = stream->type == T3R_ROS_TYPE_COUNT ? "its type is not read" : "it has no messages";
        snprintf(stream->unused, sizeof stream->unused, "%s", why);
        return;
    }
    size_t other = t3r_recording_stream_for(recording, uses[stream->role]);
    if (other != NO_STREAM) {
        t3r_reason(stream->unused, sizeof stream->unused, "%s comes from %.64s",
                   t3r_stream_use_names[uses[stream->role]], recording->streams[other].topic);
    } else {
        t3r_reason(stream->unused, sizeof stream->unused, "%s",
                   recording->colour == NO_STREAM ? "there are no colour images"
                                                  : "there are several, and none is near the colour topic: name one");
    }
}

static void mark_all(t3r_recording *recording)
{
    mark(recording, recording->colour, T3R_USE_COLOUR);
    mark(recording, recording->depth, T3R_USE_DEPTH);
    mark(recording, recording->camera_info, T3R_USE_CAMERA_INFO);
    mark(recording, recording->depth_camera_info, T3R_USE_DEPTH_CAMERA_INFO);
    mark(recording, recording->pose, T3R_USE_POSE);
    bool transforms = recording->colour != NO_STREAM && needs_transforms(recording);
    for (size_t i = 0; i < recording->stream_count && transforms; i++) {
        if (has_role(recording, i, T3R_STREAM_TF)) {
            mark(recording, i, T3R_USE_TRANSFORMS);
            recording->transforms = recording->transforms == NO_STREAM ? i : recording->transforms;
        }
    }
    for (size_t i = 0; i < recording->stream_count; i++) {
        t3r_stream *stream = &recording->streams[i];
        if (stream->use == T3R_USE_NONE) {
            say_why(recording, stream);
        }
        if (stream->use == T3R_USE_NONE && stream->role != T3R_STREAM_OTHER && stream->role != T3R_STREAM_TF &&
            recording->colour != NO_STREAM) {
            t3r_recording_remark(recording, "%s is not used", stream->topic);
        }
    }
}

static void remark_reason(t3r_recording *recording, const char **reason, const char *why, const char *what)
{
    *reason = why;
    t3r_recording_remark(recording, "%s: trim3r import %s", why, what);
}

/* Adds remarks on what frames lack if they are read without import. */
static void remark_import(t3r_recording *recording)
{
    const t3r_stream *colour = &recording->streams[recording->colour];
    const t3r_stream *depth = recording->depth == NO_STREAM ? NULL : &recording->streams[recording->depth];
    const t3r_stream *pose = recording->pose == NO_STREAM ? NULL : &recording->streams[recording->pose];
    if (depth != NULL && !t3r_text_same(depth->frame_id, colour->frame_id)) {
        remark_reason(recording, &recording->import_reason, "depth is of another frame than colour", "registers it");
    }
    if (colour->compressed || (depth != NULL && depth->compressed)) {
        remark_reason(recording, &recording->import_reason, "images are compressed", "decodes them");
    }
    if (pose == NULL && t3r_recording_stream_for(recording, T3R_USE_TRANSFORMS) != NO_STREAM) {
        remark_reason(recording, &recording->import_pose_reason, "poses are transforms", "composes them");
    }
    if (pose != NULL && pose->child_frame_id.count > 0 && !t3r_text_same(pose->child_frame_id, colour->frame_id)) {
        remark_reason(recording, &recording->import_pose_reason, "poses are of another frame than colour",
                      "composes them");
    }
}

int t3r_recording_choose(t3r_recording *recording, const t3r_recording_choice *choice, char *error, size_t error_bytes)
{
    recording->colour = choose_colour(recording);
    if (find_named(recording, choice->colour, T3R_STREAM_COLOUR, "colour images", &recording->colour, error,
                   error_bytes) != 0) {
        return -1;
    }
    if (recording->colour == NO_STREAM) {
        t3r_recording_remark(recording, "holds no colour images in a format that can be read");
        mark_all(recording);
        return 0;
    }
    recording->depth = choose_depth(recording);
    recording->pose = choose_companion(recording, T3R_STREAM_POSE, recording->colour);
    recording->camera_info = choose_companion(recording, T3R_STREAM_CAMERA_INFO, recording->colour);
    if (find_named(recording, choice->depth, T3R_STREAM_DEPTH, "depth images", &recording->depth, error, error_bytes) !=
            0 ||
        find_named(recording, choice->pose, T3R_STREAM_POSE, "poses", &recording->pose, error, error_bytes) != 0 ||
        find_named(recording, choice->camera_info, T3R_STREAM_CAMERA_INFO, "intrinsics", &recording->camera_info, error,
                   error_bytes) != 0) {
        return -1;
    }
    recording->depth_camera_info = choose_depth_info(recording);
    if (find_named(recording, choice->depth_camera_info, T3R_STREAM_CAMERA_INFO, "intrinsics",
                   &recording->depth_camera_info, error, error_bytes) != 0) {
        return -1;
    }
    mark_all(recording);
    remark_import(recording);
    return 0;
}
