/* SPDX-License-Identifier: Apache-2.0 */
#include "mcap_reader.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "chunk_codec.h"
#include "host/grow.h"
#include "host/reason.h"
#include "reader_limits.h"

#define REST_BYTES (UINT64_C(32) << 20) /* read from a file in the spill before its pages may be dropped */

typedef struct walk {
    const t3r_mcap_visitor *visitor;
    t3r_mcap_chunks *chunks;
    const uint8_t *bytes;
    uint64_t limit;    /* end of the records: at the end magic, or where the file was cut */
    bool cut;          /* the file has no end magic */
    uint64_t data_end; /* where the summary starts; 0 while in the data section */
    uint32_t crc;      /* CRC-32 of the bytes before crc_end */
    uint64_t crc_end;
    bool damaged; /* a chunk of a cut file is corrupt: reading ends before it */
    char *error;
    size_t error_bytes;
} walk;

/* ---- reasons ---- */

const char *t3r_mcap_place_text(t3r_mcap_place place, char text[T3R_MCAP_PLACE_BYTES])
{
    if (place.in_chunk) {
        snprintf(text, T3R_MCAP_PLACE_BYTES, "byte %" PRIu64 " of the chunk at byte %" PRIu64, place.offset,
                 place.chunk_offset);
    } else {
        snprintf(text, T3R_MCAP_PLACE_BYTES, "byte %" PRIu64, place.offset);
    }
    return text;
}

static const char *record_name(uint8_t opcode)
{
    static const char *const names[] = {"unknown",    "Header",        "Footer",          "Schema",
                                        "Channel",    "Message",       "Chunk",           "MessageIndex",
                                        "ChunkIndex", "Attachment",    "AttachmentIndex", "Statistics",
                                        "Metadata",   "MetadataIndex", "SummaryOffset",   "DataEnd"};
    return names[opcode < sizeof names / sizeof names[0] ? opcode : 0];
}

static int malformed(walk *w, uint8_t opcode, t3r_mcap_place place, const char *what)
{
    char text[T3R_MCAP_PLACE_BYTES];
    return t3r_reason(w->error, w->error_bytes, "%s record at %s: %s", record_name(opcode),
                      t3r_mcap_place_text(place, text), what);
}

static const char *const short_fields = "a field reaches past the record's end";

/* ---- records that visitors get ---- */

static int read_schema(walk *w, t3r_mcap_fields *in, t3r_mcap_place place)
{
    const t3r_mcap_schema_record schema = t3r_mcap_schema_of(in);
    if (in->failed) {
        return malformed(w, T3R_MCAP_SCHEMA, place, short_fields);
    }
    return schema.id == 0 ? 0 : w->visitor->schema(w->visitor->user, &schema, place);
}

static int read_channel(walk *w, t3r_mcap_fields *in, t3r_mcap_place place)
{
    const t3r_mcap_channel_record channel = t3r_mcap_channel_of(in);
    return in->failed ? malformed(w, T3R_MCAP_CHANNEL, place, short_fields)
                      : w->visitor->channel(w->visitor->user, &channel, place);
}

static int read_message(walk *w, t3r_mcap_fields *in, t3r_mcap_place place)
{
    const t3r_mcap_message_record message = t3r_mcap_message_of(in);
    return in->failed ? malformed(w, T3R_MCAP_MESSAGE, place, short_fields)
                      : w->visitor->message(w->visitor->user, &message, place);
}

static int read_metadata(walk *w, t3r_mcap_fields *in, t3r_mcap_place place)
{
    t3r_mcap_metadata_record metadata = t3r_mcap_metadata_of(in);
    t3r_text key, value;
    while (!in->failed && t3r_mcap_pair_of(&metadata.pairs, &key, &value)) {
        if (w->visitor->metadata(w->visitor->user, metadata.name, key, value, place) < 0) {
            return -1;
        }
    }
    return in->failed || metadata.pairs.failed ? malformed(w, T3R_MCAP_METADATA, place, short_fields) : 0;
}

static int read_attachment(walk *w, t3r_mcap_fields *in, t3r_mcap_place place)
{
    t3r_mcap_take_u64(in); /* log_time */
    t3r_mcap_take_u64(in); /* create_time */
    t3r_mcap_take_text(in);
    t3r_mcap_take_text(in);
    uint64_t bytes = t3r_mcap_take_u64(in);
    t3r_mcap_take(in, bytes);
    size_t checked = in->at;
    uint32_t crc = t3r_mcap_take_u32(in);
    if (in->failed) {
        return malformed(w, T3R_MCAP_ATTACHMENT, place, short_fields);
    }
    if (crc != 0 && crc != crc32_z(0, in->bytes, checked)) {
        return malformed(w, T3R_MCAP_ATTACHMENT, place, "its CRC does not match its bytes");
    }
    return 0;
}

