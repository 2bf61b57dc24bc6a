/* SPDX-License-Identifier: Apache-2.0 */
#include "import/bags/bag_frames.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry/quaternion.h"
#include "host/reason.h"
#include "import/bags/bag_straight.h"
#include "import/depth/register_depth.h"
#include "import/frames/straighten.h"
#include "messages/fixed_camera.h"
#include "messages/fixed_double.h"
#include "messages/message_frame.h"
#include "messages/ros_messages.h"
#include "pictures/picture_shape.h"

/* ---- reading ---- */

static double number(uint64_t f64)
{
    double value;
    memcpy(&value, &f64, sizeof value);
    return value;
}

/* Converts a pose that t3r_message_pose_error() accepts. */
static rigid rigid_of(const t3r_ros_pose *pose)
{
    rigid out;
    for (int i = 0; i < 3; i++) {
        out.position[i] = number(pose->position_f64[i]);
    }
    for (int i = 0; i < 4; i++) {
        out.rotation[(i + 1) % 4] = number(pose->rotation_f64[i]); /* x y z w */
    }
    quaternion_normalise(out.rotation);
    return out;
}

static const char *add_transforms(bag_frames *b, const t3r_recorded_message *message, bool standing)
{
    const bool by_log = t3r_recording_pairing(b->recording).by_log;
    t3r_ros_tf tf;
    const char *wrong = t3r_ros_open_tf(message->data, message->bytes, &tf);
    while (wrong == NULL && tf.left > 0) {
        t3r_ros_pose transform;
        wrong = t3r_ros_next_tf(&tf, &transform);
        if (wrong == NULL && t3r_message_transform_error(&transform) == NULL) { /* others were counted on indexing */
            const rigid place = rigid_of(&transform);
            int64_t stamp = transform.header.stamp_ns != 0 && !by_log ? transform.header.stamp_ns : message->stamp_ns;
            wrong = transform_tree_add(&b->tree, transform.header.frame_id, transform.child_frame_id, standing, stamp,
                                       &place);
        }
    }
    return wrong;
}

static bool ends_with(const char *text, const char *end)
{
    size_t count = strlen(text), tail = strlen(end);
    return count >= tail && strcmp(text + count - tail, end) == 0;
}

static int read_transforms(bag_frames *b, char *error, size_t error_bytes)
{
    for (uint32_t s = 0; s < t3r_recording_stream_count(b->recording); s++) {
        t3r_stream_info info = t3r_recording_stream(b->recording, s);
        bool transforms =
            strcmp(info.schema, "tf2_msgs/msg/TFMessage") == 0 || strcmp(info.schema, "tf2_msgs/TFMessage") == 0;
        uint32_t count = transforms ? t3r_recording_message_count(b->recording, s) : 0;
        for (uint32_t i = 0; i < count; i++) {
            t3r_recorded_message message = t3r_recording_message(b->recording, s, i);
            const char *wrong = add_transforms(b, &message, ends_with(info.topic, "tf_static"));
            if (wrong != NULL) {
                return t3r_reason(error, error_bytes, "%s, message %" PRIu32 ": %s", info.topic, i, wrong);
            }
        }
    }
    const char *wrong = transform_tree_finish(&b->tree);
    return wrong == NULL ? 0 : t3r_reason(error, error_bytes, "transforms: %s", wrong);
}

static t3r_ros_type pose_type(const char *schema)
{
    t3r_text name = t3r_text_of(schema);
    uint32_t type = 0;
    while (type < T3R_ROS_TYPE_COUNT &&
           !(t3r_ros_is_pose((t3r_ros_type)type) && t3r_ros_is_named((t3r_ros_type)type, name))) {
        type++;
    }
    return (t3r_ros_type)type;
}

static int read_poses(bag_frames *b, char *error, size_t error_bytes)
{
    size_t stream = t3r_recording_stream_for(b->recording, T3R_USE_POSE);
    uint32_t count = t3r_recording_message_count(b->recording, stream);
    if (count == 0) {
        return 0;
    }
    t3r_stream_info info = t3r_recording_stream(b->recording, (uint32_t)stream);
    t3r_ros_type type = pose_type(info.schema);
    for (uint32_t i = 0; i < count; i++) {
        t3r_recorded_message message = t3r_recording_message(b->recording, stream, i);
        t3r_ros_pose pose;
        const char *wrong = t3r_ros_read_pose(type, message.data, message.bytes, &pose);
        const rigid place = wrong == NULL ? rigid_of(&pose) : rigid_identity;
        if (wrong == NULL && !pose_track_add(&b->poses, message.stamp_ns, &place)) {
            wrong = "out of memory";
        }
        if (wrong != NULL) {
            return t3r_reason(error, error_bytes, "%s, message %" PRIu32 ": %s", info.topic, i, wrong);
        }
        b->pose_parent = i == 0 ? transform_tree_name(pose.header.frame_id) : b->pose_parent;
        b->pose_child = i == 0 ? transform_tree_name(pose.child_frame_id) : b->pose_child;
    }
    pose_track_sort(&b->poses);
    return 0;
}

