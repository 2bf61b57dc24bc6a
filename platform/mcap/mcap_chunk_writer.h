/* Chunks of MCAP files and their indexes. A chunk is measured before it is written, so that a sink that only appends
 * will do; what the summary says of the chunks is read back from the file, so that memory does not grow with it. */
#ifndef T3R_PLATFORM_MCAP_CHUNK_WRITER_H
#define T3R_PLATFORM_MCAP_CHUNK_WRITER_H

#include <stdint.h>

#include "mcap_writer.h"

#define T3R_MCAP_CHUNK_CHANNELS 8u /* most channels of a chunk; each has one message at most */

/* What is known of a chunk once its records are measured. */
typedef struct t3r_mcap_chunk {
    uint64_t first_ns, last_ns;
    uint64_t bytes; /* of the records */
    uint32_t crc;   /* of the records */
    uint32_t count;
    struct {
        uint16_t channel;
        uint64_t time_ns, offset; /* of the message's record in the chunk */
    } messages[T3R_MCAP_CHUNK_CHANNELS];
} t3r_mcap_chunk;

/* Notes a message of a chunk being measured, whose record starts at `offset`. */
void t3r_mcap_chunk_note(t3r_mcap_chunk *chunk, uint16_t channel, uint64_t time_ns, uint64_t offset);

/* Opens the chunk; packed_bytes bytes of records follow by t3r_mcap_put_raw(). compression: "" or as MCAP names it. */
void t3r_mcap_chunk_open(t3r_mcap_writer *writer, const t3r_mcap_chunk *chunk, const char *compression,
                         uint64_t packed_bytes);
/* The message indexes, which follow the chunk. */
void t3r_mcap_message_indexes(t3r_mcap_writer *writer, const t3r_mcap_chunk *chunk);

/* The chunk indexes of the summary: of the chunks, each with its message indexes, that fill the bytes from `start` to
 * `end` of the file. Reads them through the sink; sets writer->failed where that fails. */
void t3r_mcap_chunk_indexes(t3r_mcap_writer *writer, uint64_t start, uint64_t end);
/* The most bytes of one of them. */
#define T3R_MCAP_CHUNK_INDEX_BYTES (9u + 8 * 4 + 4 + T3R_MCAP_CHUNK_CHANNELS * 10 + 8 + 4 + 8 + 8 + 8)

#endif
