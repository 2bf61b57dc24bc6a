/* SPDX-License-Identifier: Apache-2.0 */
/* Reads MCAP records into streams of indexed messages and metadata. */
#include "recording.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "host/file_bytes.h"
#include "host/fixed_text.h"
#include "host/grow.h"
#include "host/reason.h"
#include "mcap/reader_limits.h"
#include "messages/pixel_layout.h"
#include "recording_folder.h"
#include "recording_index.h"

#define IDS 65536u                                  /* schema and channel ids have 16 bits */
#define SLOTS (2u * IDS)                            /* at least half stay free */
#define DEFAULT_DEPTH_UNIT_Q40 UINT64_C(1099511628) /* a millimetre in metres (REP 118) */
#define MAX_DEPTH_UNIT_Q40 ((uint64_t)T3R_LIMIT_DEPTH_UNIT << 40)
#define MAX_LOG_NS ((uint64_t)1 << 62)
#define FIRST_BYTES 8                  /* bytes that identify a recording */
#define PIECE_BYTES ((size_t)16 << 20) /* bytes of a large file read at once */
#define DEFAULT_PAIR_NS 20000000       /* largest distance between messages of one instant with different stamps */

/* State of one pass over the records. */
typedef struct indexing {
    t3r_recording *recording;
    t3r_mcap_schema_record *schemas;
    size_t schema_count, schema_capacity;
    uint32_t *schema_of, *stream_of; /* by id: index + 1, 0 = none */
    uint32_t *slots;                 /* hash table of the streams by topic: index + 1, 0 = free */
    bool strict;
    char *error;
    size_t error_bytes;
} indexing;

