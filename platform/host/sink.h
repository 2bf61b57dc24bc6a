/* SPDX-License-Identifier: Apache-2.0 */
/* A destination of bytes: a file, memory, a radio. */
#ifndef T3R_PLATFORM_SINK_H
#define T3R_PLATFORM_SINK_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef struct t3r_sink {
    /* Appends count bytes. Returns 0 when done. */
    int (*write)(void *user, const void *bytes, size_t count);
    void *user;
    /* Reads `count` of the appended bytes, from `offset` on. Returns 0 when done. NULL: they cannot be read back. */
    int (*read)(void *user, uint64_t offset, void *bytes, size_t count);
} t3r_sink;

/* Returns a sink that appends to a stdio stream, and reads it back if the stream is a file open for both. */
t3r_sink t3r_file_sink(FILE *file);

#endif