/* ---- chunks ---- */

static int count_message(walk *w)
{
    if (w->chunks->spill != NULL) {
        w->chunks->message_bytes += T3R_LIMIT_MESSAGE_BYTES;
        return w->chunks->message_bytes <= T3R_LIMIT_INDEX_BYTES ? 0 : -1;
    }
    w->chunks->bytes += T3R_LIMIT_MESSAGE_BYTES;
    return w->chunks->bytes <= t3r_limit_unpacked_whole(w->chunks->packed_bytes) ? 0 : -1;
}

/* Walks the records of a chunk. A record that reaches past the end is an error; in a cut chunk it ends the chunk.
 * Returns 0, T3R_MCAP_KEPT if the visitor keeps any record, or -1. */
static int walk_chunk(walk *w, const uint8_t *bytes, size_t count, uint64_t chunk_offset, bool cut, bool packed)
{
    t3r_mcap_place place = {0, true, chunk_offset};
    int kept = 0;
    for (size_t at = 0; at < count;) {
        place.offset = at;
        t3r_mcap_head head;
        if (!t3r_mcap_head_of(bytes + at, count - at, &head)) {
            return cut ? kept : malformed(w, head.opcode, place, "it reaches past the chunk's end");
        }
        if (!t3r_mcap_in_chunk(head.opcode)) {
            return malformed(w, head.opcode, place, "it may not be in a chunk");
        }
        at += T3R_MCAP_RECORD_HEAD_BYTES;
        t3r_mcap_fields in = {bytes + at, (size_t)head.bytes, 0, false};
        const int status = head.opcode == T3R_MCAP_SCHEMA    ? read_schema(w, &in, place)
                           : head.opcode == T3R_MCAP_CHANNEL ? read_channel(w, &in, place)
                           : head.opcode == T3R_MCAP_MESSAGE ? read_message(w, &in, place)
                                                             : 0;
        if (status < 0) {
            return -1;
        }
        kept |= status;
        if (packed && status == T3R_MCAP_KEPT && count_message(w) != 0) {
            return malformed(w, head.opcode, place, "the chunks unpack to more messages than such a file may have");
        }
        at += (size_t)head.bytes;
    }
    return kept;
}

/* Makes room in w->chunks for one more; -1 when memory is out. */
static int reserve_chunk(walk *w)
{
    t3r_mcap_chunks *chunks = w->chunks;
    uint8_t **grown = t3r_grow(chunks->data, chunks->count, &chunks->capacity, sizeof *chunks->data);
    chunks->data = grown != NULL ? grown : chunks->data;
    return grown != NULL ? 0 : -1;
}

/* Refuses chunks of `bytes` bytes, before memory is allocated; 0 if they are allowed. */
static int check_unpacked(walk *w, t3r_mcap_place place, uint64_t bytes)
{
    const uint64_t most = w->chunks->spill != NULL ? t3r_limit_unpacked(w->chunks->packed_bytes)
                                                   : t3r_limit_unpacked_whole(w->chunks->packed_bytes);
    const uint64_t all = w->chunks->bytes;
    if (all <= most && bytes <= most - all) {
        return 0;
    }
    char what[200];
    snprintf(what, sizeof what,
             "it unpacks to %" PRIu64 " bytes, those before it to %" PRIu64 ": a file of %" PRIu64
             " may unpack to %" PRIu64 "; one without compression is read at any size",
             bytes, all, w->chunks->packed_bytes, most);
    return malformed(w, T3R_MCAP_CHUNK, place, what);
}

/* A chunk, and the available part of its content. */
typedef struct chunk {
    t3r_mcap_chunk_record record;
    const uint8_t *packed;
    size_t packed_bytes;
    bool cut;
} chunk;

/* A chunk's records. */
typedef struct unpacked {
    uint8_t *bytes; /* NULL: none */
    size_t room;
    bool spilled;
} unpacked;

static unpacked take_room(walk *w, size_t room)
{
    const t3r_mcap_chunks *chunks = w->chunks;
    unpacked out = {.room = room > 0 ? room : 1};
    out.spilled = chunks->spill != NULL && chunks->heap_bytes + out.room > T3R_LIMIT_UNPACKED_HEAP;
    out.bytes = reserve_chunk(w) != 0 ? NULL : out.spilled ? t3r_spill_take(chunks->spill, out.room) : malloc(out.room);
    return out;
}

