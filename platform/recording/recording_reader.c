/* SPDX-License-Identifier: Apache-2.0 */
/* Reads MCAP records into streams of indexed messages and metadata. */
#include "recording.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/fixed_text.h"
#include "host/grow.h"
#include "host/reason.h"
#include "mcap/reader_limits.h"
#include "messages/pixel_layout.h"
#include "recording_index.h"

#define IDS 65536u                                  /* schema and channel ids have 16 bits */
#define SLOTS (2u * IDS)                            /* at least half stay free */
#define DEFAULT_DEPTH_UNIT_Q40 UINT64_C(1099511628) /* a millimetre in metres (REP 118) */
#define MAX_DEPTH_UNIT_Q40 ((uint64_t)T3R_LIMIT_DEPTH_UNIT << 40)
#define MAX_LOG_NS ((uint64_t)1 << 62)
#define DEFAULT_PAIR_NS 20000000 /* largest distance between messages of one instant with different stamps */

/* State of one pass over the records of all files. */
typedef struct indexing {
    t3r_recording *recording;
    uint32_t file;
    t3r_mcap_schema_record *schemas; /* of this file */
    size_t schema_count, schema_capacity;
    uint32_t *schema_of, *stream_of; /* of this file, by id: index + 1, 0 = none */
    uint32_t *slots;                 /* hash table of the streams by topic: index + 1, 0 = free */
    bool strict;
    char error[256];
} indexing;

static int fail(indexing *x, const char *record, t3r_mcap_place place, const char *what)
{
    char text[T3R_MCAP_PLACE_BYTES];
    return t3r_reason(x->error, sizeof x->error, "%s at %s: %s", record, t3r_mcap_place_text(place, text), what);
}

static char *printable(t3r_text text)
{
    char *copy = malloc(text.count + 1);
    if (copy != NULL) {
        t3r_text_copy(copy, text.count + 1, text);
    }
    return copy;
}

/* ---- schemas and channels ---- */

static int on_schema(void *user, const t3r_mcap_schema_record *schema, t3r_mcap_place place)
{
    indexing *x = user;
    if (x->schema_of[schema->id] != 0) {
        const t3r_mcap_schema_record *old = &x->schemas[x->schema_of[schema->id] - 1];
        bool same = t3r_text_same(old->name, schema->name) && t3r_text_same(old->encoding, schema->encoding) &&
                    t3r_text_same(old->definition, schema->definition);
        return same ? 0 : fail(x, "schema", place, "its id is taken by another schema");
    }
    t3r_mcap_schema_record *grown = t3r_grow(x->schemas, x->schema_count, &x->schema_capacity, sizeof *grown);
    if (grown == NULL) {
        return fail(x, "schema", place, "out of memory");
    }
    x->schemas = grown;
    x->schemas[x->schema_count++] = *schema;
    x->schema_of[schema->id] = (uint32_t)x->schema_count;
    return T3R_MCAP_KEPT;
}

static t3r_ros_type type_of(t3r_text name)
{
    uint32_t type = 0;
    while (type < T3R_ROS_TYPE_COUNT && !t3r_ros_is_named((t3r_ros_type)type, name)) {
        type++;
    }
    return (t3r_ros_type)type;
}

/* Returns the slot of the stream with that topic and schema, or the free one for it (FNV-1a). */
static uint32_t *slot_of(indexing *x, t3r_text topic, t3r_text schema)
{
    uint32_t hash = 2166136261u;
    for (size_t i = 0; i < topic.count; i++) {
        hash = (hash ^ (uint8_t)topic.chars[i]) * 16777619u;
    }
    uint32_t at = hash % SLOTS;
    for (; x->slots[at] != 0; at = (at + 1) % SLOTS) {
        const t3r_stream *stream = &x->recording->streams[x->slots[at] - 1];
        if (t3r_text_same(stream->name, topic) && t3r_text_same(stream->schema_name, schema)) {
            break;
        }
    }
    return &x->slots[at];
}

/* Says why messages in an encoding other than CDR are not read. */
static void say_encoding(t3r_stream *stream, t3r_text encoding)
{
    char name[32];
    t3r_text_copy(name, sizeof name, encoding);
    if (t3r_text_is(encoding, "ros1")) {
        t3r_reason(stream->unused, sizeof stream->unused, "its messages are of ROS 1: " T3R_MCAP_FROM_ROS1);
    } else if (!t3r_text_is(encoding, "cdr")) {
        t3r_reason(stream->unused, sizeof stream->unused, "its messages are in '%s', not in the CDR of ROS 2", name);
    }
}

