/* SPDX-License-Identifier: Apache-2.0 */
/* Chooses the streams that make up the frames, and gives reasons for the others. */
#include <string.h>

#include "host/reason.h"
#include "recording_index.h"

#define NO_STREAM T3R_NO_STREAM
#define MOST_COMPARED                                                                                                  \
    4096u              /* streams that each image stream is compared with: bounds the cost of files full of topics */
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

/* Whether both streams name their frames, and the same one. */
static bool same_frame(const t3r_stream *a, const t3r_stream *b)
{
    return a->frame_id.count > 0 && t3r_text_same(a->frame_id, b->frame_id);
}

static bool other_frame(const t3r_stream *a, const t3r_stream *b)
{
    return a->frame_id.count > 0 && b->frame_id.count > 0 && !t3r_text_same(a->frame_id, b->frame_id);
}

/* ---- votes ---- */

/* Returns the votes for stream `i` as the companion of stream `of`; 0: it is none. */
typedef uint32_t vote(const t3r_recording *recording, size_t i, size_t of);

/* Counts the votes for a stream as camera_info of an image stream: both must share the frame. */
static uint32_t votes_for_info(const t3r_recording *recording, size_t i, size_t of)
{
    const t3r_stream *info = &recording->streams[i], *images = &recording->streams[of];
    if (info->role != T3R_STREAM_CAMERA_INFO || other_frame(info, images)) {
        return 0;
    }
    const size_t prefix = prefix_bytes(images);
    const bool below = is_below(info, images, prefix);
    const bool usual_name = below && strcmp(info->topic + prefix, "camera_info") == 0;
    return 1u + (usual_name ? 1u : 0u) + (same_frame(info, images) ? 2u : 0u) + (below ? 4u : 0u);
}

static bool depth_is_of(const t3r_recording *recording, const t3r_stream *colour)
{
    for (size_t i = 0; i < recording->stream_count && i < MOST_COMPARED; i++) {
        if (has_role(recording, i, T3R_STREAM_DEPTH) && !t3r_topic_is_no_depth(recording->streams[i].topic) &&
            same_frame(&recording->streams[i], colour)) {
            return true;
        }
    }
    return false;
}

/* Whether an image stream has a camera_info beside it. */
static bool has_info(const t3r_recording *recording, size_t of)
{
    for (size_t i = 0; i < recording->stream_count && i < MOST_COMPARED; i++) {
        if (votes_for_info(recording, i, of) >= 4) {
            return true;
        }
    }
    return false;
}

static uint32_t votes_for_colour(const t3r_recording *recording, size_t i, size_t of)
{
    (void)of;
    const t3r_stream *stream = &recording->streams[i];
    if (stream->role != T3R_STREAM_COLOUR) {
        return 0;
    }
    return 1u + (stream->compressed ? 0u : 1u) + (depth_is_of(recording, stream) ? 1u : 0u) + (stream->mono ? 0u : 2u) +
           (has_info(recording, i) ? 3u : 0u) + (t3r_topic_is_no_colour(stream->topic) ? 0u : 4u);
}

static size_t prefix_above(const t3r_stream *stream, size_t prefix)
{
    do {
        prefix--;
    } while (prefix > 0 && stream->topic[prefix - 1] != '/');
    return prefix;
}

/* Returns how many levels of its topic's prefix a stream shares with another. */
static uint32_t shared_levels(const t3r_stream *stream, const t3r_stream *of)
{
    uint32_t levels = MOST_LEVELS;
    for (size_t prefix = prefix_bytes(of); prefix > 1 && levels > 0; prefix = prefix_above(of, prefix), levels--) {
        if (is_below(stream, of, prefix)) {
            return levels;
        }
    }
    return 0;
}

