/* SPDX-License-Identifier: Apache-2.0 */
/* A stream in a file: the arena, the counts and hashes beside it, and bytes of the caller. Only the program that wrote
 * it reads it. */
#ifndef TRIM3R_TOOLS_LIVE_STATE_H
#define TRIM3R_TOOLS_LIVE_STATE_H

#include <stddef.h>
#include <stdint.h>

#include "reconstruction/live/live_map.h"

typedef struct live_state {
    uint64_t lines_bytes; /* length of the file of JSON lines */
    void *more;           /* the caller's bytes; read: on the heap, free() them */
    size_t more_bytes;
} live_state;

/* Writes the file as a whole. These return an exit status of cli.h after a message. */
int live_state_write(const char *path, const live_map *map, const live_state *state);
/* Reads it into an open map of the same settings; others are refused. */
int live_state_read(const char *path, live_map *map, live_state *state);

#endif
