/* The recorder: one camera's frames as MCAP, in one pass, its state bounded and the caller's. */
#include "recording.h"

#include <stdbool.h>
#include <string.h>

#include "bytes.h"
#include "fixed_camera.h"
#include "fixed_double.h"
#include "fixed_text.h"
#include "mcap_writer.h"
#include "pixel_layout.h"
#include "reader_limits.h"
#include "ros_messages.h"

#define CAMERA_ROOM 48u
#define TOPIC_ROOM (CAMERA_ROOM + 16u)
#define SCHEMA_COUNT 3u /* T3R_ROS_IMAGE, T3R_ROS_CAMERA_INFO, T3R_ROS_POSE; schema ids are these + 1 */
#define LOG_SCHEMA (SCHEMA_COUNT + 1)
#define MAX_EVENT_BYTES 1024u
#define MAX_STAMP_NS ((int64_t)1000000000 << 31) /* ROS keeps seconds in int32_t */

/* The events come last: without them the other channels are as they are with them. */
enum { CHANNEL_IMAGE, CHANNEL_DEPTH, CHANNEL_CAMERA_INFO, CHANNEL_POSE, CHANNEL_EVENTS, CHANNEL_COUNT };

static const struct {
    const char *name;
    uint16_t schema;
} channels[CHANNEL_COUNT] = {
    [CHANNEL_IMAGE] = {"image", T3R_ROS_IMAGE + 1},
    [CHANNEL_DEPTH] = {"depth", T3R_ROS_IMAGE + 1},
    [CHANNEL_CAMERA_INFO] = {"camera_info", T3R_ROS_CAMERA_INFO + 1},
    [CHANNEL_POSE] = {"pose", T3R_ROS_POSE + 1},
    [CHANNEL_EVENTS] = {"events", LOG_SCHEMA},
};

static const char metadata_name[] = "trim3r";
static const char triplets_name[] = "trim3r_triplets";

struct t3r_recorder {
    t3r_mcap_writer out;
    uint64_t first_ns, last_ns;
    uint32_t messages[CHANNEL_COUNT]; /* also the next sequence number */
    uint32_t metadata_count;
    uint64_t metadata_at[3]; /* where each metadata record starts, and the last one ends */
    uint32_t channel_count;
    int (*message_end)(void *user);
    char camera[CAMERA_ROOM];
};
_Static_assert(sizeof(t3r_recorder) <= T3R_RECORDER_BYTES, "T3R_RECORDER_BYTES must hold the state");

size_t t3r_recorder_bytes(void)
{
    return sizeof(t3r_recorder);
}

static int status(const t3r_recorder *recorder)
{
    return recorder->out.failed ? -1 : 0;
}

static bool camera_name_fits(const char *camera)
{
    size_t count = 0;
    for (; camera[count] != '\0'; count++) {
        char c = camera[count];
        bool word = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
        bool inner_slash = c == '/' && count > 0 && camera[count - 1] != '/' && camera[count + 1] != '\0';
        if ((!word && !inner_slash) || count + 1 >= CAMERA_ROOM) {
            return false;
        }
    }
    return count > 0;
}

/* What is written so far is whole. */
static void end_message(t3r_recorder *recorder)
{
    if (!recorder->out.failed && recorder->message_end != NULL) {
        recorder->out.failed = recorder->message_end(recorder->out.sink.user) != 0;
    }
}

static bool has_events(const t3r_recorder *recorder)
{
    return recorder->channel_count > CHANNEL_EVENTS;
}

static void put_schemas(t3r_recorder *recorder)
{
    for (uint32_t i = 0; i < SCHEMA_COUNT; i++) {
        t3r_mcap_schema(&recorder->out, (uint16_t)(i + 1), t3r_text_of(t3r_ros_names[i]), t3r_text_of("ros2msg"),
                        t3r_text_of(t3r_ros_schemas[i]));
    }
    if (has_events(recorder)) {
        t3r_mcap_schema(&recorder->out, LOG_SCHEMA, t3r_text_of(t3r_ros_log_name), t3r_text_of("ros2msg"),
                        t3r_text_of(t3r_ros_log_schema));
    }
}

