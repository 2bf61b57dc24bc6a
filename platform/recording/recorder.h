/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by the files of the recorder: its state, its channels, and messages inside and outside chunks. */
#ifndef T3R_PLATFORM_RECORDER_H
#define T3R_PLATFORM_RECORDER_H

#include <stdbool.h>
#include <stdint.h>

#include "mcap/mcap_chunk_writer.h"
#include "mcap/mcap_writer.h"
#include "recording.h"

#define T3R_RECORDER_CAMERA_ROOM 48u
#define T3R_RECORDER_WORLD "world" /* frame of the poses */

/* The events come last, so that the ids of the other channels do not depend on them. */
enum {
    T3R_CHANNEL_IMAGE,
    T3R_CHANNEL_DEPTH,
    T3R_CHANNEL_CAMERA_INFO,
    T3R_CHANNEL_POSE,
    T3R_CHANNEL_TF,
    T3R_CHANNEL_EVENTS,
    T3R_CHANNEL_COUNT
};

/* Counts for the statistics. */
typedef struct t3r_recorder_counts {
    uint64_t first_ns, last_ns;
    uint32_t messages[T3R_CHANNEL_COUNT]; /* also the next sequence numbers */
} t3r_recorder_counts;

struct t3r_recorder {
    t3r_mcap_writer out;
    t3r_recorder_counts counts;
    uint32_t metadata_count;
    uint64_t metadata_at[3]; /* start of each metadata record, and end of the last one */
    uint64_t data_at;        /* start of the first message or chunk */
    uint32_t chunks;
    uint32_t channel_count;
    bool unchunked;
    const t3r_chunk_packer *packer; /* NULL: chunks are not compressed */
    t3r_mcap_chunk *measured;       /* the chunk being measured, else NULL */
    bool packing;                   /* output goes to the packer */
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

/* ---- recorder_chunk.c: the messages of one instant ---- */

void t3r_recorder_begin_message(t3r_recorder *recorder, uint32_t channel, int64_t stamp_ns, uint64_t data_bytes);
/* Marks everything written so far as complete. */
void t3r_recorder_end_message(t3r_recorder *recorder);
/* Writes the messages of put(), as one chunk, or plain without chunks. put() is called more than once, to measure
 * before it writes, and must write the same each time. */
void t3r_recorder_put(t3r_recorder *recorder, void (*put)(t3r_recorder *recorder, const void *item), const void *item);

/* ---- recorder_messages.c ---- */

/* Puts all messages of a t3r_recorded_frame, the image last; or a t3r_ros_log. */
void t3r_recorder_put_frame(t3r_recorder *recorder, const void *frame);
void t3r_recorder_put_log(t3r_recorder *recorder, const void *log);

/* ---- recorder_summary.c: before and after the messages ---- */

void t3r_recorder_put_head(t3r_recorder *recorder, const t3r_recording_header *header, const char *depth_unit);
void t3r_recorder_put_summary(t3r_recorder *recorder);

#endif