static int on_channel(void *user, const t3r_mcap_channel_record *channel, t3r_mcap_place place)
{
    indexing *x = user;
    t3r_recording *recording = x->recording;
    t3r_text schema = {"", 0};
    if (channel->schema != 0) {
        if (x->schema_of[channel->schema] == 0) {
            return fail(x, "channel", place, "its schema was not defined before it");
        }
        schema = x->schemas[x->schema_of[channel->schema] - 1].name;
    }
    if (x->stream_of[channel->id] != 0) {
        const t3r_stream *old = &recording->streams[x->stream_of[channel->id] - 1];
        bool same = t3r_text_same(old->schema_name, schema) && t3r_text_same(old->name, channel->topic);
        return same ? 0 : fail(x, "channel", place, "its id is taken by another channel");
    }
    uint32_t *slot = slot_of(x, channel->topic, schema);
    if (*slot != 0) {
        x->stream_of[channel->id] = *slot; /* each publisher of a topic has a channel of its own */
        return 0;
    }
    t3r_stream *grown =
        t3r_grow(recording->streams, recording->stream_count, &recording->stream_capacity, sizeof *grown);
    if (grown == NULL) {
        return fail(x, "channel", place, "out of memory");
    }
    recording->streams = grown;
    t3r_stream *stream = &recording->streams[recording->stream_count++];
    *stream = (t3r_stream){
        .name = channel->topic,
        .topic = printable(channel->topic),
        .schema = printable(schema),
        .schema_name = schema,
        .type = t3r_text_is(channel->encoding, "cdr") ? type_of(schema) : T3R_ROS_TYPE_COUNT,
    };
    x->stream_of[channel->id] = *slot = (uint32_t)recording->stream_count;
    if (stream->topic == NULL || stream->schema == NULL) {
        return fail(x, "channel", place, "out of memory");
    }
    stream->rectified = t3r_topic_is_rectified(stream->topic);
    say_encoding(stream, channel->encoding);
    return T3R_MCAP_KEPT;
}

/* ---- messages ---- */

/* Counts messages, or transforms, that are left out; the first is named. */
static void leave_out(const indexing *x, t3r_stream *stream, uint32_t count, t3r_mcap_place place, const char *wrong)
{
    char text[T3R_RECORDING_PLACE_BYTES];
    if (stream->left_out == 0) {
        t3r_reason(stream->fault, sizeof stream->fault, "at %s: %s",
                   t3r_recording_place_text(x->recording, x->file, place, text), wrong);
    }
    stream->left_out += count;
}

static bool keep(t3r_stream *stream, const t3r_indexed_message *message)
{
    t3r_indexed_message *grown =
        stream->kept == UINT32_MAX ? NULL : t3r_grow(stream->messages, stream->kept, &stream->capacity, sizeof *grown);
    if (grown == NULL) {
        return false;
    }
    stream->messages = grown;
    stream->messages[stream->kept++] = *message;
    return true;
}

/* Inspects a message of a type that is read. Returns 0, T3R_MCAP_KEPT or -1. */
static int inspect(indexing *x, t3r_stream *stream, const t3r_mcap_message_record *message, int64_t log_ns,
                   t3r_mcap_place place)
{
    t3r_inspection found;
    const char *wrong = t3r_recording_inspect(x->recording, stream, message->data, message->bytes, &found);
    const char *first = wrong != NULL ? wrong : found.transform_error;
    if (first != NULL && x->strict) {
        char what[256];
        t3r_reason(what, sizeof what, "%s (%.64s)", first, stream->topic);
        return fail(x, "message", place, what);
    }
    if (first != NULL) {
        leave_out(x, stream, wrong != NULL ? 1 : found.bad_transforms, place, first);
    }
    if (!found.usable) {
        return 0;
    }
    const t3r_indexed_message kept = {.data = message->data,
                                      .bytes = message->bytes,
                                      .stamp_ns = found.stamp_ns != 0 ? found.stamp_ns : log_ns,
                                      .log_ns = log_ns,
                                      .order = (uint32_t)stream->kept,
                                      .file = x->file,
                                      .place = place};
    return keep(stream, &kept) ? T3R_MCAP_KEPT : fail(x, "message", place, "out of memory");
}

