/* SPDX-License-Identifier: Apache-2.0 */
/* MCAP records in memory (mcap.dev/spec), for the reader of whole files and the firmware's: no heap, no files. A
 * record may be given only by its first bytes: fields that reach past them are empty or 0, and `failed` is set. */
#ifndef T3R_PLATFORM_MCAP_RECORDS_H
#define T3R_PLATFORM_MCAP_RECORDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "host/text.h"
#include "mcap.h"

/* ---- fields, one after the other ---- */

typedef struct t3r_mcap_fields {
    const uint8_t *bytes;
    size_t count, at;
    bool failed; /* a field reached past the end; so do all later ones */
} t3r_mcap_fields;

/* Returns the bytes, or NULL past the end. */
const uint8_t *t3r_mcap_take(t3r_mcap_fields *in, uint64_t count);
uint16_t t3r_mcap_take_u16(t3r_mcap_fields *in);
uint32_t t3r_mcap_take_u32(t3r_mcap_fields *in);
uint64_t t3r_mcap_take_u64(t3r_mcap_fields *in);
t3r_text t3r_mcap_take_text(t3r_mcap_fields *in);

/* ---- records ---- */

typedef struct t3r_mcap_head {
    uint8_t opcode;
    uint64_t bytes; /* of the fields, which follow */
} t3r_mcap_head;

/* Reads the head of the record at `bytes`, `rest` bytes before the end of its chunk or file; reads at most
 * T3R_MCAP_RECORD_HEAD_BYTES. Returns whether the record ends within `rest`. */
bool t3r_mcap_head_of(const uint8_t *bytes, uint64_t rest, t3r_mcap_head *head);

/* Whether a record of that kind is allowed in a chunk; extensions are. */
bool t3r_mcap_in_chunk(uint8_t opcode);

typedef struct t3r_mcap_schema_record {
    uint16_t id; /* 0: to be ignored */
    t3r_text name, encoding, definition;
} t3r_mcap_schema_record;
t3r_mcap_schema_record t3r_mcap_schema_of(t3r_mcap_fields *in);

typedef struct t3r_mcap_channel_record {
    uint16_t id, schema;
    t3r_text topic, encoding;
} t3r_mcap_channel_record;
t3r_mcap_channel_record t3r_mcap_channel_of(t3r_mcap_fields *in);

typedef struct t3r_mcap_message_record {
    uint16_t channel;
    uint32_t sequence;
    uint64_t log_ns, publish_ns;
    const uint8_t *data; /* the available part */
    size_t bytes;
} t3r_mcap_message_record;
#define T3R_MCAP_MESSAGE_FIELDS 22u /* bytes before the data */
t3r_mcap_message_record t3r_mcap_message_of(t3r_mcap_fields *in);

typedef struct t3r_mcap_chunk_record {
    uint64_t first_ns, last_ns;
    uint64_t unpacked_bytes, packed_bytes;
    uint32_t crc; /* of the records; 0: not known */
    t3r_text compression;
} t3r_mcap_chunk_record;
#define T3R_MCAP_CHUNK_FIELDS                                                                                          \
    48u /* bytes before the records, with a name of 8 bytes; "zstd", "lz4" and "" are shorter */
/* The records follow. */
t3r_mcap_chunk_record t3r_mcap_chunk_of(t3r_mcap_fields *in);

/* The name; the available bytes of the pairs follow. */
typedef struct t3r_mcap_metadata_record {
    t3r_text name;
    t3r_mcap_fields pairs;
} t3r_mcap_metadata_record;
t3r_mcap_metadata_record t3r_mcap_metadata_of(t3r_mcap_fields *in);
/* Takes the next pair. Returns false at the end of the pairs, with pairs->failed if one is cut off. */
bool t3r_mcap_pair_of(t3r_mcap_fields *pairs, t3r_text *key, t3r_text *value);

/* ---- files ---- */

/* The command that makes an MCAP file of ROS 2 from a bag of ROS 1. */
#define T3R_MCAP_FROM_ROS1 "rosbags-convert --src FILE.bag --dst FOLDER --dst-storage mcap makes a bag of ROS 2"

/* Returns what another file is, by its first bytes, and what turns it into a recording; NULL if it is not known. */
const char *t3r_mcap_other_file(const uint8_t *bytes, size_t count);
/* Returns an error in the first bytes of a file, 8 or more if available, or NULL. */
const char *t3r_mcap_magic_error(const uint8_t *bytes, size_t count);

#endif
