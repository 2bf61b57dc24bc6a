/* SPDX-License-Identifier: Apache-2.0 */
#include "mcap_records.h"

#include <string.h>

#include "core/little_endian.h"

/* Written so that Frama-C, which tracks no relation between `at` and `count`, sees that the bytes are in range. */
const uint8_t *t3r_mcap_take(t3r_mcap_fields *in, uint64_t count)
{
    if (in->failed || count > in->count || in->at > in->count - count) {
        in->failed = true;
        return NULL;
    }
    const uint8_t *bytes = in->bytes + in->at;
    in->at += (size_t)count;
    return bytes;
}

uint16_t t3r_mcap_take_u16(t3r_mcap_fields *in)
{
    const uint8_t *bytes = t3r_mcap_take(in, 2);
    return bytes == NULL ? 0 : t3r_load_le16(bytes);
}

uint32_t t3r_mcap_take_u32(t3r_mcap_fields *in)
{
    const uint8_t *bytes = t3r_mcap_take(in, 4);
    return bytes == NULL ? 0 : t3r_load_le32(bytes);
}

uint64_t t3r_mcap_take_u64(t3r_mcap_fields *in)
{
    const uint8_t *bytes = t3r_mcap_take(in, 8);
    return bytes == NULL ? 0 : t3r_load_le64(bytes);
}

t3r_text t3r_mcap_take_text(t3r_mcap_fields *in)
{
    const uint32_t count = t3r_mcap_take_u32(in);
    const uint8_t *bytes = t3r_mcap_take(in, count);
    /* a missing text is empty, and points into the record like others */
    return bytes == NULL ? (t3r_text){(const char *)in->bytes, 0} : (t3r_text){(const char *)bytes, count};
}

bool t3r_mcap_head_of(const uint8_t *bytes, uint64_t rest, t3r_mcap_head *head)
{
    const bool whole = rest >= T3R_MCAP_RECORD_HEAD_BYTES;
    *head = (t3r_mcap_head){bytes[0], whole ? t3r_load_le64(bytes + 1) : 0};
    return whole && head->bytes <= rest - T3R_MCAP_RECORD_HEAD_BYTES;
}

bool t3r_mcap_in_chunk(uint8_t opcode)
{
    return opcode == T3R_MCAP_SCHEMA || opcode == T3R_MCAP_CHANNEL || opcode == T3R_MCAP_MESSAGE ||
           opcode > T3R_MCAP_DATA_END;
}

t3r_mcap_schema_record t3r_mcap_schema_of(t3r_mcap_fields *in)
{
    t3r_mcap_schema_record schema = {.id = t3r_mcap_take_u16(in)};
    schema.name = t3r_mcap_take_text(in);
    schema.encoding = t3r_mcap_take_text(in);
    schema.definition = t3r_mcap_take_text(in);
    return schema;
}

t3r_mcap_channel_record t3r_mcap_channel_of(t3r_mcap_fields *in)
{
    t3r_mcap_channel_record channel = {.id = t3r_mcap_take_u16(in)};
    channel.schema = t3r_mcap_take_u16(in);
    channel.topic = t3r_mcap_take_text(in);
    channel.encoding = t3r_mcap_take_text(in);
    t3r_mcap_take_text(in); /* the map of metadata, unused */
    return channel;
}

t3r_mcap_message_record t3r_mcap_message_of(t3r_mcap_fields *in)
{
    t3r_mcap_message_record message = {.channel = t3r_mcap_take_u16(in)};
    message.sequence = t3r_mcap_take_u32(in);
    message.log_ns = t3r_mcap_take_u64(in);
    message.publish_ns = t3r_mcap_take_u64(in);
    message.data = in->bytes + in->at;
    message.bytes = in->count - in->at;
    return message;
}

t3r_mcap_chunk_record t3r_mcap_chunk_of(t3r_mcap_fields *in)
{
    t3r_mcap_chunk_record chunk = {.first_ns = t3r_mcap_take_u64(in)};
    chunk.last_ns = t3r_mcap_take_u64(in);
    chunk.unpacked_bytes = t3r_mcap_take_u64(in);
    chunk.crc = t3r_mcap_take_u32(in);
    chunk.compression = t3r_mcap_take_text(in);
    chunk.packed_bytes = t3r_mcap_take_u64(in);
    return chunk;
}

