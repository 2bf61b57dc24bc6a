/* SPDX-License-Identifier: Apache-2.0 */
#include "frame_reader.h"

#include <string.h>

#include "host/fixed_text.h"
#include "mcap/mcap_records.h"
#include "mcap/reader_limits.h"
#include "messages/cdr.h"
#include "messages/message_frame.h"
#include "messages/pixel_layout.h"

#define DEFAULT_UNIT_Q40 1099511628 /* 0.001, for recordings without the metadata "trim3r" */

/* A record's opcode and where its body begins and ends. */
typedef struct record {
    uint8_t opcode;
    uint64_t at, bytes;
} record;

/* The messages of one stamp so far. */
typedef struct instant {
    int64_t stamp_ns;
    bool begun, has_colour, has_pose;
    t3r_frame frame;
    t3r_camera pose;
    t3r_frame_reader_image colour, depth;
} instant;

static int fail(t3r_frame_reader *reader, const char *error)
{
    reader->error = error;
    return -1;
}

static int read_at(t3r_frame_reader *reader, uint64_t offset, void *bytes, size_t count)
{
    return reader->source.read(reader->source.user, offset, bytes, count) == 0
               ? 0
               : fail(reader, "the source does not give its bytes");
}

/* ---- records ---- */

/* Reads the head of the record at reader->at. Returns 1, or 0 at the end of the file or where it is cut off. */
static int read_record(t3r_frame_reader *reader, record *out)
{
    if (reader->chunk_end != 0 && reader->at == reader->chunk_end) {
        reader->chunk_end = 0;
    }
    const uint64_t rest = (reader->chunk_end != 0 ? reader->chunk_end : reader->source.bytes) - reader->at;
    uint8_t bytes[T3R_MCAP_RECORD_HEAD_BYTES] = {0};
    t3r_mcap_head head;
    if (rest >= sizeof bytes && read_at(reader, reader->at, bytes, sizeof bytes) != 0) {
        return -1;
    }
    if (!t3r_mcap_head_of(bytes, rest, &head)) {
        return reader->chunk_end != 0 ? fail(reader, "a record reaches past its chunk's end") : 0;
    }
    *out = (record){head.opcode, reader->at + sizeof bytes, head.bytes};
    return reader->chunk_end != 0 && !t3r_mcap_in_chunk(head.opcode)
               ? fail(reader, "a chunk holds a record that may not be in one")
               : 1;
}

static void pass_over(t3r_frame_reader *reader, const record *r)
{
    reader->at = r->at + r->bytes;
}

/* Reads the first `most` bytes of a record, for which there is room. */
static int open_fields(t3r_frame_reader *reader, const record *r, size_t most, t3r_mcap_fields *in)
{
    const size_t count = r->bytes < most ? (size_t)r->bytes : most;
    *in = (t3r_mcap_fields){reader->small, count, 0, false};
    return read_at(reader, r->at, reader->small, count);
}

/* ---- schemas and channels ---- */

static uint8_t type_named(t3r_text name)
{
    uint8_t type = 0;
    while (type < T3R_ROS_TYPE_COUNT && !t3r_ros_is_named((t3r_ros_type)type, name)) {
        type++;
    }
    return type;
}

static uint8_t type_of(const t3r_frame_reader_name *names, uint32_t count, uint16_t id)
{
    for (uint32_t i = 0; i < count; i++) {
        if (names[i].id == id) {
            return names[i].type;
        }
    }
    return T3R_ROS_TYPE_COUNT;
}

/* Keeps the first name of an id if its messages are read. There is room for all names of trim3r's own recordings. */
static void keep(t3r_frame_reader_name *names, uint32_t *count, uint16_t id, uint8_t type)
{
    if (type < T3R_ROS_TYPE_COUNT && *count < T3R_FRAME_READER_NAMES &&
        type_of(names, *count, id) == T3R_ROS_TYPE_COUNT) {
        names[(*count)++] = (t3r_frame_reader_name){id, type};
    }
}

