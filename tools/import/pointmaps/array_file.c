/* SPDX-License-Identifier: Apache-2.0 */
#include "import/pointmaps/array_file.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <zip.h>

#include "core/little_endian.h"
#include "host/file_bytes.h"
#include "host/reason.h"
#include "mcap/reader_limits.h"

#define BLOCK_BYTES 65536u

struct array_file {
    zip_source_t *source;
    zip_t *zip; /* NULL: a single .npy */
    uint64_t bytes, unpacked;
};

struct array_stream {
    array_file *file;
    zip_uint64_t index; /* index in the archive */
    zip_file_t *member; /* NULL: not open, or a single .npy */
    npy_array array;
    uint64_t at; /* bytes read */
    uint8_t block[BLOCK_BYTES];
};

static const char *first_bytes(zip_source_t *source, uint8_t first[2])
{
    bool read = zip_source_open(source) == 0;
    zip_int64_t got = read ? zip_source_read(source, first, 2) : -1;
    const char *why = got == 2   ? NULL
                      : got >= 0 ? "neither .npz nor .npy"
                                 : zip_error_strerror(zip_source_error(source));
    if (read) {
        zip_source_close(source);
    }
    return why;
}

/* Opens the source and owns it, also on failure. */
static array_file *open_source(zip_source_t *source, char *error, size_t error_bytes)
{
    uint8_t first[2] = {0};
    zip_stat_t about;
    zip_error_t why;
    zip_error_init(&why);
    array_file *file = calloc(1, sizeof *file);
    const char *wrong = file == NULL                           ? "out of memory"
                        : zip_source_stat(source, &about) != 0 ? "its size is not known"
                        : (about.valid & ZIP_STAT_SIZE) == 0   ? "its size is not known"
                                                               : first_bytes(source, first);
    if (wrong == NULL) {
        *file = (array_file){.source = source, .bytes = about.size};
        if (memcmp(first, "PK", 2) == 0) {
            file->zip = zip_open_from_source(source, ZIP_RDONLY | ZIP_CHECKCONS, &why);
            wrong = file->zip != NULL ? NULL : zip_error_strerror(&why);
        } else if (memcmp(first, "\x93N", 2) != 0) {
            wrong = "neither .npz nor .npy";
        } else if (zip_source_open(source) != 0) {
            wrong = zip_error_strerror(zip_source_error(source));
        }
    }
    if (wrong != NULL) {
        t3r_reason(error, error_bytes, "%s%s", first[0] == 'P' ? "not a whole zip archive (.npz): " : "", wrong);
        zip_source_free(source);
        free(file);
        file = NULL;
    }
    zip_error_fini(&why);
    return file;
}

array_file *array_file_parse(const uint8_t *bytes, size_t count, char *error, size_t error_bytes)
{
    zip_source_t *source = zip_source_buffer_create(bytes, count, 0, NULL);
    if (source == NULL) {
        t3r_reason(error, error_bytes, "out of memory");
        return NULL;
    }
    return open_source(source, error, error_bytes);
}

array_file *array_file_open(const char *path, char *error, size_t error_bytes)
{
    FILE *stream = t3r_file_open(path, error, error_bytes);
    if (stream == NULL) {
        return NULL;
    }
    char why[256];
    zip_source_t *source = zip_source_filep_create(stream, 0, -1, NULL);
    array_file *file = NULL;
    if (source == NULL) {
        fclose(stream);
        t3r_reason(error, error_bytes, "%s: out of memory", path);
    } else if ((file = open_source(source, why, sizeof why)) == NULL) {
        t3r_reason(error, error_bytes, "%s: %s", path, why);
    }
    return file;
}

void array_file_close(array_file *file)
{
    if (file == NULL) {
        return;
    }
    if (file->zip != NULL) {
        zip_discard(file->zip);
    } else {
        zip_source_close(file->source);
        zip_source_free(file->source);
    }
    free(file);
}

bool array_file_is_lone(const array_file *file)
{
    return file->zip == NULL;
}

static const char *reopen(array_stream *s)
{
    s->at = 0;
    if (s->file->zip == NULL) {
        return zip_source_seek(s->file->source, 0, SEEK_SET) == 0 ? NULL : "it cannot be read again";
    }
    if (s->member != NULL) {
        zip_fclose(s->member);
    }
    s->member = zip_fopen_index(s->file->zip, s->index, 0);
    return s->member != NULL ? NULL : zip_strerror(s->file->zip);
}

static const char *read_bytes(array_stream *s, uint8_t *out, size_t count)
{
    while (count > 0) {
        zip_int64_t got =
            s->member != NULL ? zip_fread(s->member, out, count) : zip_source_read(s->file->source, out, count);
        if (got < 0) {
            return zip_error_strerror(s->member != NULL ? zip_file_get_error(s->member)
                                                        : zip_source_error(s->file->source));
        }
        if (got == 0) {
            return "cut off";
        }
        out += got;
        count -= (size_t)got;
        s->at += (uint64_t)got;
    }
    return NULL;
}

