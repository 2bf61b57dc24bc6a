#include "import/npz.h"

#include <stdio.h>
#include <stdlib.h>

#include <zip.h>

#include "reason.h"

#define FIRST_BYTES ((size_t)1 << 16)

struct npz {
    zip_t *zip;
};

npz *npz_open(const uint8_t *bytes, size_t count, char *error, size_t error_bytes)
{
    zip_error_t why;
    zip_error_init(&why);
    npz *archive = malloc(sizeof *archive);
    zip_source_t *source = zip_source_buffer_create(bytes, count, 0, &why);
    zip_t *zip = source == NULL ? NULL : zip_open_from_source(source, ZIP_RDONLY | ZIP_CHECKCONS, &why);
    if (zip == NULL) {
        t3r_reason(error, error_bytes, "not a whole zip archive (.npz): %s", zip_error_strerror(&why));
        zip_source_free(source);
    } else if (archive == NULL) {
        t3r_reason(error, error_bytes, "out of memory");
        zip_discard(zip);
    }
    zip_error_fini(&why);
    if (zip == NULL || archive == NULL) {
        free(archive);
        return NULL;
    }
    archive->zip = zip;
    return archive;
}

void npz_close(npz *archive)
{
    if (archive != NULL) {
        zip_discard(archive->zip);
        free(archive);
    }
}

/* To the end, so that libzip compares the CRC; what the directory says of the size is not relied on. NULL, or why. */
static const char *read_all(zip_file_t *file, size_t most, uint8_t **bytes, size_t *count)
{
    size_t room = 0;
    zip_int64_t got;
    do {
        if (*count == room) {
            room = room == 0 ? FIRST_BYTES : room * 2;
            uint8_t *grown = realloc(*bytes, room);
            if (grown == NULL) {
                return "out of memory";
            }
            *bytes = grown;
        }
        got = zip_fread(file, *bytes + *count, room - *count);
        *count += got > 0 ? (size_t)got : 0;
        if (*count > most) {
            return "larger than is supported";
        }
    } while (got > 0);
    return got < 0 ? zip_error_strerror(zip_file_get_error(file)) : NULL;
}

int npz_read(npz *archive, const char *name, size_t most, uint8_t **bytes, size_t *count, char *error,
             size_t error_bytes)
{
    char member[64];
    snprintf(member, sizeof member, "%s.npy", name);
    *bytes = NULL;
    *count = 0;
    zip_int64_t index = zip_name_locate(archive->zip, member, 0);
    if (index < 0) {
        return 0;
    }
    zip_file_t *file = zip_fopen_index(archive->zip, (zip_uint64_t)index, 0);
    const char *why = file == NULL ? zip_strerror(archive->zip) : read_all(file, most, bytes, count);
    int status = why == NULL ? 1 : t3r_reason(error, error_bytes, "%s", why);
    if (file != NULL) {
        zip_fclose(file);
    }
    if (status < 0) {
        free(*bytes);
        *bytes = NULL;
    }
    return status;
}