/* Keeps a chunk's records if messages point into them, else frees them. */
static void leave_room(walk *w, const unpacked *u, bool is_kept)
{
    t3r_mcap_chunks *chunks = w->chunks;
    if (u->spilled && is_kept) {
        t3r_spill_rest(chunks->spill);
    } else if (u->spilled && u->bytes != NULL) {
        t3r_spill_return(chunks->spill, u->room);
    } else if (is_kept) {
        chunks->data[chunks->count++] = u->bytes;
        chunks->heap_bytes += u->room;
    } else {
        free(u->bytes);
    }
}

/* Decompresses a chunk's records into separate memory, which leave_room() releases also on failure; *count is their
 * size. Returns NULL, or what is wrong with the data, as happens in a cut chunk; other errors set *status to -1 with
 * the reason given. */
static const char *unpack_chunk(walk *w, const chunk *c, t3r_mcap_place place, unpacked *out, size_t *count,
                                int *status)
{
    if (!t3r_chunk_codec_known(c->record.compression)) {
        char name[32], what[96];
        t3r_text_copy(name, sizeof name, c->record.compression);
        snprintf(what, sizeof what, "its compression '%s' is not supported (lz4 and zstd are)", name);
        *status = malformed(w, T3R_MCAP_CHUNK, place, what);
        return NULL;
    }
    if (check_unpacked(w, place, c->record.unpacked_bytes) != 0) {
        *status = -1;
        return NULL;
    }
    uint64_t most = t3r_chunk_codec_most(c->record.compression, c->packed_bytes);
    if (c->record.unpacked_bytes > most && !c->cut) {
        return "its uncompressed_size is more than its data can hold";
    }
    uint64_t room = c->record.unpacked_bytes < most ? c->record.unpacked_bytes : most;
    *out = take_room(w, (size_t)room);
    if (out->bytes == NULL) {
        *status = malformed(w, T3R_MCAP_CHUNK, place,
                            out->spilled ? "there is no room on the disk for what it unpacks to (TMPDIR names another)"
                                         : "out of memory");
        return NULL;
    }
    w->chunks->bytes += room;
    const char *wrong =
        t3r_chunk_decompress(c->record.compression, c->packed, c->packed_bytes, out->bytes, (size_t)room, count);
    return wrong == NULL && *count != c->record.unpacked_bytes ? "its data are shorter than its uncompressed_size"
                                                               : wrong;
}

/* Returns the CRC-32 of the file's bytes before `end`; a file in the spill is not brought into memory as a whole. */
static uint32_t crc_before(walk *w, uint64_t end)
{
    while (w->crc_end < end) {
        const uint64_t count = end - w->crc_end < REST_BYTES ? end - w->crc_end : REST_BYTES;
        w->crc = (uint32_t)crc32_z(w->crc, w->bytes + w->crc_end, (size_t)count);
        w->crc_end += count;
        if (w->chunks->spill != NULL) {
            t3r_spill_rest(w->chunks->spill);
        }
    }
    return w->crc;
}

/* Whether the CRC of a chunk's records is right. That of records in the file is a part of the data section's. */
static bool is_crc_right(walk *w, const chunk *c, const uint8_t *records, size_t count)
{
    const uint32_t crc = (uint32_t)crc32_z(0, records, count);
    if (records == c->packed) {
        w->crc = (uint32_t)crc32_combine(crc_before(w, (uint64_t)(records - w->bytes)), crc, (z_off_t)count);
        w->crc_end += count;
    }
    return crc == c->record.crc;
}

static int walk_packed(walk *w, const chunk *c, t3r_mcap_place place)
{
    unpacked own = {.bytes = NULL};
    size_t count = c->packed_bytes;
    int status = 0;
    const char *wrong = c->record.compression.count > 0 ? unpack_chunk(w, c, place, &own, &count, &status) : NULL;
    const uint8_t *records = own.bytes != NULL ? own.bytes : c->packed;
    if (status == 0 && wrong == NULL && !c->cut && c->record.crc != 0 && !is_crc_right(w, c, records, count)) {
        wrong = "its CRC does not match its records";
    }
    w->damaged = status == 0 && wrong != NULL && w->cut && !c->cut;
    if (status == 0 && !w->damaged) {
        status = wrong != NULL && !c->cut ? malformed(w, T3R_MCAP_CHUNK, place, wrong)
                                          : walk_chunk(w, records, count, place.offset, c->cut, own.bytes != NULL);
    }
    leave_room(w, &own, own.bytes != NULL && status == T3R_MCAP_KEPT);
    return status < 0 ? -1 : 0;
}

