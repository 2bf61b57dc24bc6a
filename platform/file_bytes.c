#include "file_bytes.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reason.h"

/* A seekable file's size is only the first guess: what is read counts. */
static size_t guess_bytes(FILE *file)
{
    long end = fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
    rewind(file);
    return end >= 0 && (uint64_t)end < SIZE_MAX / 2 && end != LONG_MAX ? (size_t)end : (size_t)1 << 16;
}

/* NULL with a reason, which may be errno's, when it fails. */
static uint8_t *read_stream(FILE *file, size_t most, size_t *count, const char **why)
{
    size_t room = guess_bytes(file);
    room = (room < most ? room : most) + 2; /* one to notice the end or one byte too many, one for the 0 */
    uint8_t *bytes = NULL;
    size_t got;
    errno = 0;
    *count = 0;
    do {
        uint8_t *grown = bytes == NULL ? malloc(room) : room > SIZE_MAX / 2 ? NULL : realloc(bytes, room *= 2);
        if (grown == NULL) {
            *why = "out of memory";
            free(bytes);
            return NULL;
        }
        bytes = grown;
        got = fread(bytes + *count, 1, room - 1 - *count, file);
        *count += got;
    } while (*count == room - 1 && *count <= most);
    if (ferror(file) || *count > most) {
        *why = ferror(file) ? strerror(errno) : "the file is too large";
        free(bytes);
        return NULL;
    }
    bytes[*count] = 0;
    return bytes;
}

uint8_t *t3r_file_bytes(const char *path, size_t most, size_t *count, char *error, size_t error_bytes)
{
    FILE *file = fopen(path, "rb");
    const char *why = file == NULL ? strerror(errno) : NULL;
    uint8_t *bytes = file == NULL ? NULL : read_stream(file, most, count, &why);
    if (bytes == NULL) {
        t3r_reason(error, error_bytes, "%s: %s", path, why);
    }
    if (file != NULL) {
        fclose(file);
    }
    return bytes;
}