t3r_mcap_metadata_record t3r_mcap_metadata_of(t3r_mcap_fields *in)
{
    t3r_mcap_metadata_record metadata = {.name = t3r_mcap_take_text(in)};
    const uint32_t count = t3r_mcap_take_u32(in);
    const size_t there = in->count - in->at;
    metadata.pairs = (t3r_mcap_fields){in->bytes + in->at, count < there ? count : there, 0, in->failed};
    t3r_mcap_take(in, count);
    return metadata;
}

bool t3r_mcap_pair_of(t3r_mcap_fields *pairs, t3r_text *key, t3r_text *value)
{
    if (pairs->at >= pairs->count) {
        return false;
    }
    *key = t3r_mcap_take_text(pairs);
    *value = t3r_mcap_take_text(pairs);
    return !pairs->failed;
}

#define T3R_MCAP_SCENE "a scene, not a recording: trim3r view, render and convert read it"
#define T3R_MCAP_VIDEO "a video: ffmpeg -i FILE FOLDER/%05d.png makes a folder of pictures"
#define T3R_MCAP_PICTURE "a picture: name the folder of pictures that it is in"

const char *t3r_mcap_other_file(const uint8_t *bytes, size_t count)
{
    static const struct {
        size_t at, bytes;
        const char *start, *what;
    } files[] = {
        {0, 7, "SQLite ", "a bag in SQLite (.db3): mcap convert FILE.db3 FILE.mcap makes an MCAP file of it"},
        {0, 7, "#ROSBAG", "a bag of ROS 1: " T3R_MCAP_FROM_ROS1},
        {0, 7, "rosbag2", "the list of a bag's files: name its folder"},
        {0, 4, "\x28\xb5\x2f\xfd", "packed with zstd: zstd -d unpacks it"},
        {0, 2, "\x1f\x8b", "packed with gzip: gzip -d unpacks it"},
        {0, 4, "PK\3\4", "a ZIP archive: unzip it, and import the folder"},
        {4, 7, "ftyphei", T3R_MCAP_PICTURE},
        {4, 8, "ftypmif1", T3R_MCAP_PICTURE},
        {4, 8, "ftypavif", T3R_MCAP_PICTURE},
        {4, 4, "ftyp", T3R_MCAP_VIDEO},
        {0, 4, "\x1a\x45\xdf\xa3", T3R_MCAP_VIDEO},
        {0, 3, "ply", T3R_MCAP_SCENE},
        {0, 4, "glTF", T3R_MCAP_SCENE},
        {0, 4, "NGSP", T3R_MCAP_SCENE},
        {0, 4, "\x89PNG", T3R_MCAP_PICTURE},
        {0, 3, "\xff\xd8\xff", T3R_MCAP_PICTURE},
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        if (count >= files[i].at + files[i].bytes && memcmp(bytes + files[i].at, files[i].start, files[i].bytes) == 0) {
            return files[i].what;
        }
    }
    return NULL;
}

const char *t3r_mcap_magic_error(const uint8_t *bytes, size_t count)
{
    size_t compared = count < T3R_MCAP_MAGIC_BYTES ? count : T3R_MCAP_MAGIC_BYTES;
    if (count == 0) {
        return "the file is empty";
    }
    if (memcmp(bytes, T3R_MCAP_MAGIC, compared) != 0) {
        bool other_version = count >= T3R_MCAP_MAGIC_BYTES && memcmp(bytes, T3R_MCAP_MAGIC, 5) == 0 &&
                             memcmp(bytes + 6, &T3R_MCAP_MAGIC[6], 2) == 0;
        const char *other = t3r_mcap_other_file(bytes, count);
        return other_version   ? "byte 5: an MCAP version other than 0"
               : other != NULL ? other
                               : "byte 0: not an MCAP file";
    }
    return count < T3R_MCAP_MAGIC_BYTES ? "cut off inside the magic of its first 8 bytes" : NULL;
}