static uint32_t votes_for_depth(const t3r_recording *recording, size_t i, size_t of)
{
    const t3r_stream *stream = &recording->streams[i], *colour = &recording->streams[of];
    if (stream->role != T3R_STREAM_DEPTH || t3r_topic_is_no_depth(stream->topic)) {
        return 0;
    }
    return 1u + (stream->compressed ? 0u : 1u) + (t3r_topic_is_depth(stream->topic) ? 2u : 0u) +
           (same_frame(stream, colour) ? 4u : 0u) + 8u * shared_levels(stream, colour) + (stream->mono ? 0u : 128u);
}

/* Whether poses are in the frame of the camera, and not of the camera: of things that it sees. */
static bool is_seen_by(const t3r_stream *poses, const t3r_stream *colour)
{
    return same_frame(poses, colour) && !t3r_text_same(poses->child_frame_id, colour->frame_id);
}

static uint32_t votes_for_pose(const t3r_recording *recording, size_t i, size_t of)
{
    const t3r_stream *stream = &recording->streams[i], *colour = &recording->streams[of];
    if (stream->role != T3R_STREAM_POSE || t3r_topic_is_no_pose(stream->topic) || is_seen_by(stream, colour)) {
        return 0;
    }
    const bool of_camera = stream->child_frame_id.count > 0 && t3r_text_same(stream->child_frame_id, colour->frame_id);
    return 1u + (is_below(stream, colour, prefix_bytes(colour)) ? 2u : 0u) + (of_camera ? 4u : 0u);
}

/* Returns the stream with the most votes, the first of several of one camera. *tied: as many votes are for a stream of
 * another camera. */
static size_t elect(const t3r_recording *recording, vote *votes, size_t of, bool *tied)
{
    size_t best = NO_STREAM;
    uint32_t most = 0;
    *tied = false;
    for (size_t i = 0; i < recording->stream_count; i++) {
        const uint32_t count = votes(recording, i, of);
        if (count > most) {
            best = i;
            most = count;
            *tied = false;
        } else if (count > 0 && count == most) {
            *tied = *tied || votes == votes_for_pose || !same_frame(&recording->streams[i], &recording->streams[best]);
        }
    }
    return best;
}

static size_t elect_one(const t3r_recording *recording, vote *votes, size_t of)
{
    bool tied;
    const size_t best = elect(recording, votes, of, &tied);
    return tied ? NO_STREAM : best;
}

/* Takes the first of equally good colour topics, and notes that one must be named. */
static size_t elect_colour(t3r_recording *recording)
{
    bool tied;
    const size_t best = elect(recording, votes_for_colour, 0, &tied);
    if (!tied) {
        return best;
    }
    const uint32_t most = votes_for_colour(recording, best, 0);
    t3r_reason(recording->asks, sizeof recording->asks, "several topics may be the colour camera's:");
    for (size_t i = 0; i < recording->stream_count; i++) {
        const size_t used = strlen(recording->asks);
        if (votes_for_colour(recording, i, 0) == most && used + 96 < sizeof recording->asks) {
            t3r_reason(recording->asks + used, sizeof recording->asks - used, "%s %.64s", i == best ? "" : ",",
                       recording->streams[i].topic);
        }
    }
    const size_t used = strlen(recording->asks);
    t3r_reason(recording->asks + used, sizeof recording->asks - used, "; name one with --colour-topic");
    return best;
}

