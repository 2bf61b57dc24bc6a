/* SPDX-License-Identifier: Apache-2.0 */
/* Inspects messages for properties of their stream. */
#include <string.h>

#include "host/reason.h"
#include "messages/pixel_layout.h"
#include "recording_index.h"

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
    } else if (t3r_text_is(encoding, "16UC1") || t3r_text_is(encoding, "mono16") || t3r_text_is(encoding, "32FC1")) {
        stream->role = T3R_STREAM_DEPTH;
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

static void role_of_compressed(t3r_recording *recording, t3r_stream *stream, const t3r_ros_compressed *image)
{
    stream->compressed = true;
    bool file = image->data_bytes >= 8 &&
                (memcmp(image->data, "\x89PNG\r\n\x1a\n", 8) == 0 || memcmp(image->data, "\xff\xd8\xff", 3) == 0);
    if (text_holds(image->format, "compressedDepth") && !text_holds(image->format, "rvl")) {
        stream->role = T3R_STREAM_DEPTH;
    } else if (file) {
        stream->role = is_png_of_depth(image->data, image->data_bytes) ? T3R_STREAM_DEPTH : T3R_STREAM_COLOUR;
    } else {
        remark_encoding(recording, stream, "format", image->format);
    }
}

static const char *inspect_tf(const uint8_t *bytes, size_t count, int64_t *stamp_ns)
{
    t3r_ros_tf tf;
    const char *wrong = t3r_ros_open_tf(bytes, count, &tf);
    for (bool first = true; wrong == NULL && tf.left > 0; first = false) {
        t3r_ros_pose transform;
        wrong = t3r_ros_next_tf(&tf, &transform);
        *stamp_ns = first && wrong == NULL ? transform.header.stamp_ns : *stamp_ns;
    }
    return wrong;
}

static const char *inspect_pose(t3r_stream *stream, const uint8_t *bytes, size_t count, t3r_ros_header *header)
{
    t3r_ros_pose pose = {.child_frame_id = {"", 0}};
    const char *wrong = t3r_ros_read_pose(stream->type, bytes, count, &pose);
    *header = pose.header;
    stream->role = T3R_STREAM_POSE;
    stream->child_frame_id = stream->count == 0 ? pose.child_frame_id : stream->child_frame_id;
    return wrong;
}

const char *t3r_recording_inspect(t3r_recording *recording, t3r_stream *stream, const uint8_t *bytes, size_t count,
                                  int64_t *stamp_ns, bool *usable)
{
    t3r_ros_header header = {.frame_id = {"", 0}};
    const char *wrong = NULL;
    *usable = true;
    if (stream->type == T3R_ROS_IMAGE) {
        t3r_ros_image image;
        wrong = t3r_ros_read_image(bytes, count, &image);
        if (wrong == NULL && stream->count == 0) {
            role_of_image(recording, stream, image.encoding);
        }
        header = wrong == NULL ? image.header : header;
    } else if (stream->type == T3R_ROS_COMPRESSED_IMAGE) {
        t3r_ros_compressed image;
        wrong = t3r_ros_read_compressed(bytes, count, &image);
        if (wrong == NULL && stream->count == 0) {
            role_of_compressed(recording, stream, &image);
        }
        header = wrong == NULL ? image.header : header;
    } else if (stream->type == T3R_ROS_CAMERA_INFO) {
        t3r_ros_camera_info info;
        wrong = t3r_ros_read_camera_info(bytes, count, &info);
        stream->role = T3R_STREAM_CAMERA_INFO;
        *usable = wrong == NULL && info.k_f64[0] << 1 != 0; /* K[0] = 0: uncalibrated */
        header = wrong == NULL ? info.header : header;
    } else if (stream->type == T3R_ROS_TF) {
        wrong = inspect_tf(bytes, count, &header.stamp_ns);
        stream->role = T3R_STREAM_TF;
    } else {
        wrong = inspect_pose(stream, bytes, count, &header);
    }
    *usable = *usable && stream->role != T3R_STREAM_OTHER;
    *stamp_ns = header.stamp_ns;
    stream->frame_id = *usable && stream->kept == 0 ? header.frame_id : stream->frame_id;
    return wrong;
}
