/* SPDX-License-Identifier: Apache-2.0 */
/* The outcome of offering a frame to a map as a keyframe: as a JSON object, a row of a table, and in help. */
#ifndef TRIM3R_TOOLS_LIVE_ROW_H
#define TRIM3R_TOOLS_LIVE_ROW_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include <cjson/cJSON.h>

#include "reconstruction/stage_times.h"
#include "trim3r.h"

/* Names the part that a frame lacks, so that it cannot be offered. */
typedef enum live_loss { LIVE_WHOLE, LIVE_UNREADABLE, LIVE_NO_POSE, LIVE_NO_INTRINSICS } live_loss;

typedef struct live_row {
    uint32_t frame; /* number in the source, from 0 */
    int64_t stamp_ns;
    live_loss loss;
    t3r_status status; /* of the runtime; not T3R_OK: it refused the call */
    t3r_stream_report report;
    uint32_t passes, passes_planned; /* of refinement */
    double milliseconds;             /* of the keyframe, without reading and writing */
    double psnr_before;              /* dB of the frame's view of the map before it: live_map.h; NaN = not measured */
    double position[3], rotation[4]; /* of the camera in the world; w x y z */
    stage_times stages;              /* each with its hash; all 0 without hashes */
    uint64_t hash;                   /* of all stages so far; 0 = none that is comparable */
} live_row;

/* Whether the frame became a keyframe. */
static inline bool live_row_is_taken(const live_row *row)
{
    return row->loss == LIVE_WHOLE && row->status == T3R_OK && row->report.refusal == T3R_REFUSAL_NONE;
}

/* Whether a row that was read from a file can be reported. */
static inline bool live_row_is_sound(const live_row *row)
{
    return (uint32_t)row->loss <= LIVE_NO_INTRINSICS && row->report.refusal < T3R_REFUSAL_COUNT;
}

/* Returns "taken", or the reason why the frame is no keyframe, in one or two words or as an error text. */
const char *live_row_decision(const live_row *row);
/* Returns a new object with all fields. */
cJSON *live_row_json(const live_row *row);
/* Prints the headings of the table, and a row, on stdout. */
void live_row_headings(void);
void live_row_print(const live_row *row);
/* Writes key, unit and meaning of the JSON's fields, a line each, for help. Returns the text. */
char *live_row_help(char *text, size_t bytes);

#endif