static int on_message(void *user, const t3r_mcap_message_record *message, t3r_mcap_place place)
{
    indexing *x = user;
    if (x->stream_of[message->channel] == 0) {
        return fail(x, "message", place, "its channel was not defined before it");
    }
    t3r_stream *stream = &x->recording->streams[x->stream_of[message->channel] - 1];
    int64_t log_ns = (int64_t)(message->log_ns < MAX_LOG_NS ? message->log_ns : MAX_LOG_NS);
    int kept = stream->type == T3R_ROS_TYPE_COUNT ? 0 : inspect(x, stream, message, log_ns, place);
    stream->first_ns = stream->count == 0 || log_ns < stream->first_ns ? log_ns : stream->first_ns;
    stream->last_ns = stream->count == 0 || log_ns > stream->last_ns ? log_ns : stream->last_ns;
    stream->count++;
    return kept;
}

static void remark_left_out(t3r_recording *recording)
{
    for (size_t i = 0; i < recording->stream_count; i++) {
        const t3r_stream *stream = &recording->streams[i];
        if (stream->left_out > 0) {
            t3r_recording_remark(recording, "%s: %" PRIu64 " of its %s are left out, the first %s", stream->topic,
                                 stream->left_out, stream->role == T3R_STREAM_TF ? "transforms" : "messages",
                                 stream->fault);
        }
    }
}

/* ---- metadata ---- */

/* Reads a decimal number at text[*at]; false if there is none or it exceeds 32 bits. */
static bool number(t3r_text text, size_t *at, uint32_t *value)
{
    uint64_t x = 0;
    size_t start = *at;
    for (; *at < text.count && text.chars[*at] >= '0' && text.chars[*at] <= '9'; (*at)++) {
        x = x * 10 + (uint64_t)(text.chars[*at] - '0');
        if (x > UINT32_MAX) {
            return false;
        }
    }
    *value = (uint32_t)x;
    return *at > start;
}

/* Parses "0,2,1;3,5,4": context a, context b, target. Returns NULL, or what is wrong. */
static const char *parse_triplets(t3r_text text, t3r_recording *recording)
{
    size_t room = 1;
    for (size_t i = 0; i < text.count; i++) {
        room += text.chars[i] == ';';
    }
    if (text.count == 0) {
        return NULL;
    }
    if (room > T3R_LIMIT_TRIPLETS) {
        return T3R_LIMIT_TEXT("more than ", T3R_LIMIT_TRIPLETS, " triplets");
    }
    t3r_triplet *triplets = calloc(room, sizeof *triplets);
    if (triplets == NULL) {
        return "out of memory";
    }
    free(recording->triplets);
    recording->triplets = triplets;
    recording->triplet_count = 0;
    size_t at = 0;
    for (size_t i = 0; i < room; i++) {
        uint32_t members[3];
        for (uint32_t j = 0; j < 3; j++) {
            char behind = j < 2 ? ',' : ';';
            bool last = i + 1 == room && j == 2;
            if (!number(text, &at, &members[j]) ||
                (last ? at != text.count : at >= text.count || text.chars[at] != behind)) {
                return "triplets is not 'a,b,target;a,b,target...'";
            }
            at += !last;
        }
        triplets[recording->triplet_count++] = (t3r_triplet){{members[0], members[1]}, members[2]};
    }
    return NULL;
}

static int on_metadata(void *user, t3r_text name, t3r_text key, t3r_text value, t3r_mcap_place place)
{
    indexing *x = user;
    t3r_recording *recording = x->recording;
    const char *wrong = NULL;
    if (t3r_text_is(name, "trim3r_triplets") && t3r_text_is(key, "triplets")) {
        wrong = parse_triplets(value, recording);
    } else if (t3r_text_is(name, "trim3r") && t3r_text_is(key, "bits_epoch")) {
        size_t at = 0;
        bool good = number(value, &at, &recording->bits_epoch) && at == value.count && recording->bits_epoch > 0;
        wrong = good ? NULL : "bits_epoch is not a number above 0";
    } else if (t3r_text_is(name, "trim3r") && t3r_text_is(key, "depth_unit")) {
        bool good = t3r_q40_from_text(value, &recording->depth_unit_q40) == 0 && recording->depth_unit_q40 > 0 &&
                    recording->depth_unit_q40 < MAX_DEPTH_UNIT_Q40;
        recording->states_unit = true;
        wrong = good ? NULL : "depth_unit is not a decimal number such as 0.001, above 0 and below 128";
    } else if (t3r_text_is(name, "trim3r") && t3r_text_is(key, "clock")) {
        t3r_text_copy(recording->clock, sizeof recording->clock, value);
    }
    return wrong == NULL ? 0 : fail(x, "metadata", place, wrong);
}

