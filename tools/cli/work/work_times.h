/* Where the time of a command went, each kind of work apart. */
#ifndef TRIM3R_TOOLS_WORK_TIMES_H
#define TRIM3R_TOOLS_WORK_TIMES_H

#include <stddef.h>

#include <cjson/cJSON.h>

typedef enum work_kind {
    WORK_READ,  /* files: read, unpacked, decoded */
    WORK_POSES, /* estimated */
    WORK_BUILD, /* frames to scene */
    WORK_DRAW,
    WORK_WRITE, /* files: encoded, written */
    WORK_KINDS
} work_kind;

typedef struct work_times {
    double seconds[WORK_KINDS];
    double since; /* cli_now() when the work at hand began */
} work_times;

void work_times_begin(work_times *times);
/* What was done since the last call, or since the begin, was of that kind. */
void work_times_end(work_times *times, work_kind kind);
/* It was of none. */
void work_times_pass(work_times *times);

/* "read_ms", "pose_ms", "build_ms", "render_ms", "write_ms" of those kinds that took any time. */
void work_times_add_json(cJSON *object, const work_times *times);
/* "read 1.2 ms, build 3.4 ms, write 5.6 ms". Returns `text`. */
#define WORK_TIMES_BYTES 128
const char *work_times_text(const work_times *times, char text[WORK_TIMES_BYTES]);

#endif
