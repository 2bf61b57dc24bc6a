/* SPDX-License-Identifier: Apache-2.0 */
/* The files of a live map while it grows: JSON lines, snapshots of the map, and the state from which another run
 * continues. */
#ifndef TRIM3R_TOOLS_LIVE_OUTPUT_H
#define TRIM3R_TOOLS_LIVE_OUTPUT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "reconstruction/live/live_map.h"
#include "reconstruction/live/live_state.h"

typedef struct live_output {
    FILE *lines;       /* NULL = none */
    uint64_t written;  /* bytes of the lines */
    bool prints_table; /* rows also go to stdout */
} live_output;

/* Restores the map from its state if the options request it, with the caller's bytes in `state`; *resumed: there was
 * one. Then opens the lines, whose file goes on where the state was written. These return an exit status of cli.h after
 * a message; live_output_close() is due in any case. */
int live_output_open(live_output *out, live_map *map, bool prints_table, live_state *state, bool *resumed);
void live_output_close(live_output *out);

/* Writes the row as a line and into the table. */
int live_output_row(live_output *out, const live_map *map, const live_row *row);
/* Writes the map and the state with the caller's bytes, if a snapshot is due after this row; with NULL in any case.
 * A map without keyframes is an error only in the latter. */
int live_output_snapshot(live_output *out, live_map *map, const live_row *row, const void *more, size_t more_bytes);

#endif
