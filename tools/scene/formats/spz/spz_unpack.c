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

/* Decompresses the streams one after the other. */
static int unpack_streams(const uint8_t *bytes, size_t count, spz_file *file, uint8_t *whole, char *error,
                          size_t error_bytes)
{
    spz_stream streams[SPZ_STREAMS];
    const int needed = spz_find_packed(bytes, count, file, streams, error, error_bytes);
    for (int i = 0; i < needed; i++) {
        const size_t size = (size_t)file->layout.count * spz_stream_bytes(&file->layout, i);
        const size_t made = ZSTD_decompress(whole, size, bytes + streams[i].at, streams[i].bytes);
        if (ZSTD_isError(made) || made != size) {
            return t3r_reason(error, error_bytes, "byte %zu: stream %d does not unpack to %zu bytes", streams[i].at, i,
                              size);
        }
        file->streams[i] = whole;
        whole += size;
    }
    return needed < 0 ? -1 : 0;
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
