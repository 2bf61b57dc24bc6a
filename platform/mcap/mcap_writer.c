#include "mcap_writer.h"

#include "core/little_endian.h"
#include "crc32.h"

void t3r_mcap_put_raw(t3r_mcap_writer *writer, const void *bytes, size_t count)
{
    if (writer->failed || count == 0) {
        return;
    }
    writer->failed = writer->sink.write != NULL && writer->sink.write(writer->sink.user, bytes, count) != 0;
    writer->crc = t3r_crc32(writer->crc, bytes, count);
    writer->offset += count;
}

void t3r_mcap_put_u8(t3r_mcap_writer *writer, uint8_t x)
{
    t3r_mcap_put_raw(writer, &x, 1);
}

void t3r_mcap_put_u16(t3r_mcap_writer *writer, uint16_t x)
{
    uint8_t bytes[2];
    t3r_store_le16(bytes, x);
    t3r_mcap_put_raw(writer, bytes, sizeof bytes);
}

void t3r_mcap_put_u32(t3r_mcap_writer *writer, uint32_t x)
{
    uint8_t bytes[4];
    t3r_store_le32(bytes, x);
    t3r_mcap_put_raw(writer, bytes, sizeof bytes);
}

void t3r_mcap_put_u64(t3r_mcap_writer *writer, uint64_t x)
{
    uint8_t bytes[8];
    t3r_store_le64(bytes, x);
    t3r_mcap_put_raw(writer, bytes, sizeof bytes);
}

void t3r_mcap_put_text(t3r_mcap_writer *writer, t3r_text text)
{
    t3r_mcap_put_u32(writer, (uint32_t)text.count);
    t3r_mcap_put_raw(writer, text.chars, text.count);
}

void t3r_mcap_record(t3r_mcap_writer *writer, t3r_mcap_opcode opcode, uint64_t content_bytes)
{
    t3r_mcap_put_u8(writer, (uint8_t)opcode);
    t3r_mcap_put_u64(writer, content_bytes);
}

void t3r_mcap_begin(t3r_mcap_writer *writer, t3r_sink sink, t3r_text profile, t3r_text library)
{
    *writer = (t3r_mcap_writer){.sink = sink};
    t3r_mcap_put_raw(writer, T3R_MCAP_MAGIC, T3R_MCAP_MAGIC_BYTES);
    t3r_mcap_record(writer, T3R_MCAP_HEADER, 4 + profile.count + 4 + library.count);
    t3r_mcap_put_text(writer, profile);
    t3r_mcap_put_text(writer, library);
}

void t3r_mcap_schema(t3r_mcap_writer *writer, uint16_t id, t3r_text name, t3r_text encoding, t3r_text definition)
{
    t3r_mcap_record(writer, T3R_MCAP_SCHEMA, 2 + 4 + name.count + 4 + encoding.count + 4 + definition.count);
    t3r_mcap_put_u16(writer, id);
    t3r_mcap_put_text(writer, name);
    t3r_mcap_put_text(writer, encoding);
    t3r_mcap_put_text(writer, definition);
}

static uint32_t map_bytes(const t3r_mcap_pair *map, uint32_t pairs)
{
    size_t bytes = 0;
    for (uint32_t i = 0; i < pairs; i++) {
        bytes += 4 + map[i].key.count + 4 + map[i].value.count;
    }
    return (uint32_t)bytes;
}

static void put_map(t3r_mcap_writer *writer, const t3r_mcap_pair *map, uint32_t pairs)
{
    t3r_mcap_put_u32(writer, map_bytes(map, pairs));
    for (uint32_t i = 0; i < pairs; i++) {
        t3r_mcap_put_text(writer, map[i].key);
        t3r_mcap_put_text(writer, map[i].value);
    }
}

void t3r_mcap_channel(t3r_mcap_writer *writer, uint16_t id, uint16_t schema, t3r_text topic, t3r_text encoding,
                      const t3r_mcap_pair *metadata, uint32_t pairs)
{
    t3r_mcap_record(writer, T3R_MCAP_CHANNEL,
                    2 + 2 + 4 + topic.count + 4 + encoding.count + 4 + map_bytes(metadata, pairs));
    t3r_mcap_put_u16(writer, id);
    t3r_mcap_put_u16(writer, schema);
    t3r_mcap_put_text(writer, topic);
    t3r_mcap_put_text(writer, encoding);
    put_map(writer, metadata, pairs);
}

void t3r_mcap_metadata(t3r_mcap_writer *writer, t3r_text name, const t3r_mcap_pair *metadata, uint32_t pairs)
{
    t3r_mcap_record(writer, T3R_MCAP_METADATA, 4 + name.count + 4 + map_bytes(metadata, pairs));
    t3r_mcap_put_text(writer, name);
    put_map(writer, metadata, pairs);
}

void t3r_mcap_message(t3r_mcap_writer *writer, uint16_t channel, uint32_t sequence, uint64_t time_ns,
                      uint64_t data_bytes)
{
    t3r_mcap_record(writer, T3R_MCAP_MESSAGE, 2 + 4 + 8 + 8 + data_bytes);
    t3r_mcap_put_u16(writer, channel);
    t3r_mcap_put_u32(writer, sequence);
    t3r_mcap_put_u64(writer, time_ns); /* logged */
    t3r_mcap_put_u64(writer, time_ns); /* published */
}

void t3r_mcap_data_end(t3r_mcap_writer *writer)
{
    uint32_t crc = writer->crc; /* of everything before this record */
    t3r_mcap_record(writer, T3R_MCAP_DATA_END, 4);
    t3r_mcap_put_u32(writer, crc);
    writer->crc = 0;
}

void t3r_mcap_finish(t3r_mcap_writer *writer, uint64_t summary_start, uint64_t summary_offset_start)
{
    t3r_mcap_record(writer, T3R_MCAP_FOOTER, 8 + 8 + 4);
    t3r_mcap_put_u64(writer, summary_start);
    t3r_mcap_put_u64(writer, summary_offset_start);
    t3r_mcap_put_u32(writer, writer->crc); /* of the summary and this record so far */
    t3r_mcap_put_raw(writer, T3R_MCAP_MAGIC, T3R_MCAP_MAGIC_BYTES);
}

static int append(void *user, const void *bytes, size_t count)
{
    t3r_mcap_writer *writer = user;
    t3r_mcap_put_raw(writer, bytes, count);
    return writer->failed ? -1 : 0;
}

t3r_sink t3r_mcap_record_sink(t3r_mcap_writer *writer)
{
    return (t3r_sink){.write = append, .user = writer};
}