/* Returns the frame_id of the first message of that use. */
static t3r_text frame_of(const t3r_recording *recording, t3r_stream_use use)
{
    size_t stream = t3r_recording_stream_for(recording, use);
    t3r_text none = {"", 0};
    if (t3r_recording_message_count(recording, stream) == 0) {
        return none;
    }
    t3r_recorded_message message = t3r_recording_message(recording, stream, 0);
    t3r_cdr_reader in; /* all these messages begin with a header */
    t3r_cdr_open(&in, message.data, message.bytes);
    t3r_cdr_get_u32(&in);
    t3r_cdr_get_u32(&in);
    return transform_tree_name(t3r_cdr_get_string(&in));
}

int bag_frames_open(bag_frames *b, const t3r_recording *recording, const bag_frames_options *options, char *error,
                    size_t error_bytes)
{
    *b = (bag_frames){.recording = recording, .options = *options, .pose_parent = {"", 0}, .pose_child = {"", 0}};
    b->camera = options->camera_frame != NULL ? transform_tree_name(t3r_text_of(options->camera_frame))
                                              : frame_of(recording, T3R_USE_COLOUR);
    if (b->camera.count == 0) {
        b->camera = frame_of(recording, T3R_USE_CAMERA_INFO);
    }
    b->fixed = transform_tree_name(t3r_text_of(options->fixed_frame != NULL ? options->fixed_frame : ""));
    if (read_transforms(b, error, error_bytes) != 0 || read_poses(b, error, error_bytes) != 0) {
        return -1;
    }
    if (options->fixed_frame != NULL && !t3r_text_same(b->fixed, b->pose_parent) &&
        transform_tree_find(&b->tree, b->fixed) == TRANSFORM_NO_FRAME) {
        return t3r_reason(error, error_bytes, "no transform and no pose has the frame %s", options->fixed_frame);
    }
    return 0;
}

/* ---- poses ---- */

static void remark(bag_frames *b, const char *what, t3r_text from, t3r_text to)
{
    char a[64], c[64];
    t3r_text_copy(a, sizeof a, from);
    t3r_text_copy(c, sizeof c, to);
    if (b->remark[0] == '\0') {
        t3r_reason(b->remark, sizeof b->remark, "%s from '%s' to '%s'", what, a, c);
    }
}

static bool lookup(const bag_frames *b, t3r_text to, t3r_text from, int64_t stamp_ns, rigid *out)
{
    return transform_tree_lookup(&b->tree, transform_tree_find(&b->tree, to), transform_tree_find(&b->tree, from),
                                 stamp_ns, b->options.near_ns, out);
}

/* Gets the pose from transforms only. */
static bool pose_of_tree(bag_frames *b, int64_t stamp_ns, rigid *out)
{
    uint32_t camera = transform_tree_find(&b->tree, b->camera);
    if (camera == TRANSFORM_NO_FRAME) {
        return false;
    }
    if (b->fixed.count == 0 && !transform_tree_moves(&b->tree, camera)) { /* frames inside a rigid rig are no poses */
        remark(b, "no pose topic was chosen, and no transform that changes leads", b->camera,
               (t3r_text){"its root", 8});
        return false;
    }
    t3r_text to =
        b->fixed.count > 0 ? b->fixed : t3r_text_of(b->tree.frames[transform_tree_root(&b->tree, camera)].name);
    if (t3r_text_same(to, b->camera) || !lookup(b, to, b->camera, stamp_ns, out)) {
        remark(b, "at some times there is no transform", b->camera, to);
        return false;
    }
    return true;
}

