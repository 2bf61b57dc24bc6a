/* SPDX-License-Identifier: Apache-2.0 */
/* The recorder: writes one camera's frames as MCAP, in one pass, with a bounded state in the caller's memory. */
#include "recording.h"

#include <stdbool.h>
#include <string.h>

#include "host/fixed_text.h"
#include "mcap/reader_limits.h"
#include "messages/fixed_camera.h"
#include "messages/pixel_layout.h"
#include "messages/ros_messages.h"
#include "recorder.h"

#define MAX_EVENT_BYTES 1024u
#define MAX_STAMP_NS ((int64_t)1000000000 << 31) /* ROS keeps seconds in int32_t */
#define END_BYTES 8192u                          /* bounds the summary without the chunk indexes */

_Static_assert(sizeof(t3r_recorder) <= T3R_RECORDER_BYTES, "T3R_RECORDER_BYTES must hold the state");

size_t t3r_recorder_bytes(void)
{
    return sizeof(t3r_recorder);
}

static bool camera_name_fits(const char *camera)
{
    size_t count = 0;
    for (; camera[count] != '\0'; count++) {
        char c = camera[count];
        bool word = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
        bool inner_slash = c == '/' && count > 0 && camera[count - 1] != '/' && camera[count + 1] != '\0';
        if ((!word && !inner_slash) || count + 1 >= T3R_RECORDER_CAMERA_ROOM) {
            return false;
        }
    }
    return count > 0;
}

int t3r_recorder_begin(t3r_recorder *recorder, t3r_sink sink, const t3r_recording_header *header)
{
    uint64_t unit_q40;
    if (recorder == NULL || header == NULL || sink.write == NULL || header->camera == NULL || header->source == NULL ||
        header->clock == NULL || !camera_name_fits(header->camera) || header->triplet_count > T3R_LIMIT_TRIPLETS ||
        (header->triplet_count > 0 && header->triplets == NULL) ||
        !t3r_fixed_depth_unit(header->depth_unit, &unit_q40)) {
        return -1;
    }
    char depth_unit[T3R_Q40_TEXT_BYTES];
    t3r_q40_to_text(unit_q40, depth_unit);
    memset(recorder, 0, sizeof *recorder);
    memcpy(recorder->camera, header->camera, strlen(header->camera) + 1);
    recorder->channel_count = header->events ? T3R_CHANNEL_COUNT : T3R_CHANNEL_EVENTS;
    recorder->unchunked = header->unchunked || sink.read == NULL;
    recorder->packer = header->packer;
    recorder->message_end = header->message_end;
    t3r_mcap_begin(&recorder->out, sink, t3r_text_of("ros2"), t3r_text_of("trim3r " T3R_VERSION));
    t3r_recorder_put_head(recorder, header, depth_unit);
    t3r_recorder_end_message(recorder);
    return t3r_recorder_status(recorder);
}

uint64_t t3r_recorder_offset(const t3r_recorder *recorder)
{
    return recorder->out.offset;
}

uint64_t t3r_recorder_end_bytes(const t3r_recorder *recorder)
{
    return END_BYTES + (uint64_t)(recorder->chunks + 1) * T3R_MCAP_CHUNK_INDEX_BYTES;
}

static bool frame_is_recordable(const t3r_recorded_frame *frame)
{
    if (frame->stamp_ns < 0 || frame->stamp_ns >= MAX_STAMP_NS || (uint32_t)frame->format >= T3R_PIXEL_FORMAT_COUNT ||
        t3r_pixel_size_error(frame->format, frame->width, frame->height)) {
        return false;
    }
    if (!frame->uncalibrated && ((uint32_t)frame->camera.distortion >= T3R_DISTORTION_COUNT ||
                                 frame->camera.width != frame->width || frame->camera.height != frame->height)) {
        return false;
    }
    uint32_t row_bytes = t3r_pixel_row_bytes(frame->format, frame->width);
    for (uint32_t plane = 0; plane < 2; plane++) {
        if (t3r_pixel_rows(frame->format, plane, frame->height) > 0 &&
            (frame->planes[plane] == NULL || frame->stride_bytes[plane] < row_bytes)) {
            return false;
        }
    }
    if (frame->depth == NULL && frame->depth_z16 == NULL) {
        return true;
    }
    return frame->depth_width >= 2 && frame->depth_width <= T3R_MAX_SIDE && frame->depth_height >= 2 &&
           frame->depth_height <= T3R_MAX_SIDE &&
           (frame->depth != NULL || frame->depth_stride_bytes >= frame->depth_width * 2);
}

int t3r_recorder_frame(t3r_recorder *recorder, const t3r_recorded_frame *frame)
{
    if (recorder == NULL || frame == NULL || !frame_is_recordable(frame)) {
        return -1;
    }
    t3r_recorder_put(recorder, t3r_recorder_put_frame, frame);
    return t3r_recorder_status(recorder);
}

int t3r_recorder_event(t3r_recorder *recorder, int64_t stamp_ns, t3r_recorder_level level, const char *text)
{
    if (recorder == NULL || text == NULL || !t3r_recorder_has_events(recorder) || stamp_ns < 0 ||
        stamp_ns >= MAX_STAMP_NS || strlen(text) > MAX_EVENT_BYTES) {
        return -1;
    }
    const t3r_ros_log log = {stamp_ns, (uint8_t)level, t3r_text_of("capture"), t3r_text_of(text)};
    t3r_recorder_put(recorder, t3r_recorder_put_log, &log);
    return t3r_recorder_status(recorder);
}

int t3r_recorder_end(t3r_recorder *recorder)
{
    if (recorder == NULL) {
        return -1;
    }
    t3r_recorder_put_summary(recorder);
    t3r_recorder_end_message(recorder);
    return t3r_recorder_status(recorder);
}
