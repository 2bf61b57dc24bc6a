/* SPDX-License-Identifier: Apache-2.0 */
/* Files for reading, and their bytes in memory. */
#ifndef T3R_PLATFORM_FILE_BYTES_H
#define T3R_PLATFORM_FILE_BYTES_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Opens a file that a file from elsewhere names. Only regular files are opened: a pipe would block, and opening a
 * device may have effects. Returns NULL with "path: why" in error[] on failure. */
FILE *t3r_file_open(const char *path, char *error, size_t error_bytes);

/* Most bytes read from a pipe, whose size is unknown. */
#define T3R_PIPE_BYTES_MOST ((size_t)128 << 20)

/* Reads a whole file, or a pipe with a writer. The bytes are followed by a 0 that `count` excludes; free() them.
 * Returns NULL with "path: why" in error[] on failure, also for more than `most` bytes (SIZE_MAX: no limit). */
uint8_t *t3r_file_bytes(const char *path, size_t most, size_t *count, char *error, size_t error_bytes);

/* Does the same if check() returns no reason against the first 64 bytes, or fewer. So a large file of another kind is
 * not read. */
typedef const char *(*t3r_file_check)(const uint8_t *first, size_t count);
uint8_t *t3r_file_bytes_checked(const char *path, size_t most, t3r_file_check check, size_t *count, char *error,
                                size_t error_bytes);

#endif