static int fail(indexing *x, const char *record, t3r_mcap_place place, const char *what)
{
    char text[T3R_MCAP_PLACE_BYTES];
    return t3r_reason(x->error, x->error_bytes, "%s at %s: %s", record, t3r_mcap_place_text(place, text), what);
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
static void leave_out(t3r_stream *stream, uint32_t count, t3r_mcap_place place, const char *wrong)
{
    char text[T3R_MCAP_PLACE_BYTES];
    if (stream->left_out == 0) {
        t3r_reason(stream->fault, sizeof stream->fault, "at %s: %s", t3r_mcap_place_text(place, text), wrong);
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
        leave_out(stream, wrong != NULL ? 1 : found.bad_transforms, place, first);
    }
    if (!found.usable) {
        return 0;
    }
    const t3r_indexed_message kept = {.data = message->data,
                                      .bytes = message->bytes,
                                      .stamp_ns = found.stamp_ns != 0 ? found.stamp_ns : log_ns,
                                      .log_ns = log_ns,
                                      .order = stream->kept,
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

static void remark_cut(t3r_recording *recording, const t3r_mcap_end *end)
{
    t3r_recording_remark(recording, "cut off at byte %" PRIu64 ", after %" PRIu64 " of its messages", end->cut_offset,
                         t3r_recording_cut_of(recording).messages);
}

static int index_bytes(t3r_recording *recording, const uint8_t *bytes, size_t count, const t3r_recording_choice *choice,
                       char *error, size_t error_bytes)
{
    indexing x = {.recording = recording, .error = error, .error_bytes = error_bytes};
    x.schema_of = calloc(IDS, sizeof *x.schema_of);
    x.stream_of = calloc(IDS, sizeof *x.stream_of);
    x.slots = calloc(SLOTS, sizeof *x.slots);
    x.strict = choice->strict;
    const t3r_mcap_visitor visitor = {&x, on_schema, on_channel, on_message, on_metadata};
    t3r_mcap_end end;
    int status = x.schema_of == NULL || x.stream_of == NULL || x.slots == NULL
                     ? t3r_reason(error, error_bytes, "out of memory")
                     : t3r_mcap_read(bytes, count, &visitor, &recording->chunks, &end, error, error_bytes);
    free(x.schemas);
    free(x.schema_of);
    free(x.stream_of);
    free(x.slots);
    recording->file_bytes = count;
    recording->cut = status == 0 ? end : (t3r_mcap_end){0};
    if (status == 0 && end.cut) {
        remark_cut(recording, &end);
    }
    if (status == 0) {
        remark_left_out(recording);
    }
    if (status == 0 && choice->depth_unit_q40 != 0 && recording->states_unit) {
        status = t3r_reason(error, error_bytes, "the recording states its own depth unit");
    }
    recording->pair_ns = choice->pair_ns > 0 ? choice->pair_ns : DEFAULT_PAIR_NS;
    if (status == 0) {
        status = t3r_recording_choose(recording, choice, error, error_bytes);
    }
    if (status == 0) {
        status = t3r_recording_pair(recording, error, error_bytes);
    }
    if (status == 0) {
        check_triplets(recording);
    }
    return status;
}

/* Parses a recording. The recording takes over `spill`, which is empty afterwards; NULL: everything stays in memory. */
static t3r_recording *parse(const uint8_t *bytes, size_t count, t3r_spill *spill, const t3r_recording_choice *choice,
                            char *error, size_t error_bytes)
{
    t3r_recording *recording = calloc(1, sizeof *recording);
    if (recording == NULL) {
        t3r_reason(error, error_bytes, "out of memory");
        return NULL;
    }
    recording->colour = recording->depth = recording->pose = T3R_NO_STREAM;
    recording->camera_info = recording->depth_camera_info = recording->transforms = T3R_NO_STREAM;
    recording->depth_unit_q40 = choice->depth_unit_q40 != 0 ? choice->depth_unit_q40 : DEFAULT_DEPTH_UNIT_Q40;
    memcpy(recording->clock, "unknown", sizeof "unknown");
    if (spill != NULL) {
        recording->spill = *spill;
        recording->chunks.spill = &recording->spill;
        *spill = (t3r_spill){0};
    }
    if (index_bytes(recording, bytes, count, choice, error, error_bytes) != 0) {
        t3r_recording_close(recording);
        return NULL;
    }
    return recording;
}

t3r_recording *t3r_recording_parse(const uint8_t *bytes, size_t count, char *error, size_t error_bytes)
{
    return parse(bytes, count, NULL, &(t3r_recording_choice){0}, error, error_bytes);
}

/* Reads a large file into the spill, if its first bytes are a recording's. Returns NULL with the reason on failure. */
static uint8_t *spill_file(FILE *file, size_t count, t3r_spill *spill, size_t *got, const char **why)
{
    uint8_t first[FIRST_BYTES];
    *why = t3r_mcap_magic_error(first, fread(first, 1, sizeof first, file));
    uint8_t *bytes = *why == NULL ? t3r_spill_take(spill, count) : NULL;
    if (bytes == NULL) {
        *why = *why != NULL ? *why : "there is no room on the disk for a copy (TMPDIR names another)";
        return NULL;
    }
    memcpy(bytes, first, sizeof first); /* the file is larger */
    *got = sizeof first;
    for (size_t some = 1; some > 0 && *got < count;) {
        some = fread(bytes + *got, 1, count - *got < PIECE_BYTES ? count - *got : PIECE_BYTES, file);
        *got += some;
        t3r_spill_rest(spill);
    }
    *why = ferror(file) ? "it cannot be read to its end" : NULL;
    return *why == NULL ? bytes : NULL;
}

/* Reads a file: into the spill if it is too large for memory, else into *heap. Returns NULL with the reason in error[]
 * on failure. */
static const uint8_t *read_file(const char *path, uint8_t **heap, t3r_spill *spill, size_t *count, char *error,
                                size_t error_bytes)
{
    struct stat about;
    *heap = NULL;
    if (stat(path, &about) != 0 || !S_ISREG(about.st_mode) || about.st_size < 0 ||
        (uint64_t)about.st_size <= T3R_LIMIT_UNPACKED_HEAP || (uint64_t)about.st_size > SIZE_MAX / 2) {
        *heap = t3r_file_bytes_checked(path, SIZE_MAX, t3r_mcap_magic_error, count, error, error_bytes);
        return *heap;
    }
    FILE *file = t3r_file_open(path, error, error_bytes);
    if (file == NULL) {
        return NULL;
    }
    const char *why;
    const uint8_t *bytes = spill_file(file, (size_t)about.st_size, spill, count, &why);
    if (bytes == NULL) {
        (void)t3r_reason(error, error_bytes, "%s: %s", path, why);
    }
    fclose(file);
    return bytes;
}

static t3r_recording *open_file(const char *path, const t3r_recording_choice *choice, char *error, size_t error_bytes)
{
    size_t count;
    uint8_t *heap;
    t3r_spill spill = {0};
    char what[256];
    const uint8_t *bytes = read_file(path, &heap, &spill, &count, error, error_bytes);
    t3r_recording *recording = bytes == NULL ? NULL : parse(bytes, count, &spill, choice, what, sizeof what);
    if (recording == NULL) {
        if (bytes != NULL) {
            t3r_reason(error, error_bytes, "%s: %s", path, what);
        }
        free(heap);
        t3r_spill_free(&spill);
        return NULL;
    }
    recording->file = heap;
    return recording;
}

t3r_recording *t3r_recording_open_chosen(const char *path, const t3r_recording_choice *choice, char *error,
                                         size_t error_bytes)
{
    if (!t3r_recording_is_folder(path)) {
        return open_file(path, choice, error, error_bytes);
    }
    char *file = t3r_recording_folder_file(path, error, error_bytes);
    t3r_recording *recording = file == NULL ? NULL : open_file(file, choice, error, error_bytes);
    free(file);
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
    free(recording->file);
    free(recording);
}
