/* SPDX-License-Identifier: Apache-2.0 */
/* A map that follows a live camera (--stream): opened with the first frame that it can use, saved at the end. */
#ifndef TRIM3R_TOOLS_LIVE_STREAM_H
#define TRIM3R_TOOLS_LIVE_STREAM_H

#include <stdbool.h>

#include "reconstruction/live/live_map.h"
#include "reconstruction/live/live_output.h"
#include "trim3r_capture.h"

typedef struct live_stream {
    live_map map;
    live_output output;
    bool is_open;
} live_stream;

/* Opens the map for frames of this size, unless the settings have one. These return an exit status of cli.h after a
 * message; live_stream_close() is due in any case. prints_table: rows go to stdout. */
int live_stream_open(live_stream *stream, const reconstruction_options *settings, const live_options *options,
                     const t3r_capture_frame *like, bool prints_table);
/* Writes a row, and the snapshot that is due after it. */
int live_stream_row(live_stream *stream, const live_row *row);
/* Writes map and state, if there is a map. */
int live_stream_save(live_stream *stream);
void live_stream_close(live_stream *stream);

#endif
