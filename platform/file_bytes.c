#include "file_bytes.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reason.h"

uint8_t *t3r_file_bytes(const char *path, size_t *count, char *error, size_t error_bytes)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        t3r_reason(error, error_bytes, "%s: %s", path, strerror(errno));
        return NULL;
    }
    /* A seekable file's size is only the first guess: what is read counts. */
    size_t room = (size_t)1 << 16;
    if (fseek(file, 0, SEEK_END) == 0) {
        long end = ftell(file);
        room = end > 0 && (uint64_t)end < SIZE_MAX / 2 ? (size_t)end + 1 : room;
        rewind(file);
    }
    errno = 0;
    uint8_t *bytes = malloc(room);
    *count = 0;
    while (bytes != NULL) {
        size_t got = fread(bytes + *count, 1, room - *count, file);
        *count += got;
        if (*count < room || got == 0) {
            break;
        }
        uint8_t *grown = room > SIZE_MAX / 2 ? NULL : realloc(bytes, room * 2);
        if (grown == NULL) {
            free(bytes);
            bytes = NULL;
            break;
        }
        bytes = grown;
        room *= 2;
    }
    if (bytes == NULL) {
        t3r_reason(error, error_bytes, "%s: out of memory", path);
    } else if (ferror(file)) {
        t3r_reason(error, error_bytes, "%s: %s", path, strerror(errno));
        free(bytes);
        bytes = NULL;
    }
    fclose(file);
    return bytes;
}