/* Drops the triplets that name frames outside the recording. */
static void check_triplets(t3r_recording *recording)
{
    uint32_t kept = 0, frames = recording->pairing.frames;
    for (uint32_t i = 0; i < recording->triplet_count; i++) {
        t3r_triplet t = recording->triplets[i];
        if (t.context[0] < frames && t.context[1] < frames && t.target < frames) {
            recording->triplets[kept++] = t;
        }
    }
    if (kept < recording->triplet_count) {
        t3r_recording_remark(recording, "%" PRIu32 " of its %" PRIu32 " triplets name frames that it does not hold",
                             recording->triplet_count - kept, recording->triplet_count);
    }
    recording->triplet_count = kept;
}

/* ---- opening ---- */

static uint64_t messages_of(const t3r_recording *recording)
{
    uint64_t messages = 0;
    for (size_t i = 0; i < recording->stream_count; i++) {
        messages += recording->streams[i].count;
    }
    return messages;
}

static void remark_cut(t3r_recording *recording, const t3r_recording_cut *cut)
{
    recording->cut = recording->cut.cut ? recording->cut : *cut;
    t3r_recording_remark(recording, "%s%scut off at byte %" PRIu64 ", after %" PRIu64 " of its messages", cut->file,
                         cut->file[0] != '\0' ? ": " : "", cut->offset, cut->messages);
}

/* Indexes a file; `stored` bytes on the disk hold its `count` bytes. */
static int index_file(indexing *x, const uint8_t *bytes, size_t count, size_t stored)
{
    t3r_recording *recording = x->recording;
    const t3r_mcap_visitor visitor = {x, on_schema, on_channel, on_message, on_metadata};
    const uint64_t before = messages_of(recording);
    t3r_mcap_end end;
    memset(x->schema_of, 0, IDS * sizeof *x->schema_of);
    memset(x->stream_of, 0, IDS * sizeof *x->stream_of);
    x->schema_count = 0;
    recording->chunks.packed_bytes += stored;
    if (t3r_mcap_read(bytes, count, &visitor, &recording->chunks, &end, x->error, sizeof x->error) != 0) {
        return -1;
    }
    if (end.cut) {
        remark_cut(recording, &(t3r_recording_cut){true, t3r_recording_file_name(recording, x->file), end.cut_offset,
                                                   count, messages_of(recording) - before});
    }
    return 0;
}

/* Reads and indexes the recording's files. */
static int index_files(indexing *x, char *error, size_t error_bytes)
{
    t3r_recording *recording = x->recording;
    for (; x->file < recording->files.count; x->file++) {
        const char *path = recording->files.paths[x->file];
        size_t count, stored;
        const uint8_t *bytes =
            t3r_recording_bytes_read(&recording->bytes, &recording->spill, path, &count, &stored, error, error_bytes);
        if (bytes == NULL) {
            return -1;
        }
        if (index_file(x, bytes, count, stored) != 0) {
            return t3r_reason(error, error_bytes, "%s: %s", path, x->error);
        }
    }
    return 0;
}

/* Indexes the recording's files; the bytes, if it has none. */
static int index_all(t3r_recording *recording, const uint8_t *bytes, size_t count, bool strict, char *error,
                     size_t error_bytes)
{
    indexing x = {.recording = recording, .strict = strict};
    x.schema_of = malloc(IDS * sizeof *x.schema_of);
    x.stream_of = malloc(IDS * sizeof *x.stream_of);
    x.slots = calloc(SLOTS, sizeof *x.slots);
    int status = 0;
    if (x.schema_of == NULL || x.stream_of == NULL || x.slots == NULL) {
        status = t3r_reason(error, error_bytes, "out of memory");
    } else if (recording->files.count > 0) {
        recording->chunks.spill = &recording->spill;
        status = index_files(&x, error, error_bytes);
    } else if (index_file(&x, bytes, count, count) != 0) {
        status = t3r_reason(error, error_bytes, "%s", x.error);
    }
    free(x.schemas);
    free(x.schema_of);
    free(x.stream_of);
    free(x.slots);
    return status;
}

