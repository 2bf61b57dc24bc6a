/* SPDX-License-Identifier: Apache-2.0 */
/* Unpacks .spz files: version 4 by Zstandard, stream by stream; earlier ones by gzip. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#include <zstd.h>

#include "core/little_endian.h"
#include "host/reason.h"
#include "scene/formats/spz/spz_file.h"

/* Reads the extensions between the header and the table: of those known, the axes change what is read. */
static int read_extensions(const uint8_t *bytes, uint64_t end, spz_file *file, char *error, size_t error_bytes)
{
    uint64_t at = SPZ_HEADER_BYTES;
    while ((file->layout.flags & SPZ_FLAG_EXTENSIONS) != 0 && at < end) {
        const uint64_t size = end - at < SPZ_EXTENSION_BYTES ? UINT32_MAX : t3r_load_le32(bytes + at + 4);
        if (size > end - at - SPZ_EXTENSION_BYTES) {
            return t3r_reason(error, error_bytes, "byte %" PRIu64 ": an extension reaches beyond the others", at);
        }
        if (t3r_load_le32(bytes + at) == SPZ_EXTENSION_AXES && size >= 4) {
            const uint32_t axes = t3r_load_le32(bytes + at + SPZ_EXTENSION_BYTES);
            if (axes > SCENE_AXES_LAST) {
                return t3r_reason(error, error_bytes, "byte %" PRIu64 ": axes %" PRIu32 "; 1 to %d are known", at, axes,
                                  SCENE_AXES_LAST);
            }
            file->axes = axes > 0 ? (scene_axes)axes : SCENE_AXES_RUB;
        }
        at += SPZ_EXTENSION_BYTES + size;
    }
    return 0;
}

/* Decompresses the streams one after the other. */
static int unpack_streams(const uint8_t *bytes, size_t count, spz_file *file, uint8_t *whole, char *error,
                          size_t error_bytes)
{
    const uint64_t table = t3r_load_le32(bytes + SPZ_TABLE_AT);
    const uint32_t streams = bytes[SPZ_STREAMS_AT];
    const uint32_t needed = file->layout.degree > 0 ? SPZ_STREAMS : SPZ_HARMONICS;
    uint64_t at = table + (uint64_t)streams * SPZ_ENTRY_BYTES;
    if (streams < needed || table < SPZ_HEADER_BYTES || at > count) {
        return t3r_reason(error, error_bytes, "byte %d: %" PRIu32 " streams, their table at byte %" PRIu64,
                          SPZ_STREAMS_AT, streams, table);
    }
    if (read_extensions(bytes, table, file, error, error_bytes) != 0) {
        return -1;
    }
    for (uint32_t i = 0; i < needed; i++) {
        const uint64_t packed = t3r_load_le64(bytes + table + i * SPZ_ENTRY_BYTES);
        const size_t size = (size_t)file->layout.count * spz_stream_bytes(&file->layout, (int)i);
        if (packed > count - at) {
            return t3r_reason(error, error_bytes, "byte %zu: cut off in stream %" PRIu32, count, i);
        }
        const size_t made = ZSTD_decompress(whole, size, bytes + at, (size_t)packed);
        if (ZSTD_isError(made) || made != size) {
            return t3r_reason(error, error_bytes, "byte %" PRIu64 ": stream %" PRIu32 " does not unpack to %zu bytes",
                              at, i, size);
        }
        file->streams[i] = whole;
        whole += size;
        at += packed;
    }
    return 0;
}

int spz_parse(const uint8_t *bytes, size_t count, const scene_sink *sink, char *error, size_t error_bytes)
{
    spz_file file;
    if (spz_open(bytes, count, &file, error, error_bytes) != 0) {
        return -1;
    }
    if (file.layout.version != SPZ_VERSION) {
        return spz_parse_bare(bytes, count, &file, sink, error, error_bytes);
    }
    uint8_t *whole = malloc(spz_whole_bytes(&file.layout));
    if (whole == NULL) {
        return t3r_reason(error, error_bytes, "out of memory for %" PRIu32 " Gaussians", file.layout.count);
    }
    file.streams[SPZ_HARMONICS] = whole;
    int result = unpack_streams(bytes, count, &file, whole, error, error_bytes);
    if (result == 0) {
        result = spz_take_rows(&file, sink, error, error_bytes);
    }
    free(whole);
    return result;
}

/* Decompresses exactly `size` more bytes. Returns 0, or -1. */
static int inflate_bytes(z_stream *stream, uint8_t *out, size_t size)
{
    stream->next_out = out;
    stream->avail_out = (uInt)size; /* below 2^32: 2^24 Gaussians of 93 bytes */
    const int status = size == 0 ? Z_OK : inflate(stream, Z_SYNC_FLUSH);
    return (status == Z_OK || status == Z_STREAM_END) && stream->avail_out == 0 ? 0 : -1;
}

static int inflate_file(z_stream *stream, uint64_t packed, spz_file *file, uint8_t **whole, char *error,
                        size_t error_bytes)
{
    uint8_t header[SPZ_OLD_HEADER_BYTES];
    if (inflate_bytes(stream, header, sizeof header) != 0 || memcmp(header, SPZ_MAGIC, 4) != 0) {
        return t3r_reason(error, error_bytes, "byte 0: not an .spz file within gzip");
    }
    if (spz_read_header(header, packed, &file->layout, error, error_bytes) != 0) {
        return -1;
    }
    if (spz_check_old(&file->layout, error, error_bytes) != 0) {
        return -1;
    }
    const size_t size = spz_whole_bytes(&file->layout);
    *whole = malloc(size);
    if (*whole == NULL) {
        return t3r_reason(error, error_bytes, "out of memory for %" PRIu32 " Gaussians", file->layout.count);
    }
    if (inflate_bytes(stream, *whole, size) != 0) {
        return t3r_reason(error, error_bytes, "what is packed is not %zu bytes and a header", size);
    }
    spz_find_streams(file, *whole);
    return 0;
}

int spz_parse_gzip(const uint8_t *bytes, size_t count, const scene_sink *sink, char *error, size_t error_bytes)
{
    enum { GZIP = 16, WINDOW_BITS = 15 };
    spz_file file = {.axes = SCENE_AXES_RUB};
    uint8_t *whole = NULL;
    z_stream stream = {.next_in = (Bytef *)(uintptr_t)bytes,
                       .avail_in = (uInt)(count < UINT32_MAX ? count : UINT32_MAX)};
    if (inflateInit2(&stream, GZIP + WINDOW_BITS) != Z_OK) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    int result = inflate_file(&stream, count, &file, &whole, error, error_bytes);
    if (result == 0) {
        result = spz_take_rows(&file, sink, error, error_bytes);
    }
    free(whole);
    inflateEnd(&stream);
    return result;
}
