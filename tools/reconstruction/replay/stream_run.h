/* SPDX-License-Identifier: Apache-2.0 */
/* A run of replay_stream.h: its frames, rows and counts. Private to this folder. */
#ifndef TRIM3R_TOOLS_STREAM_RUN_H
#define TRIM3R_TOOLS_STREAM_RUN_H

#include "reconstruction/live/live_map.h"
#include "reconstruction/live/live_output.h"
#include "reconstruction/replay/replay_stream.h"
#include "reconstruction/replay/stream_seen.h"

/* How well the map draws a frame: PSNR in dB over the pixels with depth, over those whose surface a keyframe saw, and
 * over all; and the share of those that a keyframe saw in all. NaN: not known. */
typedef struct held_scores {
    double psnr, psnr_seen, psnr_all, seen;
} held_scores;

/* A frame that was no keyframe, drawn from the map after the next keyframe, and at the end. Frames after the last
 * keyframe are drawn only at the end. */
typedef struct held_back {
    uint32_t frame;
    held_scores live, final;
} held_back;

/* Counts and hashes, which a state holds before the rows and the frames held back. */
typedef struct stream_counts {
    uint32_t next; /* the next frame to take */
    uint32_t row_count, held_count;
    uint32_t drawn;       /* frames held back that were drawn after a keyframe, from the first on */
    uint64_t views_hash;  /* of all pictures drawn */
    uint64_t frames_hash; /* of the recording up to `next` */
} stream_counts;

typedef struct stream_run {
    const replay_stream_options *options;
    const t3r_recording *recording;
    const char *path;
    live_map map;
    live_output output;
    drawn_frame view;
    stream_seen seen;
    stream_counts is;
    live_row *rows;  /* room for all frames of the recording */
    held_back *held; /* likewise */
    bool resumed;
    uint32_t resumed_at;
    double rounds_seconds; /* of all rounds */
} stream_run;

/* Writes map and state, as live_output_snapshot(). These return an exit status of cli.h after a message. */
int stream_save(stream_run *s, const live_row *row);
/* Shows the map its keyframes again, in the options' number of rounds. */
int stream_rounds(stream_run *s);
/* Opens the output, and continues from a state if there is one and the options request it. */
int stream_open(stream_run *s);

/* Prints the line before the table, and the report of the whole run with its hash. */
void stream_print_begin(const stream_run *s);
void stream_print(const stream_run *s, uint64_t hash);
void stream_print_json(const stream_run *s, uint64_t hash, const expectation *e, const char *difference);

#endif