/* Gets the pose from the pose topic, with transforms on either side if its frames are not the requested ones. */
static bool pose_of_topic(bag_frames *b, int64_t stamp_ns, rigid *out)
{
    if (!pose_track_at(&b->poses, stamp_ns, b->options.near_ns, out)) {
        return false;
    }
    rigid more;
    bool other_child = b->pose_child.count > 0 && !t3r_text_same(b->pose_child, b->camera);
    if (other_child && !lookup(b, b->pose_child, b->camera, stamp_ns, &more)) {
        remark(b, "there is no transform", b->camera, b->pose_child);
        return false;
    }
    if (other_child) {
        *out = rigid_compose(out, &more);
    }
    bool other_parent = b->fixed.count > 0 && !t3r_text_same(b->fixed, b->pose_parent);
    if (other_parent && !lookup(b, b->fixed, b->pose_parent, stamp_ns, &more)) {
        remark(b, "there is no transform", b->pose_parent, b->fixed);
        return false;
    }
    if (other_parent) {
        *out = rigid_compose(&more, out);
    }
    b->composed += other_child || other_parent;
    return true;
}

/* Whether the recording's own pose is the requested one. */
static bool is_as_asked(const bag_frames *b, uint32_t index, int64_t stamp_ns)
{
    t3r_recorded_message pose = t3r_recording_frame_message(b->recording, index, T3R_USE_POSE);
    return pose.data != NULL && pose.stamp_ns == stamp_ns &&
           (b->pose_child.count == 0 || t3r_text_same(b->pose_child, b->camera)) &&
           (b->fixed.count == 0 || t3r_text_same(b->fixed, b->pose_parent));
}

static int make_pose(bag_frames *b, uint32_t index, t3r_capture_frame *frame, char *error, size_t error_bytes)
{
    if (b->options.keep_poses || (frame->has_pose && is_as_asked(b, index, frame->stamp_ns))) {
        return 0;
    }
    rigid pose;
    bool topic = b->poses.count > 0;
    frame->has_pose = topic ? pose_of_topic(b, frame->stamp_ns, &pose) : pose_of_tree(b, frame->stamp_ns, &pose);
    if (!frame->has_pose) {
        b->unposed++;
        return 0;
    }
    b->interpolated += topic;
    b->composed += !topic;
    bool fits = true;
    for (int i = 0; i < 3; i++) {
        fits = fits && t3r_fixed_position(t3r_double_bits(pose.position[i]), &frame->camera.position_q32[i]);
    }
    for (int i = 0; i < 4; i++) {
        fits = fits && t3r_fixed_rotation(t3r_double_bits(pose.rotation[i]), &frame->camera.rotation_q30[i]);
    }
    return fits ? 0 : t3r_reason(error, error_bytes, "its position is not within -2^30..2^30");
}

/* ---- depth ---- */

/* Whether the depth camera sees the same as the colour camera, at most in another resolution. */
static bool is_aligned(const lens *depth, const lens *colour)
{
    double sx = colour->width / depth->width, sy = colour->height / depth->height;
    return depth->model == colour->model && memcmp(depth->d, colour->d, sizeof depth->d) == 0 &&
           fabs(depth->fx * sx - colour->fx) <= 0.5 && fabs(depth->fy * sy - colour->fy) <= 0.5 &&
           fabs((depth->cx + 0.5) * sx - 0.5 - colour->cx) <= 1 && fabs((depth->cy + 0.5) * sy - 0.5 - colour->cy) <= 1;
}

static void drop_depth(bag_frames *b, t3r_frame *frame)
{
    frame->depth = NULL;
    b->unregistered++;
}

/* Reads the lens without which the colour images were redrawn. */
static int bent_lens(const bag_frames *b, uint32_t index, lens *out, char *error, size_t error_bytes)
{
    const t3r_recorded_message message = t3r_recording_frame_message(b->recording, index, T3R_USE_CAMERA_INFO);
    t3r_ros_camera_info info;
    const char *wrong = t3r_ros_read_camera_info(message.data, message.bytes, &info);
    wrong = wrong != NULL ? wrong : lens_of_info(&info, out);
    if (wrong != NULL) {
        return t3r_reason(error, error_bytes, "camera_info: %s", wrong);
    }
    lens_reduce(out, picture_reduction(info.width, info.height));
    return 0;
}

/* Reads the depth camera's intrinsics; *there is false if it has none of its own. */
static int depth_lens(const bag_frames *b, uint32_t index, const t3r_frame *frame, lens *out, bool *there, char *error,
                      size_t error_bytes)
{
    t3r_recorded_message message = t3r_recording_frame_message(b->recording, index, T3R_USE_DEPTH_CAMERA_INFO);
    t3r_ros_camera_info info;
    *there = message.data != NULL;
    if (!*there) {
        return 0;
    }
    const size_t depth = t3r_recording_stream_for(b->recording, T3R_USE_DEPTH);
    const char *wrong = t3r_ros_read_camera_info(message.data, message.bytes, &info);
    if (wrong == NULL && t3r_recording_stream(b->recording, (uint32_t)depth).rectified) {
        wrong = t3r_message_rectify(&info);
    }
    wrong = wrong != NULL ? wrong : lens_of_info(&info, out);
    if (wrong == NULL && (info.width != frame->depth_width || info.height != frame->depth_height)) {
        wrong = "width x height is not that of the depth image";
    }
    return wrong == NULL ? 0 : t3r_reason(error, error_bytes, "camera_info of depth: %s", wrong);
}