static void put_channels(t3r_recorder *recorder)
{
    /* The profile "ros2" requires the key; empty = unknown. */
    const t3r_mcap_pair quality = {t3r_text_of("offered_qos_profiles"), t3r_text_of("")};
    for (uint32_t i = 0; i < recorder->channel_count; i++) {
        char topic[TOPIC_ROOM];
        size_t prefix = strlen(recorder->camera), name = strlen(channels[i].name);
        topic[0] = '/';
        memcpy(topic + 1, recorder->camera, prefix);
        topic[1 + prefix] = '/';
        memcpy(topic + prefix + 2, channels[i].name, name);
        t3r_mcap_channel(&recorder->out, (uint16_t)i, channels[i].schema, (t3r_text){topic, prefix + 2 + name},
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

/* "0,2,1;3,5,4": context a, context b, target. Returns the bytes; out may be NULL to count only. */
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
    recorder->channel_count = header->events ? CHANNEL_COUNT : CHANNEL_EVENTS;
    recorder->message_end = header->message_end;
    t3r_mcap_begin(&recorder->out, sink, t3r_text_of("ros2"), t3r_text_of("trim3r " T3R_VERSION));
    put_metadata(recorder, header, depth_unit);
    put_schemas(recorder);
    put_channels(recorder);
    end_message(recorder);
    return status(recorder);
}

static void begin_message(t3r_recorder *recorder, uint32_t channel, int64_t stamp_ns, uint64_t data_bytes)
{
    bool first = true;
    for (uint32_t i = 0; i < CHANNEL_COUNT; i++) {
        first = first && recorder->messages[i] == 0;
    }
    uint64_t time = (uint64_t)stamp_ns;
    recorder->first_ns = first || time < recorder->first_ns ? time : recorder->first_ns;
    recorder->last_ns = first || time > recorder->last_ns ? time : recorder->last_ns;
    t3r_mcap_message(&recorder->out, (uint16_t)channel, recorder->messages[channel]++, time, data_bytes);
}

uint64_t t3r_recorder_offset(const t3r_recorder *recorder)
{
    return recorder->out.offset;
}

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
    t3r_cdr_begin(&counter, (t3r_sink){NULL, NULL});
    t3r_ros_write_camera_info(&counter, &info);
    begin_message(recorder, CHANNEL_CAMERA_INFO, stamp_ns, counter.at);
    t3r_cdr_begin(&cdr, t3r_mcap_record_sink(&recorder->out));
    t3r_ros_write_camera_info(&cdr, &info);
    end_message(recorder);
}

static void put_pose(t3r_recorder *recorder, int64_t stamp_ns, const t3r_recorded_camera *camera)
{
    t3r_ros_pose pose = {.header = {stamp_ns, t3r_text_of("world")}};
    for (uint32_t i = 0; i < 3; i++) {
        pose.position_f64[i] = t3r_double_bits(camera->position[i]);
    }
    for (uint32_t i = 0; i < 4; i++) {
        pose.rotation_f64[i] = t3r_double_bits(camera->rotation[(i + 1) % 4]); /* w x y z to x y z w */
    }
    t3r_cdr_writer counter, cdr;
    t3r_cdr_begin(&counter, (t3r_sink){NULL, NULL});
    t3r_ros_write_pose(&counter, &pose);
    begin_message(recorder, CHANNEL_POSE, stamp_ns, counter.at);
    t3r_cdr_begin(&cdr, t3r_mcap_record_sink(&recorder->out));
    t3r_ros_write_pose(&cdr, &pose);
    end_message(recorder);
}

/* Opens the message of an image; its data follow through the returned writer. */
static t3r_cdr_writer begin_image(t3r_recorder *recorder, uint32_t channel, const t3r_ros_image *image)
{
    t3r_cdr_writer counter, cdr;
    t3r_cdr_begin(&counter, (t3r_sink){NULL, NULL});
    t3r_ros_write_image_head(&counter, image);
    begin_message(recorder, channel, image->header.stamp_ns, (uint64_t)counter.at + image->data_bytes);
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
    t3r_cdr_writer cdr = begin_image(recorder, CHANNEL_DEPTH, &image);
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
    end_message(recorder);
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
    t3r_cdr_writer cdr = begin_image(recorder, CHANNEL_IMAGE, &image);
    for (uint32_t plane = 0; plane < 2; plane++) {
        for (uint32_t y = 0; y < t3r_pixel_rows(frame->format, plane, frame->height); y++) {
            t3r_cdr_put_raw(&cdr, frame->planes[plane] + (size_t)y * frame->stride_bytes[plane], row_bytes);
        }
    }
    end_message(recorder);
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
    if (!frame->uncalibrated) {
        put_camera_info(recorder, frame->stamp_ns, &frame->camera);
    }
    if (!frame->unposed) {
        put_pose(recorder, frame->stamp_ns, &frame->camera);
    }
    if (frame->depth != NULL || frame->depth_z16 != NULL) {
        put_depth(recorder, frame);
    }
    put_image(recorder, frame);
    return status(recorder);
}

int t3r_recorder_event(t3r_recorder *recorder, int64_t stamp_ns, t3r_recorder_level level, const char *text)
{
    if (recorder == NULL || text == NULL || !has_events(recorder) || stamp_ns < 0 || stamp_ns >= MAX_STAMP_NS ||
        strlen(text) > MAX_EVENT_BYTES) {
        return -1;
    }
    t3r_ros_log log = {stamp_ns, (uint8_t)level, t3r_text_of("capture"), t3r_text_of(text)};
    t3r_cdr_writer counter, cdr;
    t3r_cdr_begin(&counter, (t3r_sink){NULL, NULL});
    t3r_ros_write_log(&counter, &log);
    begin_message(recorder, CHANNEL_EVENTS, stamp_ns, counter.at);
    t3r_cdr_begin(&cdr, t3r_mcap_record_sink(&recorder->out));
    t3r_ros_write_log(&cdr, &log);
    end_message(recorder);
    return status(recorder);
}

static void put_statistics(t3r_recorder *recorder)
{
    t3r_mcap_writer *out = &recorder->out;
    uint64_t messages = 0;
    uint32_t channel_count = recorder->channel_count;
    for (uint32_t i = 0; i < channel_count; i++) {
        messages += recorder->messages[i];
    }
    t3r_mcap_record(out, T3R_MCAP_STATISTICS, 8 + 2 + 4 * 4 + 8 + 8 + 4 + channel_count * 10);
    t3r_mcap_put_u64(out, messages);
    t3r_mcap_put_u16(out, has_events(recorder) ? LOG_SCHEMA : SCHEMA_COUNT);
    t3r_mcap_put_u32(out, channel_count);
    t3r_mcap_put_u32(out, 0); /* attachments */
    t3r_mcap_put_u32(out, recorder->metadata_count);
    t3r_mcap_put_u32(out, 0); /* chunks */
    t3r_mcap_put_u64(out, recorder->first_ns);
    t3r_mcap_put_u64(out, recorder->last_ns);
    t3r_mcap_put_u32(out, channel_count * 10);
    for (uint32_t i = 0; i < channel_count; i++) {
        t3r_mcap_put_u16(out, (uint16_t)i);
        t3r_mcap_put_u64(out, recorder->messages[i]);
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

int t3r_recorder_end(t3r_recorder *recorder)
{
    if (recorder == NULL) {
        return -1;
    }
    static const t3r_mcap_opcode groups[] = {T3R_MCAP_SCHEMA, T3R_MCAP_CHANNEL, T3R_MCAP_STATISTICS,
                                             T3R_MCAP_METADATA_INDEX};
    enum { GROUPS = sizeof groups / sizeof groups[0] };
    t3r_mcap_writer *out = &recorder->out;
    uint64_t starts[GROUPS + 1];
    t3r_mcap_data_end(out);
    starts[0] = out->offset;
    put_schemas(recorder);
    starts[1] = out->offset;
    put_channels(recorder);
    starts[2] = out->offset;
    put_statistics(recorder);
    starts[3] = out->offset;
    put_metadata_index(recorder);
    starts[4] = out->offset;
    for (uint32_t i = 0; i < GROUPS; i++) {
        t3r_mcap_record(out, T3R_MCAP_SUMMARY_OFFSET, 1 + 8 + 8);
        t3r_mcap_put_u8(out, (uint8_t)groups[i]);
        t3r_mcap_put_u64(out, starts[i]);
        t3r_mcap_put_u64(out, starts[i + 1] - starts[i]);
    }
    t3r_mcap_finish(out, starts[0], starts[GROUPS]);
    end_message(recorder);
    return status(recorder);
}
