/* SPDX-License-Identifier: Apache-2.0 */
/* The frames that a stream took and skipped, with the figure that decided. */
#ifndef TRIM3R_TOOLS_FRAME_DECISIONS_H
#define TRIM3R_TOOLS_FRAME_DECISIONS_H

#include <stdbool.h>
#include <stdint.h>

#include <cjson/cJSON.h>

#include "recording/recording.h"
#include "trim3r.h"

typedef struct skipped_frame {
    uint32_t frame;
    const char *reason;       /* a name of t3r_refusal_name(), or a reason of the reader: "no pose" ... */
    char detail[160];         /* the figure, or what cannot be read */
    t3r_stream_report report; /* all 0 for a reason of the reader */
} skipped_frame;

/* Starts as {0}. */
typedef struct frame_decisions {
    skipped_frame *skipped;
    uint32_t count;
} frame_decisions;

/* Allocates for so many frames; returns false if out of memory. */
bool frame_decisions_open(frame_decisions *decisions, uint32_t frames);
void frame_decisions_close(frame_decisions *decisions);

/* Reads frame `index`. Returns false, and notes why, if it cannot be used: unreadable, without pose or intrinsics. */
bool frame_decisions_read(frame_decisions *decisions, const t3r_recording *recording, uint32_t index,
                          t3r_capture_frame *frame);
/* Whether the stream took the frame; notes why not. */
bool frame_decisions_took(frame_decisions *decisions, uint32_t frame, t3r_status status,
                          const t3r_stream_report *report);

/* Adds the gate's figures to a frame's object. */
void frame_figures_add(cJSON *item, const t3r_stream_report *report);
/* Adds "skipped", an array with frame, reason and figures, and "skip_counts", the count of each reason. */
void frame_decisions_add(cJSON *root, const frame_decisions *decisions);
/* Prints a row for each skipped frame, and the counts. */
void frame_decisions_print(const frame_decisions *decisions);

#endif
