/* SPDX-License-Identifier: Apache-2.0 */
#include "mcap_chunk_writer.h"

#include <string.h>

#include "mcap_records.h"

#define MESSAGE_INDEX_BYTES (T3R_MCAP_RECORD_HEAD_BYTES + 2 + 4 + 16) /* for one message */

void t3r_mcap_chunk_note(t3r_mcap_chunk *chunk, uint16_t channel, uint64_t time_ns, uint64_t offset)
{
    uint32_t i = chunk->count++;
    chunk->first_ns = i == 0 || time_ns < chunk->first_ns ? time_ns : chunk->first_ns;
    chunk->last_ns = i == 0 || time_ns > chunk->last_ns ? time_ns : chunk->last_ns;
    chunk->messages[i].channel = channel;
    chunk->messages[i].time_ns = time_ns;
    chunk->messages[i].offset = offset;
}

void t3r_mcap_chunk_open(t3r_mcap_writer *writer, const t3r_mcap_chunk *chunk, const char *compression,
                         uint64_t packed_bytes)
{
    t3r_text name = t3r_text_of(compression);
    t3r_mcap_record(writer, T3R_MCAP_CHUNK, 8 + 8 + 8 + 4 + 4 + name.count + 8 + packed_bytes);
    t3r_mcap_put_u64(writer, chunk->first_ns);
    t3r_mcap_put_u64(writer, chunk->last_ns);
    t3r_mcap_put_u64(writer, chunk->bytes);
    t3r_mcap_put_u32(writer, chunk->crc);
    t3r_mcap_put_text(writer, name);
    t3r_mcap_put_u64(writer, packed_bytes);
}

void t3r_mcap_message_indexes(t3r_mcap_writer *writer, const t3r_mcap_chunk *chunk)
{
    for (uint32_t i = 0; i < chunk->count; i++) {
        t3r_mcap_record(writer, T3R_MCAP_MESSAGE_INDEX, 2 + 4 + 16);
        t3r_mcap_put_u16(writer, chunk->messages[i].channel);
        t3r_mcap_put_u32(writer, 16);
        t3r_mcap_put_u64(writer, chunk->messages[i].time_ns);
        t3r_mcap_put_u64(writer, chunk->messages[i].offset);
    }
}

/* A chunk and its message indexes as the file holds them. */
typedef struct written_chunk {
    uint64_t start, length; /* of the chunk record */
    uint8_t head[T3R_MCAP_RECORD_HEAD_BYTES + T3R_MCAP_CHUNK_FIELDS];
    t3r_mcap_chunk_record fields; /* points into head */
    uint32_t channels;
    uint8_t channel[T3R_MCAP_CHUNK_CHANNELS][2];
} written_chunk;

static int read_back(const t3r_mcap_writer *writer, uint64_t offset, uint64_t end, uint8_t *bytes, size_t room,
                     size_t *count)
{
    *count = end - offset < room ? (size_t)(end - offset) : room;
    return writer->sink.read(writer->sink.user, offset, bytes, *count);
}

/* Reads back a chunk. Returns 0, or -1 if the file differs from what was written. */
static int read_chunk(const t3r_mcap_writer *writer, uint64_t start, uint64_t end, written_chunk *out)
{
    uint8_t indexes[T3R_MCAP_CHUNK_CHANNELS * MESSAGE_INDEX_BYTES];
    size_t count;
    t3r_mcap_head head;
    if (read_back(writer, start, end, out->head, sizeof out->head, &count) != 0 || count < sizeof out->head ||
        !t3r_mcap_head_of(out->head, end - start, &head) || head.opcode != T3R_MCAP_CHUNK) {
        return -1;
    }
    t3r_mcap_fields in = {out->head + T3R_MCAP_RECORD_HEAD_BYTES, T3R_MCAP_CHUNK_FIELDS, 0, false};
    out->fields = t3r_mcap_chunk_of(&in);
    out->start = start;
    out->length = T3R_MCAP_RECORD_HEAD_BYTES + head.bytes;
    out->channels = 0;
    if (in.failed || read_back(writer, start + out->length, end, indexes, sizeof indexes, &count) != 0) {
        return -1;
    }
    while (out->channels < T3R_MCAP_CHUNK_CHANNELS && (out->channels + 1) * MESSAGE_INDEX_BYTES <= count &&
           indexes[out->channels * MESSAGE_INDEX_BYTES] == T3R_MCAP_MESSAGE_INDEX) {
        const uint8_t *index = indexes + out->channels * MESSAGE_INDEX_BYTES;
        memcpy(out->channel[out->channels++], index + T3R_MCAP_RECORD_HEAD_BYTES, 2);
    }
    return 0;
}

static void put_chunk_index(t3r_mcap_writer *writer, const written_chunk *chunk)
{
    const t3r_mcap_chunk_record *fields = &chunk->fields;
    t3r_mcap_record(writer, T3R_MCAP_CHUNK_INDEX,
                    16 + 8 + 8 + 4 + chunk->channels * 10 + 8 + 4 + fields->compression.count + 8 + 8);
    t3r_mcap_put_u64(writer, fields->first_ns);
    t3r_mcap_put_u64(writer, fields->last_ns);
    t3r_mcap_put_u64(writer, chunk->start);
    t3r_mcap_put_u64(writer, chunk->length);
    t3r_mcap_put_u32(writer, chunk->channels * 10);
    for (uint32_t i = 0; i < chunk->channels; i++) {
        t3r_mcap_put_raw(writer, chunk->channel[i], 2);
        t3r_mcap_put_u64(writer, chunk->start + chunk->length + i * MESSAGE_INDEX_BYTES);
    }
    t3r_mcap_put_u64(writer, (uint64_t)chunk->channels * MESSAGE_INDEX_BYTES);
    t3r_mcap_put_text(writer, fields->compression);
    t3r_mcap_put_u64(writer, fields->packed_bytes);
    t3r_mcap_put_u64(writer, fields->unpacked_bytes);
}

void t3r_mcap_chunk_indexes(t3r_mcap_writer *writer, uint64_t start, uint64_t end)
{
    while (start < end && !writer->failed) {
        written_chunk chunk;
        if (read_chunk(writer, start, end, &chunk) != 0) {
            writer->failed = true;
            return;
        }
        put_chunk_index(writer, &chunk);
        start = chunk.start + chunk.length + (uint64_t)chunk.channels * MESSAGE_INDEX_BYTES;
    }
}