static int read_schema(t3r_frame_reader *reader, const record *r)
{
    t3r_mcap_fields in;
    if (open_fields(reader, r, sizeof reader->small, &in) != 0) {
        return -1;
    }
    const t3r_mcap_schema_record schema = t3r_mcap_schema_of(&in);
    keep(reader->schemas, &reader->schema_count, schema.id, type_named(schema.name));
    return 0;
}

static int read_channel(t3r_frame_reader *reader, const record *r)
{
    t3r_mcap_fields in;
    if (open_fields(reader, r, sizeof reader->small, &in) != 0) {
        return -1;
    }
    const t3r_mcap_channel_record channel = t3r_mcap_channel_of(&in);
    if (t3r_text_is(channel.encoding, "cdr")) {
        keep(reader->channels, &reader->channel_count, channel.id,
             type_of(reader->schemas, reader->schema_count, channel.schema));
    }
    return 0;
}

static int read_metadata(t3r_frame_reader *reader, const record *r)
{
    t3r_mcap_fields in;
    if (open_fields(reader, r, sizeof reader->small, &in) != 0) {
        return -1;
    }
    t3r_mcap_metadata_record metadata = t3r_mcap_metadata_of(&in);
    t3r_text key, value;
    while (t3r_text_is(metadata.name, "trim3r") && t3r_mcap_pair_of(&metadata.pairs, &key, &value)) {
        if (!t3r_text_is(key, "depth_unit")) {
            continue;
        }
        if (t3r_q40_from_text(value, &reader->depth_unit_q40) != 0 || reader->depth_unit_q40 == 0 ||
            reader->depth_unit_q40 >= (uint64_t)T3R_LIMIT_DEPTH_UNIT << 40) {
            return fail(reader, "depth_unit is not a decimal number such as 0.001, above 0 and below 128");
        }
    }
    return 0;
}

/* Continues with the records inside the chunk. */
static int enter_chunk(t3r_frame_reader *reader, const record *r)
{
    t3r_mcap_fields in;
    if (open_fields(reader, r, T3R_MCAP_CHUNK_FIELDS, &in) != 0) {
        return -1;
    }
    const t3r_mcap_chunk_record chunk = t3r_mcap_chunk_of(&in);
    if (in.failed) {
        return fail(reader, "a chunk is cut short");
    }
    if (chunk.compression.count > 0) {
        return fail(reader, "its chunks are compressed; trim3r import --compression none unpacks them");
    }
    if (chunk.packed_bytes != r->bytes - in.at) {
        return fail(reader, "a chunk's size is not that of its records");
    }
    reader->at = r->at + in.at;
    reader->chunk_end = r->at + r->bytes;
    return 0;
}

/* ---- messages ---- */

/* Whether an image message is depth, by its first bytes. */
static int is_depth_image(t3r_frame_reader *reader, const record *data, bool *depth)
{
    const size_t count = data->bytes < sizeof reader->small ? (size_t)data->bytes : sizeof reader->small;
    if (read_at(reader, data->at, reader->small, count) != 0) {
        return -1;
    }
    t3r_cdr_reader in;
    t3r_cdr_open(&in, reader->small, count);
    t3r_cdr_get_u32(&in); /* seconds */
    t3r_cdr_get_u32(&in); /* nanoseconds */
    t3r_cdr_get_string(&in);
    t3r_cdr_get_u32(&in); /* height */
    t3r_cdr_get_u32(&in); /* width */
    const t3r_ros_image image = {.encoding = t3r_cdr_get_string(&in)};
    *depth = t3r_message_is_depth(&image);
    return in.failed ? fail(reader, "an image message is cut short") : 0;
}

/* Reads a message except its rows. */
static int read_image(t3r_frame_reader *reader, const record *data, t3r_frame_reader_image *image)
{
    const size_t count = data->bytes < sizeof reader->small ? (size_t)data->bytes : sizeof reader->small;
    if (read_at(reader, data->at, reader->small, count) != 0) {
        return -1;
    }
    size_t head_bytes;
    const char *wrong = t3r_ros_read_image_head(reader->small, count, &image->message, &head_bytes);
    if (wrong != NULL) {
        return fail(reader, wrong);
    }
    image->at = data->at + head_bytes;
    return image->message.data_bytes <= data->bytes - head_bytes ? 0 : fail(reader, "data is cut short");
}