/* Reads a chunk; `in` holds the record, or the part of its `bytes` that a cut file has left. */
static int read_chunk(walk *w, t3r_mcap_fields *in, t3r_mcap_place place, uint64_t bytes)
{
    const bool cut = in->count < bytes;
    chunk c = {.record = t3r_mcap_chunk_of(in), .cut = cut};
    if (in->failed && cut) {
        return 0;
    }
    if (in->failed || c.record.packed_bytes > bytes - in->at) {
        return malformed(w, T3R_MCAP_CHUNK, place, short_fields);
    }
    if (c.record.compression.count == 0 && c.record.unpacked_bytes != c.record.packed_bytes) {
        return malformed(w, T3R_MCAP_CHUNK, place, "uncompressed_size differs from the size of its records");
    }
    const size_t there = in->count - in->at;
    c.packed = in->bytes + in->at;
    c.packed_bytes = c.record.packed_bytes < there ? (size_t)c.record.packed_bytes : there;
    return walk_packed(w, &c, place);
}

/* ---- the file ---- */

static int read_data_end(walk *w, t3r_mcap_fields *in, t3r_mcap_place place)
{
    uint32_t crc = t3r_mcap_take_u32(in);
    if (in->failed) {
        return malformed(w, T3R_MCAP_DATA_END, place, short_fields);
    }
    if (crc != 0 && crc != crc_before(w, place.offset)) {
        return malformed(w, T3R_MCAP_DATA_END, place, "the data section's CRC does not match its bytes");
    }
    w->data_end = place.offset + T3R_MCAP_RECORD_HEAD_BYTES + in->count;
    return 0;
}

static int read_footer(walk *w, t3r_mcap_fields *in, t3r_mcap_place place)
{
    uint64_t summary = t3r_mcap_take_u64(in);
    uint64_t summary_offset = t3r_mcap_take_u64(in);
    uint32_t crc = t3r_mcap_take_u32(in);
    if (in->failed || in->at != in->count) {
        return malformed(w, T3R_MCAP_FOOTER, place, "its length is not 20 bytes");
    }
    if (w->data_end == 0) {
        return malformed(w, T3R_MCAP_FOOTER, place, "no DataEnd record precedes it");
    }
    if ((summary != 0 && (summary < w->data_end || summary > place.offset)) ||
        (summary_offset != 0 && (summary_offset < w->data_end || summary_offset > place.offset))) {
        return malformed(w, T3R_MCAP_FOOTER, place, "it points outside the summary section");
    }
    uint64_t start = summary != 0 ? summary : w->data_end;
    uint64_t stop = place.offset + T3R_MCAP_RECORD_HEAD_BYTES + 16;
    if (crc != 0 && crc != crc32_z(0, w->bytes + start, (size_t)(stop - start))) {
        return malformed(w, T3R_MCAP_FOOTER, place, "the summary's CRC does not match its bytes");
    }
    return 0;
}

static int read_record(walk *w, uint8_t opcode, t3r_mcap_fields *in, t3r_mcap_place place)
{
    bool in_summary = w->data_end != 0;
    switch (opcode) {
    case T3R_MCAP_HEADER:
        if (place.offset != T3R_MCAP_MAGIC_BYTES) {
            return malformed(w, opcode, place, "it is not the first record");
        }
        t3r_mcap_take_text(in); /* profile */
        t3r_mcap_take_text(in); /* library */
        return in->failed ? malformed(w, opcode, place, short_fields) : 0;
    case T3R_MCAP_FOOTER:
        return read_footer(w, in, place);
    case T3R_MCAP_SCHEMA: /* the summary repeats the data section's */
        return in_summary ? 0 : read_schema(w, in, place);
    case T3R_MCAP_CHANNEL:
        return in_summary ? 0 : read_channel(w, in, place);
    case T3R_MCAP_MESSAGE:
    case T3R_MCAP_CHUNK:
    case T3R_MCAP_ATTACHMENT:
    case T3R_MCAP_METADATA:
    case T3R_MCAP_DATA_END:
        if (in_summary) {
            return malformed(w, opcode, place, "it follows the DataEnd record");
        }
        return opcode == T3R_MCAP_MESSAGE      ? read_message(w, in, place)
               : opcode == T3R_MCAP_CHUNK      ? read_chunk(w, in, place, in->count)
               : opcode == T3R_MCAP_ATTACHMENT ? read_attachment(w, in, place)
               : opcode == T3R_MCAP_METADATA   ? read_metadata(w, in, place)
                                               : read_data_end(w, in, place);
    case 0:
        return malformed(w, opcode, place, "0 is no opcode");
    default: /* extensions, and indexes, which sequential reading does not need */
        return 0;
    }
}

