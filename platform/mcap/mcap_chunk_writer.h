/* Chunks of MCAP files and their indexes. A chunk is measured before it is written, so that a sink that only appends is
 * enough. The summary's chunk indexes are read back from the file, so that memory does not grow with it. */
#ifndef T3R_PLATFORM_MCAP_CHUNK_WRITER_H
#define T3R_PLATFORM_MCAP_CHUNK_WRITER_H

#include <stdint.h>

#include "mcap_writer.h"

#define T3R_MCAP_CHUNK_CHANNELS 8u /* most channels of a chunk; each has one message at most */

/* A chunk whose records have been measured. */
typedef struct t3r_mcap_chunk {
    uint64_t first_ns, last_ns;
    uint64_t bytes; /* of the records */
    uint32_t crc;   /* of the records */
    uint32_t count;
    struct {
        uint16_t channel;
        uint64_t time_ns, offset; /* time and offset of the message's record in the chunk */
    } messages[T3R_MCAP_CHUNK_CHANNELS];
} t3r_mcap_chunk;

/* Notes a message of a chunk being measured, whose record starts at `offset`. */
void t3r_mcap_chunk_note(t3r_mcap_chunk *chunk, uint16_t channel, uint64_t time_ns, uint64_t offset);

/* Opens the chunk; packed_bytes bytes of records follow by t3r_mcap_put_raw(). compression: "" or MCAP's name. */
void t3r_mcap_chunk_open(t3r_mcap_writer *writer, const t3r_mcap_chunk *chunk, const char *compression,
                         uint64_t packed_bytes);
/* Writes the message indexes, which follow the chunk. */
void t3r_mcap_message_indexes(t3r_mcap_writer *writer, const t3r_mcap_chunk *chunk);

/* Writes the summary's chunk indexes for all chunks, each followed by its message indexes, between the bytes `start`
 * and `end` of the file. Reads them through the sink; sets writer->failed if that fails. */
void t3r_mcap_chunk_indexes(t3r_mcap_writer *writer, uint64_t start, uint64_t end);
/* The most bytes of one chunk index. */
#define T3R_MCAP_CHUNK_INDEX_BYTES (9u + 8 * 4 + 4 + T3R_MCAP_CHUNK_CHANNELS * 10 + 8 + 4 + 8 + 8 + 8)

#endif
