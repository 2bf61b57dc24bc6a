/* SPDX-License-Identifier: Apache-2.0 */
/* Reads MCAP files in memory, front to back: checks the bounds of every record, decompresses chunks, checks CRCs, and
 * passes each schema, channel, message and metadata record to a visitor. It knows records, not their meaning.
 *
 * A file that does not end with MCAP's magic was cut off: it is read up to its last complete record (inside a cut
 * chunk, up to the last complete record there). A chunk of such a file with a wrong CRC ends it too, since a file
 * system may leave zeros where a file was cut. In a file that does end with the magic, both are errors. */
#ifndef T3R_PLATFORM_MCAP_READER_H
#define T3R_PLATFORM_MCAP_READER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "mcap_records.h"
#include "spill.h"

/* The start of a record. */
typedef struct t3r_mcap_place {
    uint64_t offset; /* in the file, or in the chunk's decompressed data */
    bool in_chunk;
    uint64_t chunk_offset; /* of the chunk record in the file */
} t3r_mcap_place;

/* Each function returns 0 to go on, T3R_MCAP_KEPT if it keeps what the record points to, or -1 with its reason in the
 * error[] of t3r_mcap_read(). */
#define T3R_MCAP_KEPT 1
typedef struct t3r_mcap_visitor {
    void *user;
    int (*schema)(void *user, const t3r_mcap_schema_record *schema, t3r_mcap_place place);
    int (*channel)(void *user, const t3r_mcap_channel_record *channel, t3r_mcap_place place);
    int (*message)(void *user, const t3r_mcap_message_record *message, t3r_mcap_place place);
    /* Called for every pair of a metadata record. */
    int (*metadata)(void *user, t3r_text name, t3r_text key, t3r_text value, t3r_mcap_place place);
} t3r_mcap_visitor;

/* Decompressed chunks that messages point into; freed by t3r_mcap_chunks_free(). Initialise with zeros. */
typedef struct t3r_mcap_chunks {
    uint8_t **data;
    size_t count, capacity;
    uint64_t packed_bytes; /* stored bytes of the files so far, which the caller adds: they limit `bytes` */
    uint64_t bytes;   /* decompressed so far, kept or not; without a spill it includes what a visitor needs for messages
                           that it keeps */
    t3r_spill *spill; /* holds chunks that do not fit in memory; NULL: they are refused */
    uint64_t heap_bytes, message_bytes; /* with a spill: bytes of chunks kept on the heap, and for messages */
} t3r_mcap_chunks;
void t3r_mcap_chunks_free(t3r_mcap_chunks *chunks);

typedef struct t3r_mcap_end {
    bool cut;            /* the file ends too early */
    uint64_t cut_offset; /* start of the first incomplete record */
} t3r_mcap_end;

/* Reads a file. Returns 0, or -1 with "what, where" in error[]. */
int t3r_mcap_read(const uint8_t *bytes, size_t count, const t3r_mcap_visitor *visitor, t3r_mcap_chunks *chunks,
                  t3r_mcap_end *end, char *error, size_t error_bytes);

/* Writes "byte 123", or "byte 45 of the chunk at byte 123", for messages. */
#define T3R_MCAP_PLACE_BYTES 72
const char *t3r_mcap_place_text(t3r_mcap_place place, char text[T3R_MCAP_PLACE_BYTES]);

#endif
