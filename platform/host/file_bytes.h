/* Files for reading, and their bytes in memory. */
#ifndef T3R_PLATFORM_FILE_BYTES_H
#define T3R_PLATFORM_FILE_BYTES_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* A file that a folder of others names: nothing but a regular file is opened, since a pipe would keep its reader
 * waiting and opening a device may have effects. NULL with "path: why" in error[]. */
FILE *t3r_file_open(const char *path, char *error, size_t error_bytes);

/* The most that is read of a pipe, whose size nobody knows. */
#define T3R_PIPE_BYTES_MOST ((size_t)128 << 20)

/* The whole file, or pipe that somebody writes to, with a 0 behind that `count` leaves out; free() it. NULL with
 * "path: why" in error[], also when there are more than `most` bytes (SIZE_MAX: no limit). */
uint8_t *t3r_file_bytes(const char *path, size_t most, size_t *count, char *error, size_t error_bytes);

/* The same, once check() has seen the first 64 bytes, or fewer, and not answered with a reason: a large file of another
 * kind is not read. */
typedef const char *(*t3r_file_check)(const uint8_t *first, size_t count);
uint8_t *t3r_file_bytes_checked(const char *path, size_t most, t3r_file_check check, size_t *count, char *error,
                                size_t error_bytes);

#endif
