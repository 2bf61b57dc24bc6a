/* SPDX-License-Identifier: Apache-2.0 */
/* The bytes of a recording's files: on the heap while all of them together are small, else in the spill. A file that is
 * packed with zstd is unpacked. */
#ifndef T3R_PLATFORM_RECORDING_BYTES_H
#define T3R_PLATFORM_RECORDING_BYTES_H

#include <stddef.h>
#include <stdint.h>

#include "mcap/spill.h"

/* Initialise with zeros. */
typedef struct t3r_recording_bytes {
    uint8_t **heap; /* one per file that is not in the spill */
    size_t heap_count, capacity;
    uint64_t heap_bytes;
} t3r_recording_bytes;

/* Reads a file, which begins like MCAP or zstd. *count: the bytes of MCAP; *stored: those of the file. They live as
 * long as `all` and `spill`. Returns NULL with "path: why" in error[] on failure. */
const uint8_t *t3r_recording_bytes_read(t3r_recording_bytes *all, t3r_spill *spill, const char *path, size_t *count,
                                        size_t *stored, char *error, size_t error_bytes);
void t3r_recording_bytes_free(t3r_recording_bytes *all);

#endif
