/* SPDX-License-Identifier: Apache-2.0 */
/* Inspects messages for properties of their stream. */
#include <string.h>

#include "host/reason.h"
#include "messages/message_frame.h"
#include "messages/pixel_layout.h"
#include "recording_index.h"

/* Older writers begin the names of frames with a slash. */
static t3r_text without_slash(t3r_text frame)
{
    return frame.count > 0 && frame.chars[0] == '/' ? (t3r_text){frame.chars + 1, frame.count - 1} : frame;
}

static void remark_encoding(t3r_recording *recording, t3r_stream *stream, const char *what, t3r_text encoding)
{
    char name[32];
    t3r_text_copy(name, sizeof name, encoding);
    t3r_recording_remark(recording, "%s: its %s '%s' is not supported", stream->topic, what, name);
    t3r_reason(stream->unused, sizeof stream->unused, "its %s '%s' is not supported", what, name);
}

static void role_of_image(t3r_recording *recording, t3r_stream *stream, t3r_text encoding)
{
    t3r_pixel_format format;
    if (t3r_pixel_format_of(encoding, &format)) {
        stream->role = T3R_STREAM_COLOUR;
        stream->mono = format == T3R_PIXEL_GREY;
    } else if (t3r_pixel_is_converted(encoding)) {
        stream->role = T3R_STREAM_COLOUR;
        stream->converted = true;
    } else if (t3r_text_is(encoding, "16UC1") || t3r_text_is(encoding, "mono16") || t3r_text_is(encoding, "32FC1")) {
        stream->role = T3R_STREAM_DEPTH;
        stream->mono = t3r_text_is(encoding, "mono16");
    } else {
        remark_encoding(recording, stream, "encoding", encoding);
    }
}

static bool text_holds(t3r_text text, const char *word)
{
    size_t count = strlen(word);
    for (size_t i = 0; i + count <= text.count; i++) {
        if (memcmp(text.chars + i, word, count) == 0) {
            return true;
        }
    }
    return false;
}

/* Whether a PNG is 16-bit grey: sides, bits and kind are at fixed places in its first record. */
static bool is_png_of_depth(const uint8_t *bytes, size_t count)
{
    return count > 26 && memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) == 0 && bytes[24] == 16 && bytes[25] == 0;
}

/* Whether a JPEG has one component, by its frame header; PNG: by the kind in its first record. */
static bool is_grey_file(const uint8_t *bytes, size_t count)
{
    if (bytes[0] == 0x89) {
        return count > 25 && (bytes[25] & 2) == 0; /* neither colours nor a palette */
    }
    for (size_t at = 2; at + 9 < count && bytes[at] == 0xff; at += 2 + (size_t)(bytes[at + 2] << 8 | bytes[at + 3])) {
        const uint8_t marker = bytes[at + 1];
        if (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc) {
            return bytes[at + 9] == 1;
        }
    }
    return false;
}

static void role_of_compressed(t3r_recording *recording, t3r_stream *stream, const t3r_ros_compressed *image)
{
    stream->compressed = true;
    bool file = image->data_bytes >= 8 &&
                (memcmp(image->data, "\x89PNG\r\n\x1a\n", 8) == 0 || memcmp(image->data, "\xff\xd8\xff", 3) == 0);
    if (text_holds(image->format, "compressedDepth") && !text_holds(image->format, "rvl")) {
        stream->role = T3R_STREAM_DEPTH;
    } else if (file) {
        stream->role = is_png_of_depth(image->data, image->data_bytes) ? T3R_STREAM_DEPTH : T3R_STREAM_COLOUR;
        stream->mono = stream->role == T3R_STREAM_COLOUR && is_grey_file(image->data, image->data_bytes);
    } else {
        remark_encoding(recording, stream, "format", image->format);
    }
}

static const char *inspect_tf(const uint8_t *bytes, size_t count, t3r_inspection *out)
{
    t3r_ros_tf tf;
    const char *wrong = t3r_ros_open_tf(bytes, count, &tf);
    for (bool first = true; wrong == NULL && tf.left > 0; first = false) {
        t3r_ros_pose transform;
        wrong = t3r_ros_next_tf(&tf, &transform);
        out->stamp_ns = first && wrong == NULL ? transform.header.stamp_ns : out->stamp_ns;
        const char *unusable = wrong == NULL ? t3r_message_transform_error(&transform) : NULL;
        out->transform_error = out->transform_error == NULL ? unusable : out->transform_error;
        out->bad_transforms += unusable != NULL;
    }
    return wrong;
}

static const char *inspect_pose(t3r_stream *stream, bool first, const uint8_t *bytes, size_t count,
                                t3r_ros_header *header)
{
    t3r_ros_pose pose = {.child_frame_id = {"", 0}};
    const char *wrong = t3r_ros_read_pose(stream->type, bytes, count, &pose);
    stream->role = T3R_STREAM_POSE;
    wrong = wrong != NULL ? wrong : t3r_message_pose_error(&pose);
    if (wrong == NULL) {
        *header = pose.header;
        stream->child_frame_id = first ? without_slash(pose.child_frame_id) : stream->child_frame_id;
    }
    return wrong;
}

const char *t3r_recording_inspect(t3r_recording *recording, t3r_stream *stream, const uint8_t *bytes, size_t count,
                                  t3r_inspection *out)
{
    const bool first = stream->count == stream->left_out; /* none before it could be read */
    t3r_ros_header header = {.frame_id = {"", 0}};
    const char *wrong = NULL;
    *out = (t3r_inspection){.usable = true};
    if (stream->type == T3R_ROS_IMAGE) {
        t3r_ros_image image;
        wrong = t3r_ros_read_image(bytes, count, &image);
        if (wrong == NULL && first) {
            role_of_image(recording, stream, image.encoding);
        }
        header = wrong == NULL ? image.header : header;
    } else if (stream->type == T3R_ROS_COMPRESSED_IMAGE) {
        t3r_ros_compressed image;
        wrong = t3r_ros_read_compressed(bytes, count, &image);
        if (wrong == NULL && first) {
            role_of_compressed(recording, stream, &image);
        }
        header = wrong == NULL ? image.header : header;
    } else if (stream->type == T3R_ROS_CAMERA_INFO) {
        t3r_ros_camera_info info;
        wrong = t3r_ros_read_camera_info(bytes, count, &info);
        stream->role = T3R_STREAM_CAMERA_INFO;
        out->usable = wrong == NULL && info.k_f64[0] << 1 != 0; /* K[0] = 0: uncalibrated */
        header = wrong == NULL ? info.header : header;
    } else if (stream->type == T3R_ROS_TF) {
        wrong = inspect_tf(bytes, count, out);
        header.stamp_ns = out->stamp_ns;
        stream->role = T3R_STREAM_TF;
    } else {
        wrong = inspect_pose(stream, first, bytes, count, &header);
    }
    out->usable = wrong == NULL && out->usable && stream->role != T3R_STREAM_OTHER;
    out->stamp_ns = header.stamp_ns;
    stream->frame_id = out->usable && stream->kept == 0 ? without_slash(header.frame_id) : stream->frame_id;
    return wrong;
}
