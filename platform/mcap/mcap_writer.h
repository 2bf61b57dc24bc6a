/* SPDX-License-Identifier: Apache-2.0 */
/* Writes MCAP records through a sink: no heap, one pass, a running CRC-32. It knows records, not their meaning.
 *
 * A record is opened with its exact content size and then filled field by field; t3r_mcap_begin(), schema, channel and
 * metadata do both. Once the sink has failed, `failed` is set and nothing more is written. Without sink.write, bytes
 * are only counted and their CRC computed. */
#ifndef T3R_PLATFORM_MCAP_WRITER_H
#define T3R_PLATFORM_MCAP_WRITER_H

#include <stdbool.h>
#include <stdint.h>

#include "host/sink.h"
#include "host/text.h"
#include "mcap.h"

typedef struct t3r_mcap_writer {
    t3r_sink sink;
    uint64_t offset; /* bytes written */
    uint32_t crc;    /* CRC of the section so far */
    bool failed;
} t3r_mcap_writer;

typedef struct t3r_mcap_pair {
    t3r_text key, value;
} t3r_mcap_pair;

/* Writes the magic and the Header record. */
void t3r_mcap_begin(t3r_mcap_writer *writer, t3r_sink sink, t3r_text profile, t3r_text library);

/* Opens a record whose content is content_bytes long. */
void t3r_mcap_record(t3r_mcap_writer *writer, t3r_mcap_opcode opcode, uint64_t content_bytes);
void t3r_mcap_put_u8(t3r_mcap_writer *writer, uint8_t x);
void t3r_mcap_put_u16(t3r_mcap_writer *writer, uint16_t x);
void t3r_mcap_put_u32(t3r_mcap_writer *writer, uint32_t x);
void t3r_mcap_put_u64(t3r_mcap_writer *writer, uint64_t x);
void t3r_mcap_put_raw(t3r_mcap_writer *writer, const void *bytes, size_t count);
/* Writes a text after its 32-bit count. */
void t3r_mcap_put_text(t3r_mcap_writer *writer, t3r_text text);

void t3r_mcap_schema(t3r_mcap_writer *writer, uint16_t id, t3r_text name, t3r_text encoding, t3r_text definition);
void t3r_mcap_channel(t3r_mcap_writer *writer, uint16_t id, uint16_t schema, t3r_text topic, t3r_text encoding,
                      const t3r_mcap_pair *metadata, uint32_t pairs);
void t3r_mcap_metadata(t3r_mcap_writer *writer, t3r_text name, const t3r_mcap_pair *metadata, uint32_t pairs);
/* Opens a message; its data_bytes bytes follow by t3r_mcap_put_raw(). */
void t3r_mcap_message(t3r_mcap_writer *writer, uint16_t channel, uint32_t sequence, uint64_t time_ns,
                      uint64_t data_bytes);

/* Ends the data section; the summary follows. */
void t3r_mcap_data_end(t3r_mcap_writer *writer);
/* Writes the footer and the magic; 0 for a missing section. */
void t3r_mcap_finish(t3r_mcap_writer *writer, uint64_t summary_start, uint64_t summary_offset_start);

/* Returns a sink that appends to the open record. */
t3r_sink t3r_mcap_record_sink(t3r_mcap_writer *writer);

#endif
