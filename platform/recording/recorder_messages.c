/* SPDX-License-Identifier: Apache-2.0 */
/* Writes a frame and an event as ROS 2 messages. */
#include <stdbool.h>

#include "core/little_endian.h"
#include "messages/fixed_double.h"
#include "messages/pixel_layout.h"
#include "messages/ros_messages.h"
#include "recorder.h"

static void put_camera_info(t3r_recorder *recorder, int64_t stamp_ns, const t3r_recorded_camera *camera)
{
    static const uint32_t coefficients[T3R_DISTORTION_COUNT] = {5, 5, 4};
    const uint64_t one = t3r_double_bits(1.0);
    const uint64_t fx = t3r_double_bits(camera->fx), fy = t3r_double_bits(camera->fy);
    const uint64_t cx = t3r_double_bits(camera->cx), cy = t3r_double_bits(camera->cy);
    t3r_ros_camera_info info = {
        .header = {stamp_ns, t3r_text_of(recorder->camera)},
        .width = camera->width,
        .height = camera->height,
        .distortion_model = t3r_text_of(camera->distortion == T3R_DISTORTION_FISHEYE ? "equidistant" : "plumb_bob"),
        .d_count = coefficients[camera->distortion],
        .k_f64 = {fx, 0, cx, 0, fy, cy, 0, 0, one},
        .r_f64 = {one, 0, 0, 0, one, 0, 0, 0, one},
        .p_f64 = {fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, one, 0},
    };
    for (uint32_t i = 0; i < info.d_count && camera->distortion != T3R_DISTORTION_NONE; i++) {
        info.d_f64[i] = t3r_double_bits(camera->coefficients[i]);
    }
    t3r_cdr_writer counter, cdr;
    t3r_cdr_begin(&counter, (t3r_sink){.write = NULL});
    t3r_ros_write_camera_info(&counter, &info);
    t3r_recorder_begin_message(recorder, T3R_CHANNEL_CAMERA_INFO, stamp_ns, counter.at);
    t3r_cdr_begin(&cdr, t3r_mcap_record_sink(&recorder->out));
    t3r_ros_write_camera_info(&cdr, &info);
    t3r_recorder_end_message(recorder);
}

/* Returns the pose of the coordinate frame of images and intrinsics. */
static t3r_ros_pose pose_of(const t3r_recorder *recorder, int64_t stamp_ns, const t3r_recorded_camera *camera)
{
    t3r_ros_pose pose = {.header = {stamp_ns, t3r_text_of(T3R_RECORDER_WORLD)},
                         .child_frame_id = t3r_text_of(recorder->camera)};
    for (uint32_t i = 0; i < 3; i++) {
        pose.position_f64[i] = t3r_double_bits(camera->position[i]);
    }
    for (uint32_t i = 0; i < 4; i++) {
        pose.rotation_f64[i] = t3r_double_bits(camera->rotation[(i + 1) % 4]); /* w x y z to x y z w */
    }
    return pose;
}

/* Writes a pose as PoseStamped or as TFMessage. */
static void put_pose(t3r_recorder *recorder, uint32_t channel, const t3r_ros_pose *pose)
{
    void (*const write)(t3r_cdr_writer * out, const t3r_ros_pose *pose) =
        channel == T3R_CHANNEL_TF ? t3r_ros_write_tf : t3r_ros_write_pose;
    t3r_cdr_writer counter, cdr;
    t3r_cdr_begin(&counter, (t3r_sink){.write = NULL});
    write(&counter, pose);
    t3r_recorder_begin_message(recorder, channel, pose->header.stamp_ns, counter.at);
    t3r_cdr_begin(&cdr, t3r_mcap_record_sink(&recorder->out));
    write(&cdr, pose);
    t3r_recorder_end_message(recorder);
}

/* Opens an image message; its data follow through the returned writer. */
static t3r_cdr_writer begin_image(t3r_recorder *recorder, uint32_t channel, const t3r_ros_image *image)
{
    t3r_cdr_writer counter, cdr;
    t3r_cdr_begin(&counter, (t3r_sink){.write = NULL});
    t3r_ros_write_image_head(&counter, image);
    t3r_recorder_begin_message(recorder, channel, image->header.stamp_ns, (uint64_t)counter.at + image->data_bytes);
    t3r_cdr_begin(&cdr, t3r_mcap_record_sink(&recorder->out));
    t3r_ros_write_image_head(&cdr, image);
    return cdr;
}