/* Checks what follows the footer: the end magic, or its part in a cut file. */
static int check_end(walk *w, uint64_t at, size_t count, t3r_mcap_end *end)
{
    uint64_t rest = count - at;
    if (!w->cut) {
        return rest == T3R_MCAP_MAGIC_BYTES
                   ? 0
                   : t3r_reason(w->error, w->error_bytes, "byte %" PRIu64 ": bytes between Footer and end magic", at);
    }
    if (rest >= T3R_MCAP_MAGIC_BYTES || memcmp(w->bytes + at, T3R_MCAP_MAGIC, (size_t)rest) != 0) {
        return t3r_reason(w->error, w->error_bytes, "byte %" PRIu64 ": no end magic after the Footer", at);
    }
    *end = (t3r_mcap_end){true, at};
    return 0;
}

int t3r_mcap_read(const uint8_t *bytes, size_t count, const t3r_mcap_visitor *visitor, t3r_mcap_chunks *chunks,
                  t3r_mcap_end *end, char *error, size_t error_bytes)
{
    const char *wrong = t3r_mcap_magic_error(bytes, count);
    if (wrong != NULL) {
        return t3r_reason(error, error_bytes, "%s", wrong);
    }
    bool whole = count >= 2 * T3R_MCAP_MAGIC_BYTES &&
                 memcmp(bytes + count - T3R_MCAP_MAGIC_BYTES, T3R_MCAP_MAGIC, T3R_MCAP_MAGIC_BYTES) == 0;
    walk w = {
        .visitor = visitor,
        .chunks = chunks,
        .bytes = bytes,
        .limit = whole ? count - T3R_MCAP_MAGIC_BYTES : count,
        .cut = !whole,
        .error = error,
        .error_bytes = error_bytes,
    };
    *end = (t3r_mcap_end){false, 0};
    uint64_t at = T3R_MCAP_MAGIC_BYTES, rested = 0;
    while (at < w.limit) {
        if (chunks->spill != NULL && at - rested > REST_BYTES) {
            t3r_spill_rest(chunks->spill);
            rested = at;
        }
        t3r_mcap_place place = {at, false, 0};
        const uint64_t rest = w.limit - at;
        t3r_mcap_head head;
        const bool fits = t3r_mcap_head_of(bytes + at, rest, &head);
        const uint64_t head_bytes = rest < T3R_MCAP_RECORD_HEAD_BYTES ? rest : T3R_MCAP_RECORD_HEAD_BYTES;
        const uint64_t there = fits ? head.bytes : rest - head_bytes;
        t3r_mcap_fields in = {bytes + at + head_bytes, (size_t)there, 0, false};
        /* A file system may leave zeros where a file was cut. */
        if (w.cut && (!fits || head.opcode == 0)) {
            *end = (t3r_mcap_end){true, at};
            return head.opcode == T3R_MCAP_CHUNK && there > 0 && w.data_end == 0
                       ? read_chunk(&w, &in, place, head.bytes)
                       : 0;
        }
        if (!fits) {
            return malformed(&w, head.opcode, place, "it reaches past the file's end");
        }
        if (at == T3R_MCAP_MAGIC_BYTES && head.opcode != T3R_MCAP_HEADER) {
            return malformed(&w, head.opcode, place, "the first record is not a Header");
        }
        if (read_record(&w, head.opcode, &in, place) < 0) {
            return -1;
        }
        if (w.damaged) {
            *end = (t3r_mcap_end){true, at};
            return 0;
        }
        at += T3R_MCAP_RECORD_HEAD_BYTES + head.bytes;
        if (head.opcode == T3R_MCAP_FOOTER) {
            return check_end(&w, at, count, end);
        }
    }
    if (whole) {
        return t3r_reason(error, error_bytes, "byte %" PRIu64 ": no Footer record in front of the end magic", at);
    }
    *end = (t3r_mcap_end){true, at};
    return 0;
}

void t3r_mcap_chunks_free(t3r_mcap_chunks *chunks)
{
    for (size_t i = 0; i < chunks->count; i++) {
        free(chunks->data[i]);
    }
    free(chunks->data);
    *chunks = (t3r_mcap_chunks){0};
}
