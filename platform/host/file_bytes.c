/* SPDX-License-Identifier: Apache-2.0 */
#include "file_bytes.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "reason.h"

#define FIRST_BYTES 64u

static const char too_large[] = "the file is too large";

/* Opens with O_NONBLOCK, so that opening a pipe does not wait for a writer; a pipe without a writer reads as empty.
 * Reading a pipe then waits. Reading a file does not: for those of a disk it makes no difference, and one like
 * /proc/kmsg would block for ever. */
static FILE *open_kind(const char *path, bool pipes, struct stat *about, char *error, size_t error_bytes)
{
    if (stat(path, about) != 0) {
        t3r_reason(error, error_bytes, "%s: %s", path, strerror(errno));
        return NULL;
    }
    if (!S_ISREG(about->st_mode) && !(pipes && S_ISFIFO(about->st_mode))) {
        t3r_reason(error, error_bytes, "%s: %s", path,
                   S_ISDIR(about->st_mode) ? strerror(EISDIR) : "not a regular file");
        return NULL;
    }
    int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    FILE *file = NULL;
    if (descriptor >= 0 && fstat(descriptor, about) == 0 &&
        (!S_ISFIFO(about->st_mode) || fcntl(descriptor, F_SETFL, 0) == 0)) {
        file = fdopen(descriptor, "rb");
    }
    if (file == NULL) {
        t3r_reason(error, error_bytes, "%s: %s", path, strerror(errno));
        if (descriptor >= 0) {
            close(descriptor);
        }
    }
    return file;
}

FILE *t3r_file_open(const char *path, char *error, size_t error_bytes)
{
    struct stat about;
    return open_kind(path, false, &about, error, error_bytes);
}

/* Reads a whole stream. Returns NULL with a reason, which may be errno's, on failure. */
static uint8_t *read_stream(FILE *file, uint64_t guess, size_t most, t3r_file_check check, size_t *count,
                            const char **why)
{
    uint8_t first[FIRST_BYTES];
    errno = 0;
    *count = fread(first, 1, sizeof first, file);
    *why = ferror(file) ? strerror(errno) : check != NULL ? check(first, *count) : NULL;
    if (*why == NULL && (guess > most || *count > most)) {
        *why = too_large;
    }
    if (*why != NULL) {
        return NULL;
    }
    size_t room =
        (guess < sizeof first ? sizeof first : (size_t)guess) + 2; /* 2 more to notice the end and for the final 0 */
    uint8_t *bytes = malloc(room);
    if (bytes != NULL) {
        memcpy(bytes, first, *count);
    }
    for (size_t got = 1; bytes != NULL && got > 0 && *count <= most;) {
        if (*count == room - 1) {
            uint8_t *grown = room > SIZE_MAX / 2 ? NULL : realloc(bytes, room *= 2);
            if (grown == NULL) {
                free(bytes);
            }
            bytes = grown;
            continue;
        }
        got = fread(bytes + *count, 1, room - 1 - *count, file);
        *count += got;
    }
    if (bytes == NULL || ferror(file) || *count > most) {
        *why = bytes == NULL ? "out of memory" : ferror(file) ? strerror(errno) : too_large;
        free(bytes);
        return NULL;
    }
    bytes[*count] = 0;
    return bytes;
}

uint8_t *t3r_file_bytes_checked(const char *path, size_t most, t3r_file_check check, size_t *count, char *error,
                                size_t error_bytes)
{
    struct stat about;
    FILE *file = open_kind(path, true, &about, error, error_bytes);
    if (file == NULL) {
        return NULL;
    }
    bool pipe = !S_ISREG(about.st_mode);
    /* a file's size is only a first guess; what is read counts */
    uint64_t guess = pipe || about.st_size < 0 ? 1 << 16 : (uint64_t)about.st_size;
    const char *why;
    uint8_t *bytes =
        read_stream(file, guess, pipe && most > T3R_PIPE_BYTES_MOST ? T3R_PIPE_BYTES_MOST : most, check, count, &why);
    if (bytes == NULL) {
        t3r_reason(error, error_bytes, "%s: %s", path, why);
    }
    fclose(file);
    return bytes;
}

uint8_t *t3r_file_bytes(const char *path, size_t most, size_t *count, char *error, size_t error_bytes)
{
    return t3r_file_bytes_checked(path, most, NULL, count, error, error_bytes);
}