static int read_colour(t3r_frame_reader *reader, const record *data, instant *now)
{
    if (read_image(reader, data, &now->colour) != 0) {
        return -1;
    }
    const char *wrong = t3r_message_colour_shape(&now->colour.message, &now->frame);
    now->has_colour = wrong == NULL;
    return wrong == NULL ? 0 : fail(reader, wrong);
}

static int read_depth(t3r_frame_reader *reader, const record *data, instant *now)
{
    if (reader->depth == NULL) {
        return 0;
    }
    t3r_ros_image *message = &now->depth.message;
    if (read_image(reader, data, &now->depth) != 0) {
        return -1;
    }
    const char *wrong = t3r_message_depth(message, &now->frame);
    if (wrong != NULL) {
        return fail(reader, wrong);
    }
    message->encoding =
        t3r_text_of(t3r_message_is_metres(message) ? "32FC1" : "16UC1"); /* replaced, because its own is overwritten */
    now->frame.depth_unit_q40 = reader->depth_unit_q40;
    return 0;
}

static int read_any_image(t3r_frame_reader *reader, uint16_t channel, const record *data, instant *now)
{
    if (channel != reader->colour_channel && channel != reader->depth_channel) {
        bool depth;
        if (is_depth_image(reader, data, &depth) != 0) {
            return -1;
        }
        int32_t *chosen = depth ? &reader->depth_channel : &reader->colour_channel;
        if (*chosen >= 0) {
            return 0; /* the first one of a kind counts */
        }
        *chosen = channel;
    }
    return channel == reader->colour_channel ? read_colour(reader, data, now) : read_depth(reader, data, now);
}

static int read_camera_info(t3r_frame_reader *reader, const uint8_t *bytes, size_t count)
{
    t3r_ros_camera_info info;
    t3r_camera camera = {0};
    const char *wrong = t3r_ros_read_camera_info(bytes, count, &info);
    wrong = wrong != NULL ? wrong : t3r_message_intrinsics(&info, &camera);
    if (wrong != NULL) {
        return fail(reader, wrong);
    }
    reader->camera = camera;
    reader->has_intrinsics = true;
    return 0;
}

static int read_pose(t3r_frame_reader *reader, t3r_ros_type type, const uint8_t *bytes, size_t count, instant *now)
{
    t3r_ros_pose pose;
    const char *wrong = t3r_ros_read_pose(type, bytes, count, &pose);
    wrong = wrong != NULL ? wrong : t3r_message_pose(&pose, &now->pose);
    now->has_pose = wrong == NULL;
    return wrong == NULL ? 0 : fail(reader, wrong);
}

static int read_small(t3r_frame_reader *reader, t3r_ros_type type, const record *data, instant *now)
{
    if (data->bytes > sizeof reader->small) {
        return fail(reader, "a message of a camera or a pose is larger than 1,024 bytes");
    }
    const size_t count = (size_t)data->bytes;
    if (read_at(reader, data->at, reader->small, count) != 0) {
        return -1;
    }
    return type == T3R_ROS_CAMERA_INFO ? read_camera_info(reader, reader->small, count)
                                       : read_pose(reader, type, reader->small, count, now);
}

/* Reads header.stamp, with which every message of these types begins; 0 stands for the log time. */
static int read_stamp(t3r_frame_reader *reader, const record *data, uint64_t log_ns, int64_t *stamp_ns)
{
    uint8_t bytes[12]; /* the encapsulation, seconds, nanoseconds */
    if (data->bytes < sizeof bytes) {
        return fail(reader, "a message is cut short");
    }
    if (read_at(reader, data->at, bytes, sizeof bytes) != 0) {
        return -1;
    }
    t3r_cdr_reader in;
    t3r_cdr_open(&in, bytes, sizeof bytes);
    const uint32_t seconds = t3r_cdr_get_u32(&in), nanoseconds = t3r_cdr_get_u32(&in);
    *stamp_ns = (int32_t)seconds * INT64_C(1000000000) + nanoseconds;
    *stamp_ns = *stamp_ns != 0 ? *stamp_ns : (int64_t)(log_ns & INT64_MAX);
    return in.failed ? fail(reader, "a message is no plain CDR") : 0;
}