static void put_depth(t3r_recorder *recorder, const t3r_recorded_frame *frame)
{
    t3r_ros_image image = {
        .header = {frame->stamp_ns, t3r_text_of(recorder->camera)},
        .height = frame->depth_height,
        .width = frame->depth_width,
        .encoding = t3r_text_of("16UC1"),
        .step = frame->depth_width * 2,
        .data_bytes = frame->depth_width * 2 * frame->depth_height,
    };
    t3r_cdr_writer cdr = begin_image(recorder, T3R_CHANNEL_DEPTH, &image);
    for (uint32_t y = 0; frame->depth == NULL && y < frame->depth_height; y++) {
        t3r_cdr_put_raw(&cdr, frame->depth_z16 + (size_t)y * frame->depth_stride_bytes, image.step);
    }
    size_t samples = frame->depth == NULL ? 0 : (size_t)frame->depth_width * frame->depth_height;
    for (size_t start = 0; start < samples; start += 64) {
        uint8_t bytes[128];
        size_t count = samples - start < 64 ? samples - start : 64;
        for (size_t i = 0; i < count; i++) {
            t3r_store_le16(bytes + 2 * i, frame->depth[start + i]);
        }
        t3r_cdr_put_raw(&cdr, bytes, 2 * count);
    }
    t3r_recorder_end_message(recorder);
}

static void put_image(t3r_recorder *recorder, const t3r_recorded_frame *frame)
{
    uint32_t row_bytes = t3r_pixel_row_bytes(frame->format, frame->width);
    uint32_t rows = 0;
    for (uint32_t plane = 0; plane < 2; plane++) {
        rows += t3r_pixel_rows(frame->format, plane, frame->height);
    }
    t3r_ros_image image = {
        .header = {frame->stamp_ns, t3r_text_of(recorder->camera)},
        .height = frame->height,
        .width = frame->width,
        .encoding = t3r_text_of(t3r_pixel_encoding(frame->format)),
        .step = row_bytes,
        .data_bytes = row_bytes * rows,
    };
    t3r_cdr_writer cdr = begin_image(recorder, T3R_CHANNEL_IMAGE, &image);
    for (uint32_t plane = 0; plane < 2; plane++) {
        for (uint32_t y = 0; y < t3r_pixel_rows(frame->format, plane, frame->height); y++) {
            t3r_cdr_put_raw(&cdr, frame->planes[plane] + (size_t)y * frame->stride_bytes[plane], row_bytes);
        }
    }
    t3r_recorder_end_message(recorder);
}

void t3r_recorder_put_frame(t3r_recorder *recorder, const void *item)
{
    const t3r_recorded_frame *frame = item;
    if (!frame->uncalibrated) {
        put_camera_info(recorder, frame->stamp_ns, &frame->camera);
    }
    if (!frame->unposed) {
        const t3r_ros_pose pose = pose_of(recorder, frame->stamp_ns, &frame->camera);
        put_pose(recorder, T3R_CHANNEL_POSE, &pose);
        put_pose(recorder, T3R_CHANNEL_TF, &pose);
    }
    if (frame->depth != NULL || frame->depth_z16 != NULL) {
        put_depth(recorder, frame);
    }
    put_image(recorder, frame);
}

void t3r_recorder_put_log(t3r_recorder *recorder, const void *log)
{
    t3r_cdr_writer counter, cdr;
    t3r_cdr_begin(&counter, (t3r_sink){.write = NULL});
    t3r_ros_write_log(&counter, log);
    t3r_recorder_begin_message(recorder, T3R_CHANNEL_EVENTS, ((const t3r_ros_log *)log)->stamp_ns, counter.at);
    t3r_cdr_begin(&cdr, t3r_mcap_record_sink(&recorder->out));
    t3r_ros_write_log(&cdr, log);
    t3r_recorder_end_message(recorder);
}
