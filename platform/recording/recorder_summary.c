/* SPDX-License-Identifier: Apache-2.0 */
/* Writes the parts of a recording before and after the messages. */
#include <string.h>

#include "messages/ros_messages.h"
#include "recorder.h"

#define TOPIC_ROOM (T3R_RECORDER_CAMERA_ROOM + 16u)

/* In the order of their ids, from 1 on; the events' schema is last. */
static const struct {
    const char *const *name, *const *definition;
} schemas[] = {
    {&t3r_ros_names[T3R_ROS_IMAGE], &t3r_ros_schemas[T3R_ROS_IMAGE]},
    {&t3r_ros_names[T3R_ROS_CAMERA_INFO], &t3r_ros_schemas[T3R_ROS_CAMERA_INFO]},
    {&t3r_ros_names[T3R_ROS_POSE], &t3r_ros_schemas[T3R_ROS_POSE]},
    {&t3r_ros_names[T3R_ROS_TF], &t3r_ros_schemas[T3R_ROS_TF]},
    {&t3r_ros_log_name, &t3r_ros_log_schema},
};
enum { SCHEMA_IMAGE = 1, SCHEMA_CAMERA_INFO, SCHEMA_POSE, SCHEMA_TF, SCHEMA_LOG };

/* Below the camera's topic, except names that begin with a slash. */
static const struct {
    const char *name;
    uint16_t schema;
} channels[T3R_CHANNEL_COUNT] = {
    [T3R_CHANNEL_IMAGE] = {"image", SCHEMA_IMAGE},
    [T3R_CHANNEL_DEPTH] = {"depth", SCHEMA_IMAGE},
    [T3R_CHANNEL_CAMERA_INFO] = {"camera_info", SCHEMA_CAMERA_INFO},
    [T3R_CHANNEL_POSE] = {"pose", SCHEMA_POSE},
    [T3R_CHANNEL_TF] = {"/tf", SCHEMA_TF},
    [T3R_CHANNEL_EVENTS] = {"events", SCHEMA_LOG},
};

static const char metadata_name[] = "trim3r";
static const char triplets_name[] = "trim3r_triplets";

static uint16_t schema_count(const t3r_recorder *recorder)
{
    return t3r_recorder_has_events(recorder) ? SCHEMA_LOG : SCHEMA_LOG - 1;
}

static void put_schemas(t3r_recorder *recorder)
{
    for (uint16_t i = 0; i < schema_count(recorder); i++) {
        t3r_mcap_schema(&recorder->out, (uint16_t)(i + 1), t3r_text_of(*schemas[i].name), t3r_text_of("ros2msg"),
                        t3r_text_of(*schemas[i].definition));
    }
}

static void put_channels(t3r_recorder *recorder)
{
    /* The profile "ros2" requires the key; empty = unknown. */
    const t3r_mcap_pair quality = {t3r_text_of("offered_qos_profiles"), t3r_text_of("")};
    for (uint32_t i = 0; i < recorder->channel_count; i++) {
        char topic[TOPIC_ROOM];
        size_t prefix = channels[i].name[0] == '/' ? 0 : strlen(recorder->camera) + 2, name = strlen(channels[i].name);
        if (prefix > 0) {
            topic[0] = '/';
            memcpy(topic + 1, recorder->camera, prefix - 2);
            topic[prefix - 1] = '/';
        }
        memcpy(topic + prefix, channels[i].name, name);
        t3r_mcap_channel(&recorder->out, (uint16_t)i, channels[i].schema, (t3r_text){topic, prefix + name},
                         t3r_text_of("cdr"), &quality, 1);
    }
}

static t3r_text decimal(uint32_t x, char room[10])
{
    size_t at = 10;
    do {
        room[--at] = (char)('0' + x % 10);
        x /= 10;
    } while (x != 0);
    return (t3r_text){room + at, 10 - at};
}

/* Writes "0,2,1;3,5,4": context a, context b, target. Returns the bytes; out may be NULL to count only. */
static size_t put_triplets(t3r_mcap_writer *out, const t3r_triplet *triplets, uint32_t count)
{
    size_t bytes = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t members[3] = {triplets[i].context[0], triplets[i].context[1], triplets[i].target};
        for (uint32_t j = 0; j < 3; j++) {
            char room[10];
            t3r_text text = decimal(members[j], room);
            const char *separator = j > 0 ? "," : i > 0 ? ";" : "";
            bytes += strlen(separator) + text.count;
            if (out != NULL) {
                t3r_mcap_put_raw(out, separator, strlen(separator));
                t3r_mcap_put_raw(out, text.chars, text.count);
            }
        }
    }
    return bytes;
}