/* Reads a message. Returns 1, and leaves it in place, if it belongs to the next instant. */
static int read_message(t3r_frame_reader *reader, const record *r, instant *now)
{
    t3r_mcap_fields in;
    if (open_fields(reader, r, T3R_MCAP_MESSAGE_FIELDS, &in) != 0) {
        return -1;
    }
    const t3r_mcap_message_record message = t3r_mcap_message_of(&in);
    if (in.failed) {
        return fail(reader, "a message is cut short");
    }
    const uint8_t type = type_of(reader->channels, reader->channel_count, message.channel);
    const bool is_pose = type < T3R_ROS_TYPE_COUNT && t3r_ros_is_pose((t3r_ros_type)type);
    if (type != T3R_ROS_IMAGE && type != T3R_ROS_CAMERA_INFO && !is_pose) {
        return 0;
    }
    const record data = {r->opcode, r->at + in.at, r->bytes - in.at};
    int64_t stamp_ns;
    if (read_stamp(reader, &data, message.log_ns, &stamp_ns) != 0) {
        return -1;
    }
    if (now->begun && stamp_ns != now->stamp_ns) {
        if (now->has_colour) {
            return 1;
        }
        *now = (instant){0};
    }
    now->begun = true;
    now->stamp_ns = stamp_ns;
    return type == T3R_ROS_IMAGE ? read_any_image(reader, message.channel, &data, now)
                                 : read_small(reader, (t3r_ros_type)type, &data, now);
}

/* Reads a record. Returns 1 if the instant is complete. */
static int take_record(t3r_frame_reader *reader, const record *r, instant *now)
{
    switch (r->opcode) {
    case T3R_MCAP_SCHEMA:
        return read_schema(reader, r);
    case T3R_MCAP_CHANNEL:
        return read_channel(reader, r);
    case T3R_MCAP_METADATA:
        return read_metadata(reader, r);
    case T3R_MCAP_MESSAGE:
        return read_message(reader, r, now);
    default:
        return 0;
    }
}

/* ---- frames ---- */

static int finish(t3r_frame_reader *reader, const instant *now, t3r_capture_frame *frame)
{
    if (reader->has_intrinsics &&
        (reader->camera.width != now->frame.width || reader->camera.height != now->frame.height)) {
        return fail(reader, "the size in a CameraInfo is not the image's");
    }
    *frame = (t3r_capture_frame){
        .index = reader->frames,
        .sequence = reader->frames,
        .stamp_ns = now->stamp_ns,
        .depth_stamp_ns = now->stamp_ns,
        .has_pose = now->has_pose,
        .has_intrinsics = reader->has_intrinsics,
        .frame = now->frame,
        .camera = reader->camera,
    };
    memcpy(frame->camera.position_q32, now->pose.position_q32, sizeof frame->camera.position_q32);
    memcpy(frame->camera.rotation_q30, now->pose.rotation_q30, sizeof frame->camera.rotation_q30);
    reader->frames++;
    reader->colour_image = now->colour;
    reader->depth_image = now->depth;
    reader->format = now->frame.format;
    return 0;
}

int t3r_frame_reader_open(t3r_frame_reader *reader, const t3r_byte_source *source, uint8_t *colour, size_t colour_room,
                          uint8_t *depth, size_t depth_room)
{
    *reader = (t3r_frame_reader){
        .source = *source,
        .colour = colour,
        .depth = depth,
        .colour_room = colour_room,
        .depth_room = depth_room,
        .at = T3R_MCAP_MAGIC_BYTES,
        .colour_channel = -1,
        .depth_channel = -1,
        .depth_unit_q40 = DEFAULT_UNIT_Q40,
    };
    uint8_t magic[T3R_MCAP_MAGIC_BYTES] = {0};
    if (source->bytes >= sizeof magic && read_at(reader, 0, magic, sizeof magic) != 0) {
        return -1;
    }
    return memcmp(magic, T3R_MCAP_MAGIC, sizeof magic) == 0 ? 0 : fail(reader, "this is no MCAP file");
}