/* Replaces the frame's depth by registered depth. False: out of memory. */
static bool put_registered(bag_frames *b, uint32_t index, t3r_frame *f, const lens *depth, const lens *colour,
                           const rigid *from_depth, const lens *bent)
{
    const uint8_t *const of[3] = {t3r_recording_frame_message(b->recording, index, T3R_USE_DEPTH).data,
                                  t3r_recording_frame_message(b->recording, index, T3R_USE_CAMERA_INFO).data,
                                  t3r_recording_frame_message(b->recording, index, T3R_USE_DEPTH_CAMERA_INFO).data};
    uint32_t width, height;
    register_depth_size(f, &width, &height);
    bool same = b->depth != NULL && memcmp(of, b->depth_of, sizeof of) == 0 &&
                memcmp(from_depth, &b->depth_place, sizeof *from_depth) == 0;
    if (!same) {
        free(b->depth);
        b->depth = malloc((size_t)width * height * 2);
        if (b->depth == NULL || !ray_grid_make(&b->rays, depth, f->depth_width, f->depth_height, of[2])) {
            return false;
        }
        register_depth(f, &b->rays, colour, from_depth, b->depth);
        if (bent != NULL) {
            straighten_hide(bent, width, height, b->depth);
        }
        memcpy(b->depth_of, of, sizeof of);
        b->depth_place = *from_depth;
    }
    f->depth = b->depth;
    f->depth_width = width;
    f->depth_height = height;
    f->depth_stride_bytes = width * 2;
    b->registered++;
    return true;
}

/* Makes depth of the colour camera's view; bent: the lens without which the colour was redrawn, or NULL. */
static int make_depth(bag_frames *b, uint32_t index, t3r_capture_frame *frame, const lens *bent, char *error,
                      size_t error_bytes)
{
    t3r_frame *f = &frame->frame;
    t3r_text from = frame_of(b->recording, T3R_USE_DEPTH);
    bool same_frame = from.count == 0 || t3r_text_same(from, b->camera);
    lens depth, colour;
    bool own_lens;
    if (depth_lens(b, index, f, &depth, &own_lens, error, error_bytes) != 0) {
        return -1;
    }
    if (!own_lens || !frame->has_intrinsics) {
        if (!same_frame) {
            remark(b, "depth without a camera_info of its own is left out: it cannot be registered", from, b->camera);
            drop_depth(b, f);
        }
        return 0;
    }
    lens_of_camera(&frame->camera, f->width, f->height, &colour);
    rigid from_depth = rigid_identity;
    if (same_frame && is_aligned(&depth, bent != NULL ? bent : &colour)) {
        return bent == NULL ? 0 : bag_straighten_depth(bent, f, &b->straight, error, error_bytes);
    }
    if (!same_frame && !lookup(b, b->camera, from, frame->depth_stamp_ns, &from_depth)) {
        remark(b, "depth is left out: there is no transform", from, b->camera);
        drop_depth(b, f);
        return 0;
    }
    return put_registered(b, index, f, &depth, &colour, &from_depth, bent)
               ? 0
               : t3r_reason(error, error_bytes, "out of memory");
}

int bag_frames_make(bag_frames *b, uint32_t index, t3r_capture_frame *frame, char *error, size_t error_bytes)
{
    lens bent;
    if (make_pose(b, index, frame, error, error_bytes) != 0 ||
        (frame->straightened && bent_lens(b, index, &bent, error, error_bytes) != 0)) {
        return -1;
    }
    b->straightened += frame->straightened;
    return frame->frame.depth == NULL
               ? 0
               : make_depth(b, index, frame, frame->straightened ? &bent : NULL, error, error_bytes);
}

void bag_frames_count_anew(bag_frames *b)
{
    b->interpolated = b->composed = b->unposed = b->registered = b->unregistered = b->straightened = 0;
    b->remark[0] = '\0';
}

void bag_frames_close(bag_frames *b)
{
    transform_tree_free(&b->tree);
    pose_track_free(&b->poses);
    free(b->depth);
    b->depth = NULL;
    ray_grid_free(&b->rays);
    picture_free(&b->straight);
}