static void put_metadata(t3r_recorder *recorder, const t3r_recording_header *header, const char *depth_unit)
{
    t3r_mcap_writer *out = &recorder->out;
    char epoch[10];
    const t3r_mcap_pair pairs[] = {
        {t3r_text_of("bits_epoch"), decimal(T3R_BITS_EPOCH, epoch)},
        {t3r_text_of("depth_unit"), t3r_text_of(depth_unit)},
        {t3r_text_of("clock"), t3r_text_of(header->clock)},
        {t3r_text_of("source"), t3r_text_of(header->source)},
        {t3r_text_of("version"), t3r_text_of(T3R_VERSION)},
    };
    recorder->metadata_at[0] = out->offset;
    t3r_mcap_metadata(out, t3r_text_of(metadata_name), pairs, sizeof pairs / sizeof pairs[0]);
    recorder->metadata_at[1] = out->offset;
    recorder->metadata_count = 1;
    if (header->triplet_count > 0) {
        t3r_text name = t3r_text_of(triplets_name), key = t3r_text_of("triplets");
        size_t bytes = put_triplets(NULL, header->triplets, header->triplet_count);
        size_t map = 4 + key.count + 4 + bytes;
        t3r_mcap_record(out, T3R_MCAP_METADATA, 4 + name.count + 4 + map);
        t3r_mcap_put_text(out, name);
        t3r_mcap_put_u32(out, (uint32_t)map);
        t3r_mcap_put_text(out, key);
        t3r_mcap_put_u32(out, (uint32_t)bytes);
        put_triplets(out, header->triplets, header->triplet_count);
        recorder->metadata_at[2] = out->offset;
        recorder->metadata_count = 2;
    }
}

void t3r_recorder_put_head(t3r_recorder *recorder, const t3r_recording_header *header, const char *depth_unit)
{
    put_metadata(recorder, header, depth_unit);
    put_schemas(recorder);
    put_channels(recorder);
    recorder->data_at = recorder->out.offset;
}

static void put_statistics(t3r_recorder *recorder)
{
    t3r_mcap_writer *out = &recorder->out;
    uint64_t messages = 0;
    uint32_t channel_count = recorder->channel_count;
    for (uint32_t i = 0; i < channel_count; i++) {
        messages += recorder->counts.messages[i];
    }
    t3r_mcap_record(out, T3R_MCAP_STATISTICS, 8 + 2 + 4 * 4 + 8 + 8 + 4 + channel_count * 10);
    t3r_mcap_put_u64(out, messages);
    t3r_mcap_put_u16(out, schema_count(recorder));
    t3r_mcap_put_u32(out, channel_count);
    t3r_mcap_put_u32(out, 0); /* attachments */
    t3r_mcap_put_u32(out, recorder->metadata_count);
    t3r_mcap_put_u32(out, recorder->chunks);
    t3r_mcap_put_u64(out, recorder->counts.first_ns);
    t3r_mcap_put_u64(out, recorder->counts.last_ns);
    t3r_mcap_put_u32(out, channel_count * 10);
    for (uint32_t i = 0; i < channel_count; i++) {
        t3r_mcap_put_u16(out, (uint16_t)i);
        t3r_mcap_put_u64(out, recorder->counts.messages[i]);
    }
}

static void put_metadata_index(t3r_recorder *recorder)
{
    for (uint32_t i = 0; i < recorder->metadata_count; i++) {
        t3r_text name = t3r_text_of(i == 0 ? metadata_name : triplets_name);
        t3r_mcap_record(&recorder->out, T3R_MCAP_METADATA_INDEX, 8 + 8 + 4 + name.count);
        t3r_mcap_put_u64(&recorder->out, recorder->metadata_at[i]);
        t3r_mcap_put_u64(&recorder->out, recorder->metadata_at[i + 1] - recorder->metadata_at[i]);
        t3r_mcap_put_text(&recorder->out, name);
    }
}

void t3r_recorder_put_summary(t3r_recorder *recorder)
{
    static const t3r_mcap_opcode groups[] = {T3R_MCAP_SCHEMA, T3R_MCAP_CHANNEL, T3R_MCAP_STATISTICS,
                                             T3R_MCAP_CHUNK_INDEX, T3R_MCAP_METADATA_INDEX};
    enum { GROUPS = sizeof groups / sizeof groups[0] };
    t3r_mcap_writer *out = &recorder->out;
    uint64_t starts[GROUPS + 1], data_end = out->offset;
    t3r_mcap_data_end(out);
    starts[0] = out->offset;
    put_schemas(recorder);
    starts[1] = out->offset;
    put_channels(recorder);
    starts[2] = out->offset;
    put_statistics(recorder);
    starts[3] = out->offset;
    if (!recorder->unchunked) {
        t3r_mcap_chunk_indexes(out, recorder->data_at, data_end);
    }
    starts[4] = out->offset;
    put_metadata_index(recorder);
    starts[5] = out->offset;
    for (uint32_t i = 0; i < GROUPS; i++) {
        if (starts[i + 1] > starts[i]) {
            t3r_mcap_record(out, T3R_MCAP_SUMMARY_OFFSET, 1 + 8 + 8);
            t3r_mcap_put_u8(out, (uint8_t)groups[i]);
            t3r_mcap_put_u64(out, starts[i]);
            t3r_mcap_put_u64(out, starts[i + 1] - starts[i]);
        }
    }
    t3r_mcap_finish(out, starts[0], starts[GROUPS]);
}