int t3r_frame_reader_find(t3r_frame_reader *reader, t3r_capture_frame *frame)
{
    instant now = {0};
    int status = 0;
    record r;
    while (status == 0 && reader->error == NULL && read_record(reader, &r) == 1) {
        if (r.opcode == T3R_MCAP_DATA_END) {
            break; /* an index follows */
        }
        if (r.opcode == T3R_MCAP_CHUNK) {
            status = enter_chunk(reader, &r);
            continue;
        }
        status = take_record(reader, &r, &now);
        if (status == 0) {
            pass_over(reader, &r);
        }
    }
    if (reader->error != NULL || (now.has_colour && finish(reader, &now, frame) != 0)) {
        return T3R_CAPTURE_FAILED;
    }
    return now.has_colour ? T3R_CAPTURE_FRAME : T3R_CAPTURE_END;
}

/* ---- rows ---- */

static int check_rows(t3r_frame_reader *reader, const t3r_frame_reader_image *from, uint32_t row, uint32_t rows)
{
    const uint32_t height = from->message.height;
    return row <= height && rows <= height - row ? 0 : fail(reader, "these rows are not in the image");
}

/* Reads rows of the source from `row` on; NV12's chroma rows follow the others. */
static int read_rows(t3r_frame_reader *reader, const t3r_frame_reader_image *from, uint32_t row, uint32_t rows,
                     uint8_t *out)
{
    const uint64_t step = from->message.step;
    return rows == 0 ? 0 : read_at(reader, from->at + row * step, out, (size_t)(rows * step));
}

static int read_colour_rows(t3r_frame_reader *reader, t3r_frame *frame, uint32_t row, uint32_t rows)
{
    const t3r_frame_reader_image *from = &reader->colour_image;
    const uint32_t height = from->message.height;
    const uint32_t chroma_row = t3r_pixel_rows(reader->format, 1, row),
                   chroma = t3r_pixel_rows(reader->format, 1, rows);
    const uint64_t step = from->message.step, chroma_at = rows * step;
    if (check_rows(reader, from, row, rows) != 0) {
        return -1;
    }
    if ((rows + chroma) * step > reader->colour_room) {
        return fail(reader, "an image is larger than its buffer");
    }
    frame->planes[0] = reader->colour;
    frame->planes[1] = chroma > 0 ? reader->colour + chroma_at : NULL;
    return read_rows(reader, from, row, rows, reader->colour) == 0
               ? read_rows(reader, from, height + chroma_row, chroma, reader->colour + chroma_at)
               : -1;
}

/* Converts samples to steps in place. */
static int read_depth_rows(t3r_frame_reader *reader, t3r_frame *frame, uint32_t row, uint32_t rows)
{
    const t3r_frame_reader_image *from = &reader->depth_image;
    t3r_ros_image part = from->message;
    if (check_rows(reader, from, row, rows) != 0) {
        return -1;
    }
    if ((uint64_t)rows * part.step > reader->depth_room) {
        return fail(reader, "an image is larger than its buffer");
    }
    if (read_rows(reader, from, row, rows, reader->depth) != 0) {
        return -1;
    }
    if (!t3r_message_is_z16(&part)) {
        part.height = rows;
        part.data = reader->depth;
        t3r_message_to_z16(&part, reader->depth_unit_q40, reader->depth);
    }
    frame->depth = reader->depth;
    return 0;
}

int t3r_frame_reader_rows(t3r_frame_reader *reader, t3r_frame *frame, uint32_t row, uint32_t rows, uint32_t depth_row,
                          uint32_t depth_rows)
{
    if (reader->error != NULL || read_colour_rows(reader, frame, row, rows) != 0) {
        return -1;
    }
    return reader->depth_image.at == 0 ? 0 : read_depth_rows(reader, frame, depth_row, depth_rows);
}

int t3r_frame_reader_next(t3r_frame_reader *reader, t3r_capture_frame *frame)
{
    const int status = t3r_frame_reader_find(reader, frame);
    if (status != T3R_CAPTURE_FRAME) {
        return status;
    }
    const t3r_frame *found = &frame->frame;
    return t3r_frame_reader_rows(reader, &frame->frame, 0, found->height, 0, found->depth_height) == 0
               ? T3R_CAPTURE_FRAME
               : T3R_CAPTURE_FAILED;
}
