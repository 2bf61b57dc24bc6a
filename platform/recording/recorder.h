/* What the files of the recorder share: its state, its channels, and messages inside and outside of chunks. */
#ifndef T3R_PLATFORM_RECORDER_H
#define T3R_PLATFORM_RECORDER_H

#include <stdbool.h>
#include <stdint.h>

#include "mcap/mcap_chunk_writer.h"
#include "mcap/mcap_writer.h"
#include "recording.h"

#define T3R_RECORDER_CAMERA_ROOM 48u
#define T3R_RECORDER_WORLD "world" /* the frame of the poses */

/* The events come last: without them the other channels are as they are with them. */
enum {
    T3R_CHANNEL_IMAGE,
    T3R_CHANNEL_DEPTH,
    T3R_CHANNEL_CAMERA_INFO,
    T3R_CHANNEL_POSE,
    T3R_CHANNEL_TF,
    T3R_CHANNEL_EVENTS,
    T3R_CHANNEL_COUNT
};

/* What the statistics count. */
typedef struct t3r_recorder_counts {
    uint64_t first_ns, last_ns;
    uint32_t messages[T3R_CHANNEL_COUNT]; /* also the next sequence number */
} t3r_recorder_counts;

struct t3r_recorder {
    t3r_mcap_writer out;
    t3r_recorder_counts counts;
    uint32_t metadata_count;
    uint64_t metadata_at[3]; /* where each metadata record starts, and the last one ends */
    uint64_t data_at;        /* where the first message or chunk starts */
    uint32_t chunks;
    uint32_t channel_count;
    bool unchunked;
    const t3r_chunk_packer *packer; /* NULL: chunks are not compressed */
    t3r_mcap_chunk *measured;       /* the chunk whose messages are being measured, else NULL */
    bool packing;                   /* what is put goes to the packer */
    int (*message_end)(void *user);
    char camera[T3R_RECORDER_CAMERA_ROOM];
};

static inline int t3r_recorder_status(const t3r_recorder *recorder)
{
    return recorder->out.failed ? -1 : 0;
}

static inline bool t3r_recorder_has_events(const t3r_recorder *recorder)
{
    return recorder->channel_count > T3R_CHANNEL_EVENTS;
}

/* ---- recorder_chunk.c: messages of one instant ---- */

void t3r_recorder_begin_message(t3r_recorder *recorder, uint32_t channel, int64_t stamp_ns, uint64_t data_bytes);
/* What is written so far is whole. */
void t3r_recorder_end_message(t3r_recorder *recorder);
/* The messages that put() writes, as a chunk of their own, or plain where there are no chunks. put() is called more
 * than once, to measure before it writes, and writes the same each time. */
void t3r_recorder_put(t3r_recorder *recorder, void (*put)(t3r_recorder *recorder, const void *item), const void *item);

/* ---- recorder_messages.c ---- */

/* All messages of a t3r_recorded_frame, the image last; a t3r_ros_log. */
void t3r_recorder_put_frame(t3r_recorder *recorder, const void *frame);
void t3r_recorder_put_log(t3r_recorder *recorder, const void *log);

/* ---- recorder_summary.c: what stands before the messages, and behind them ---- */

void t3r_recorder_put_head(t3r_recorder *recorder, const t3r_recording_header *header, const char *depth_unit);
void t3r_recorder_put_summary(t3r_recorder *recorder);

#endif
