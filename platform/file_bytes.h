/* A file's bytes in memory. */
#ifndef T3R_PLATFORM_FILE_BYTES_H
#define T3R_PLATFORM_FILE_BYTES_H

#include <stddef.h>
#include <stdint.h>

/* The whole file (or pipe) with a 0 behind that `count` leaves out; free() it. NULL with "path: why" in error[],
 * also when there are more than `most` bytes (SIZE_MAX: no limit). */
uint8_t *t3r_file_bytes(const char *path, size_t most, size_t *count, char *error, size_t error_bytes);

#endif
