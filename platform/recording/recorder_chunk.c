#include "mcap/reader_limits.h"
#include "recorder.h"

/* Writes the messages of a chunk; every call starts from the same counts and writes the same bytes. */
typedef void (*put_messages)(t3r_recorder *recorder, const void *item);

void t3r_recorder_begin_message(t3r_recorder *recorder, uint32_t channel, int64_t stamp_ns, uint64_t data_bytes)
{
    t3r_recorder_counts *counts = &recorder->counts;
    bool first = true;
    for (uint32_t i = 0; i < T3R_CHANNEL_COUNT; i++) {
        first = first && counts->messages[i] == 0;
    }
    uint64_t time = (uint64_t)stamp_ns;
    counts->first_ns = first || time < counts->first_ns ? time : counts->first_ns;
    counts->last_ns = first || time > counts->last_ns ? time : counts->last_ns;
    if (recorder->measured != NULL) {
        t3r_mcap_chunk_note(recorder->measured, (uint16_t)channel, time, recorder->out.offset);
    }
    t3r_mcap_message(&recorder->out, (uint16_t)channel, counts->messages[channel]++, time, data_bytes);
}

void t3r_recorder_end_message(t3r_recorder *recorder)
{
    bool on_its_way = recorder->measured == NULL && !recorder->packing;
    if (on_its_way && !recorder->out.failed && recorder->message_end != NULL) {
        recorder->out.failed = recorder->message_end(recorder->out.sink.user) != 0;
    }
}

/* Runs put() into another sink (write NULL: nowhere). Returns the writer's state afterwards. */
static t3r_mcap_writer divert(t3r_recorder *recorder, t3r_sink sink, put_messages put, const void *item)
{
    const t3r_mcap_writer out = recorder->out;
    recorder->out = (t3r_mcap_writer){.sink = sink};
    put(recorder, item);
    const t3r_mcap_writer diverted = recorder->out;
    recorder->out = out;
    return diverted;
}

/* Compresses the records into the packer's memory. Returns false if they are to be stored uncompressed: without a
 * packer, if compression gains nothing, or if the ratio is higher than a reader accepts from a small file. */
static bool pack(t3r_recorder *recorder, put_messages put, const void *item, uint64_t bytes, const uint8_t **packed,
                 size_t *packed_bytes)
{
    const t3r_chunk_packer *packer = recorder->packer;
    if (packer == NULL) {
        return false;
    }
    recorder->packing = true;
    bool failed = packer->begin(packer->user) != 0 ||
                  divert(recorder, (t3r_sink){.write = packer->write, .user = packer->user}, put, item).failed ||
                  packer->end(packer->user, packed, packed_bytes) != 0;
    recorder->packing = false;
    recorder->out.failed = recorder->out.failed || failed;
    return !failed && *packed_bytes < bytes && bytes / T3R_LIMIT_UNPACKED_RATIO < *packed_bytes;
}

static void put_chunk(t3r_recorder *recorder, put_messages put, const void *item)
{
    const t3r_recorder_counts before = recorder->counts;
    t3r_mcap_chunk chunk = {0};
    recorder->measured = &chunk;
    const t3r_mcap_writer measured = divert(recorder, (t3r_sink){.write = NULL}, put, item);
    recorder->measured = NULL;
    chunk.bytes = measured.offset;
    chunk.crc = measured.crc;
    const uint8_t *packed = NULL;
    size_t packed_bytes = 0;
    recorder->counts = before;
    if (pack(recorder, put, item, chunk.bytes, &packed, &packed_bytes)) {
        t3r_mcap_chunk_open(&recorder->out, &chunk, recorder->packer->name, packed_bytes);
        t3r_mcap_put_raw(&recorder->out, packed, packed_bytes);
    } else {
        recorder->counts = before;
        t3r_mcap_chunk_open(&recorder->out, &chunk, "", chunk.bytes);
        put(recorder, item);
    }
    t3r_mcap_message_indexes(&recorder->out, &chunk);
    recorder->chunks++;
    t3r_recorder_end_message(recorder);
}

void t3r_recorder_put(t3r_recorder *recorder, put_messages put, const void *item)
{
    if (recorder->unchunked) {
        put(recorder, item);
    } else {
        put_chunk(recorder, put, item);
    }
}
