/* SPDX-License-Identifier: Apache-2.0 */
/* Properties of a recording. */
#include <string.h>

#include "recording_index.h"

uint32_t t3r_recording_frame_count(const t3r_recording *recording)
{
    return recording->pairing.frames;
}

uint32_t t3r_recording_triplet_count(const t3r_recording *recording)
{
    return recording->triplet_count;
}

t3r_triplet t3r_recording_triplet(const t3r_recording *recording, uint32_t index)
{
    return index < recording->triplet_count ? recording->triplets[index] : (t3r_triplet){{0, 0}, 0};
}

const char *t3r_recording_import_reason(const t3r_recording *recording)
{
    const char *poses = recording->set_poses == NULL ? recording->import_pose_reason : NULL;
    return recording->asks[0] != '\0'         ? recording->asks
           : recording->import_reason != NULL ? recording->import_reason
           : poses != NULL                    ? poses
                                              : "";
}

const char *t3r_recording_asks(const t3r_recording *recording)
{
    return recording->asks;
}

const char *t3r_recording_note(const t3r_recording *recording)
{
    return recording->note;
}

uint32_t t3r_recording_bits_epoch(const t3r_recording *recording)
{
    return recording->bits_epoch;
}

uint32_t t3r_recording_stream_count(const t3r_recording *recording)
{
    return (uint32_t)recording->stream_count;
}

t3r_stream_info t3r_recording_stream(const t3r_recording *recording, uint32_t index)
{
    if (index >= recording->stream_count) {
        return (t3r_stream_info){.unused = "", .fault = "", .topic = "", .schema = ""};
    }
    const t3r_stream *stream = &recording->streams[index];
    return (t3r_stream_info){.use = stream->use,
                             .unused = stream->unused,
                             .compressed = stream->compressed || stream->converted,
                             .rectified = stream->rectified,
                             .left_out = stream->left_out,
                             .fault = stream->fault,
                             .topic = stream->topic,
                             .schema = stream->schema,
                             .messages = stream->count,
                             .first_ns = stream->first_ns,
                             .last_ns = stream->last_ns};
}

t3r_pairing_info t3r_recording_pairing(const t3r_recording *recording)
{
    return recording->pairing;
}

const char *t3r_recording_clock(const t3r_recording *recording)
{
    return recording->clock;
}

uint64_t t3r_recording_depth_unit_q40(const t3r_recording *recording)
{
    return recording->depth_unit_q40;
}

uint64_t t3r_recording_depth_beyond(const t3r_recording *recording)
{
    return recording->depth_beyond == NULL ? 0 : *recording->depth_beyond;
}

uint32_t t3r_recording_pose_count(const t3r_recording *recording, uint32_t stream)
{
    if (stream >= recording->stream_count) {
        return 0;
    }
    const t3r_stream *s = &recording->streams[stream];
    return t3r_ros_is_pose(s->type) ? (uint32_t)s->kept : 0;
}

static double double_of_bits(uint64_t bits)
{
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

t3r_recorded_pose t3r_recording_pose(const t3r_recording *recording, uint32_t stream, uint32_t index)
{
    const t3r_stream *s = &recording->streams[stream];
    const t3r_indexed_message *message = &s->messages[index];
    t3r_recorded_pose out = {.stamp_ns = message->stamp_ns};
    t3r_ros_pose pose = {0};
    t3r_ros_read_pose(s->type, message->data, message->bytes, &pose); /* valid: read when it was indexed */
    for (uint32_t i = 0; i < 3; i++) {
        out.position[i] = double_of_bits(pose.position_f64[i]);
    }
    for (uint32_t i = 0; i < 4; i++) {
        out.rotation[(i + 1) % 4] = double_of_bits(pose.rotation_f64[i]); /* x y z w to w x y z */
    }
    return out;
}

t3r_recording_cut t3r_recording_cut_of(const t3r_recording *recording)
{
    return recording->cut;
}

size_t t3r_recording_stream_for(const t3r_recording *recording, t3r_stream_use use)
{
    const size_t chosen[T3R_USE_COUNT] = {[T3R_USE_NONE] = T3R_NO_STREAM,
                                          [T3R_USE_COLOUR] = recording->colour,
                                          [T3R_USE_DEPTH] = recording->depth,
                                          [T3R_USE_CAMERA_INFO] = recording->camera_info,
                                          [T3R_USE_DEPTH_CAMERA_INFO] = recording->depth_camera_info,
                                          [T3R_USE_POSE] = recording->pose,
                                          [T3R_USE_TRANSFORMS] = recording->transforms};
    return chosen[use];
}

uint32_t t3r_recording_message_count(const t3r_recording *recording, size_t stream)
{
    return stream < recording->stream_count ? (uint32_t)recording->streams[stream].kept : 0;
}

t3r_recorded_message t3r_recording_message(const t3r_recording *recording, size_t stream, uint32_t index)
{
    const t3r_indexed_message *message = &recording->streams[stream].messages[index];
    return (t3r_recorded_message){message->data, message->bytes, message->stamp_ns};
}

t3r_recorded_message t3r_recording_frame_message(const t3r_recording *recording, uint32_t index, t3r_stream_use use)
{
    const t3r_frame_links *links = &recording->links[index];
    const size_t messages[T3R_USE_COUNT] = {[T3R_USE_NONE] = T3R_NO_MESSAGE,
                                            [T3R_USE_COLOUR] = index,
                                            [T3R_USE_DEPTH] = links->depth,
                                            [T3R_USE_CAMERA_INFO] = links->camera_info,
                                            [T3R_USE_DEPTH_CAMERA_INFO] = links->depth_camera_info,
                                            [T3R_USE_POSE] = links->pose,
                                            [T3R_USE_TRANSFORMS] = T3R_NO_MESSAGE};
    if (messages[use] == T3R_NO_MESSAGE) {
        return (t3r_recorded_message){.data = NULL};
    }
    return t3r_recording_message(recording, t3r_recording_stream_for(recording, use), (uint32_t)messages[use]);
}

void t3r_recording_set_decoder(t3r_recording *recording, t3r_image_decoder decoder)
{
    recording->decoder = decoder;
}