/* Chooses streams and links frames, when all files are indexed. */
static int join(t3r_recording *recording, const t3r_recording_choice *choice, char *error, size_t error_bytes)
{
    remark_left_out(recording);
    if (choice->depth_unit_q40 != 0 && recording->states_unit) {
        return t3r_reason(error, error_bytes, "the recording states its own depth unit");
    }
    recording->pair_ns = choice->pair_ns > 0 ? choice->pair_ns : DEFAULT_PAIR_NS;
    if (t3r_recording_choose(recording, choice, error, error_bytes) != 0 ||
        t3r_recording_pair(recording, error, error_bytes) != 0) {
        return -1;
    }
    check_triplets(recording);
    return 0;
}

static t3r_recording *begin(const t3r_recording_choice *choice, char *error, size_t error_bytes)
{
    t3r_recording *recording = calloc(1, sizeof *recording);
    if (recording == NULL) {
        t3r_reason(error, error_bytes, "out of memory");
        return NULL;
    }
    recording->cut.file = "";
    recording->colour = recording->depth = recording->pose = T3R_NO_STREAM;
    recording->camera_info = recording->depth_camera_info = recording->transforms = T3R_NO_STREAM;
    recording->depth_unit_q40 = choice->depth_unit_q40 != 0 ? choice->depth_unit_q40 : DEFAULT_DEPTH_UNIT_Q40;
    memcpy(recording->clock, "unknown", sizeof "unknown");
    return recording;
}

t3r_recording *t3r_recording_parse(const uint8_t *bytes, size_t count, char *error, size_t error_bytes)
{
    const t3r_recording_choice choice = {0};
    t3r_recording *recording = begin(&choice, error, error_bytes);
    if (recording != NULL && (index_all(recording, bytes, count, false, error, error_bytes) != 0 ||
                              join(recording, &choice, error, error_bytes) != 0)) {
        t3r_recording_close(recording);
        recording = NULL;
    }
    return recording;
}

t3r_recording *t3r_recording_open_chosen(const char *path, const t3r_recording_choice *choice, char *error,
                                         size_t error_bytes)
{
    char what[256];
    t3r_recording *recording = begin(choice, error, error_bytes);
    if (recording == NULL) {
        return NULL;
    }
    int status = t3r_recording_files_of(path, &recording->files, error, error_bytes);
    if (status == 0) {
        status = index_all(recording, NULL, 0, choice->strict, error, error_bytes);
    }
    if (status == 0 && join(recording, choice, what, sizeof what) != 0) {
        status = t3r_reason(error, error_bytes, "%s: %s", path, what);
    }
    if (status != 0) {
        t3r_recording_close(recording);
        recording = NULL;
    }
    return recording;
}

t3r_recording *t3r_recording_open(const char *path, char *error, size_t error_bytes)
{
    return t3r_recording_open_chosen(path, &(t3r_recording_choice){0}, error, error_bytes);
}

void t3r_recording_close(t3r_recording *recording)
{
    if (recording == NULL) {
        return;
    }
    if (recording->depth_z16 != NULL && recording->depth != T3R_NO_STREAM) {
        for (size_t i = 0; i < recording->streams[recording->depth].kept; i++) {
            free(recording->depth_z16[i]);
        }
    }
    for (size_t i = 0; i < recording->stream_count; i++) {
        free(recording->streams[i].topic);
        free(recording->streams[i].schema);
        free(recording->streams[i].messages);
    }
    free(recording->streams);
    free(recording->links);
    free(recording->depth_z16);
    free(recording->depth_beyond);
    free(recording->set_poses);
    free(recording->triplets);
    t3r_mcap_chunks_free(&recording->chunks);
    t3r_spill_free(&recording->spill);
    t3r_recording_bytes_free(&recording->bytes);
    t3r_recording_files_free(&recording->files);
    free(recording);
}