/* Moves to byte `offset` of the array's file. */
static const char *go_to(array_stream *s, uint64_t offset)
{
    const char *wrong = offset < s->at ? reopen(s) : NULL;
    while (wrong == NULL && s->at < offset) {
        uint64_t rest = offset - s->at;
        wrong = read_bytes(s, s->block, rest < BLOCK_BYTES ? (size_t)rest : BLOCK_BYTES);
    }
    return wrong;
}

/* Reads past the last byte, which makes libzip compare the CRC. */
static const char *check_end(array_stream *s)
{
    uint8_t more;
    zip_int64_t got = s->member != NULL ? zip_fread(s->member, &more, 1) : 0;
    return got == 0  ? NULL
           : got > 0 ? "longer than its header says"
                     : zip_error_strerror(zip_file_get_error(s->member));
}

/* Gets the size of the array's file within the archive. */
static const char *stat_array(array_stream *s, uint64_t *bytes)
{
    zip_stat_t about;
    if (s->file->zip == NULL) {
        *bytes = s->file->bytes;
        return NULL;
    }
    if (zip_stat_index(s->file->zip, s->index, 0, &about) != 0 || (about.valid & ZIP_STAT_SIZE) == 0) {
        return "its size is not known";
    }
    *bytes = about.size;
    return NULL;
}

static int read_header(array_stream *s, char *error, size_t error_bytes)
{
    uint64_t bytes;
    const char *wrong = stat_array(s, &bytes);
    wrong = wrong != NULL ? wrong : reopen(s);
    size_t head = bytes < BLOCK_BYTES ? (size_t)bytes : BLOCK_BYTES;
    wrong = wrong != NULL ? wrong : read_bytes(s, s->block, head);
    if (wrong != NULL) {
        return t3r_reason(error, error_bytes, "%s", wrong);
    }
    if (npy_parse(s->block, head, bytes, &s->array, error, error_bytes) != 0) {
        return -1;
    }
    array_file *file = s->file;
    uint64_t most = t3r_limit_unpacked(file->bytes);
    if (file->zip != NULL && (bytes > most || file->unpacked > most - bytes)) {
        return t3r_reason(error, error_bytes,
                          "it unpacks to %" PRIu64 " bytes, those before it to %" PRIu64 ": a file of %" PRIu64
                          " may unpack to %" PRIu64,
                          bytes, file->unpacked, file->bytes, most);
    }
    file->unpacked += bytes;
    return 0;
}

int array_file_find(array_file *file, const char *name, array_stream **out, char *error, size_t error_bytes)
{
    char member[64];
    snprintf(member, sizeof member, "%s.npy", name);
    zip_int64_t index = file->zip == NULL ? 0 : zip_name_locate(file->zip, member, 0);
    *out = NULL;
    if (index < 0) {
        return 0;
    }
    array_stream *s = malloc(sizeof *s);
    if (s == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    *s = (array_stream){.file = file, .index = (zip_uint64_t)index};
    if (read_header(s, error, error_bytes) != 0) {
        array_stream_close(s);
        return -1;
    }
    *out = s;
    return 1;
}

void array_stream_close(array_stream *s)
{
    if (s != NULL && s->member != NULL) {
        zip_fclose(s->member);
    }
    free(s);
}

const npy_array *array_stream_header(const array_stream *s)
{
    return &s->array;
}

/* Reads into either floats or doubles. */
static const char *read_numbers(array_stream *s, size_t first, size_t count, float *floats, double *doubles)
{
    size_t step = s->array.item_bytes, block = BLOCK_BYTES / step;
    const char *wrong = go_to(s, s->array.header_bytes + (uint64_t)first * step);
    for (size_t done = 0; wrong == NULL && done < count;) {
        size_t some = count - done < block ? count - done : block;
        wrong = read_bytes(s, s->block, some * step);
        for (size_t i = 0; wrong == NULL && i < some; i++) {
            double value = npy_value(&s->array, s->block + i * step);
            if (floats != NULL) {
                floats[done + i] = (float)value;
            } else {
                doubles[done + i] = value;
            }
        }
        done += some;
    }
    return wrong == NULL && first + count == s->array.count ? check_end(s) : wrong;
}

const char *array_stream_floats(array_stream *s, size_t first, size_t count, float *out)
{
    return read_numbers(s, first, count, out, NULL);
}

const char *array_stream_doubles(array_stream *s, size_t first, size_t count, double *out)
{
    return read_numbers(s, first, count, NULL, out);
}
