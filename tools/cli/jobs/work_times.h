/* SPDX-License-Identifier: Apache-2.0 */
/* Times of a command by kind of work. */
#ifndef TRIM3R_TOOLS_WORK_TIMES_H
#define TRIM3R_TOOLS_WORK_TIMES_H

#include <stddef.h>

#include <cjson/cJSON.h>

typedef enum work_kind {
    WORK_READ,  /* files: read, decompressed, decoded */
    WORK_POSES, /* estimated */
    WORK_BUILD, /* frames to scene */
    WORK_DRAW,
    WORK_WRITE, /* files: encoded, written */
    WORK_KINDS
} work_kind;

typedef struct work_times {
    double seconds[WORK_KINDS];
    double since; /* cli_now() at the start of the current work */
} work_times;

void work_times_begin(work_times *times);
/* Counts the time since the last call, or since the beginning, as that kind of work. */
void work_times_end(work_times *times, work_kind kind);
/* Drops the time since the last call. */
void work_times_pass(work_times *times);

/* Adds "read_ms", "pose_ms", "build_ms", "render_ms", "write_ms" for the kinds that took any time. */
void work_times_add_json(cJSON *object, const work_times *times);
/* Writes "read 1.2 ms, build 3.4 ms, write 5.6 ms". Returns `text`. */
#define WORK_TIMES_BYTES 128
const char *work_times_text(const work_times *times, char text[WORK_TIMES_BYTES]);

#endif