/* Chooses the depth camera's own camera_info, if that is not colour's. */
static size_t choose_depth_info(const t3r_recording *recording)
{
    if (recording->depth == NO_STREAM) {
        return NO_STREAM;
    }
    const size_t info = elect_one(recording, votes_for_info, recording->depth);
    return info == recording->camera_info ||
                   (info != NO_STREAM && votes_for_info(recording, info, recording->depth) < 3)
               ? NO_STREAM
               : info;
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
        if (named && role == T3R_STREAM_POSE && has_role(recording, i, T3R_STREAM_TF)) {
            *found = NO_STREAM; /* poses are composed of transforms */
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

/* Returns why a stream of a role without a use is not taken, though no other one is. */
static const char *why_not(const t3r_recording *recording, const t3r_stream *stream)
{
    const t3r_stream *colour = recording->colour == NO_STREAM ? NULL : &recording->streams[recording->colour];
    if (colour == NULL) {
        return "there are no colour images";
    }
    switch (stream->role) {
    case T3R_STREAM_DEPTH:
        return t3r_topic_is_no_depth(stream->topic) ? "its name is not one of depth: --depth-topic takes it"
                                                    : "several are equally near to colour: --depth-topic names one";
    case T3R_STREAM_CAMERA_INFO:
        return recording->intrinsics_given   ? "intrinsics are given"
               : other_frame(stream, colour) ? "its frame is not that of the images: --camera-info-topic takes it"
                                             : "several are equally near to colour: --camera-info-topic names one";
    case T3R_STREAM_POSE:
        return is_seen_by(stream, colour)            ? "its poses are in the camera's own frame: --pose-topic takes it"
               : t3r_topic_is_no_pose(stream->topic) ? "its name is one of goals or objects: --pose-topic takes it"
                                                     : "several may be the camera's: --pose-topic names one";
    default:
        return "poses come from another topic";
    }
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
        const char *why = stream->type == T3R_ROS_TYPE_COUNT ? "its type is not read"
                          : stream->left_out > 0             ? "none of its messages can be read"
                                                             : "it has no messages";
        t3r_reason(stream->unused, sizeof stream->unused, "%s", why);
        return;
    }
    size_t other = t3r_recording_stream_for(recording, uses[stream->role]);
    if (other != NO_STREAM) {
        t3r_reason(stream->unused, sizeof stream->unused, "%s comes from %.64s",
                   t3r_stream_use_names[uses[stream->role]], recording->streams[other].topic);
    } else {
        t3r_reason(stream->unused, sizeof stream->unused, "%s", why_not(recording, stream));
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
    if (colour->converted) {
        remark_reason(recording, &recording->import_reason, "images are in an encoding that replay does not read",
                      "converts them");
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
    recording->colour = elect_colour(recording);
    if (find_named(recording, choice->colour, T3R_STREAM_COLOUR, "colour images", &recording->colour, error,
                   error_bytes) != 0) {
        return -1;
    }
    if (choice->colour != NULL) {
        recording->asks[0] = '\0';
    }
    if (recording->colour == NO_STREAM) {
        t3r_recording_remark(recording, "holds no colour images in a format that can be read");
        mark_all(recording);
        return 0;
    }
    if (recording->asks[0] != '\0') {
        t3r_recording_remark(recording, "%s", recording->asks);
    }
    recording->depth = elect_one(recording, votes_for_depth, recording->colour);
    recording->pose = elect_one(recording, votes_for_pose, recording->colour);
    recording->camera_info = elect_one(recording, votes_for_info, recording->colour);
    if (find_named(recording, choice->depth, T3R_STREAM_DEPTH, "depth images", &recording->depth, error, error_bytes) !=
            0 ||
        find_named(recording, choice->pose, T3R_STREAM_POSE, "poses", &recording->pose, error, error_bytes) != 0 ||
        find_named(recording, choice->camera_info, T3R_STREAM_CAMERA_INFO, "intrinsics", &recording->camera_info, error,
                   error_bytes) != 0) {
        return -1;
    }
    recording->depth_camera_info = choose_depth_info(recording);
    if (choice->intrinsics != NULL) {
        recording->intrinsics = *choice->intrinsics;
        recording->intrinsics_given = true;
        recording->camera_info = NO_STREAM;
    }
    if (find_named(recording, choice->depth_camera_info, T3R_STREAM_CAMERA_INFO, "intrinsics",
                   &recording->depth_camera_info, error, error_bytes) != 0) {
        return -1;
    }
    mark_all(recording);
    remark_import(recording);
    return 0;
}
