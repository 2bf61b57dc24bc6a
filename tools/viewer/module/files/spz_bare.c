/* SPDX-License-Identifier: Apache-2.0 */
/* .spz without the libraries that unpack it: the page unpacks gzip, and the streams of version 4, where they lie. */
#include "host/reason.h"
#include "scene/formats/spz/spz_file.h"
#include "scene/scene_format.h"

/* Finds the attributes in streams that were unpacked. */
static int find_unpacked(const uint8_t *bytes, size_t count, spz_file *file, char *error, size_t error_bytes)
{
    spz_stream streams[SPZ_STREAMS] = {{0}};
    const int needed = spz_find_packed(bytes, count, file, streams, error, error_bytes);
    file->streams[SPZ_HARMONICS] = bytes; /* of no length below degree 1 */
    for (int i = 0; i < needed; i++) {
        const size_t size = (size_t)file->layout.count * spz_stream_bytes(&file->layout, i);
        if (streams[i].bytes != size) {
            return t3r_reason(error, error_bytes, "stream %d unpacks to %zu bytes, not to %zu", i, streams[i].bytes,
                              size);
        }
        file->streams[i] = bytes + streams[i].at;
    }
    return needed < 0 ? -1 : 0;
}

static int parse(const uint8_t *bytes, size_t count, const scene_sink *sink, char *error, size_t error_bytes)
{
    spz_file file;
    if (spz_open(bytes, count, &file, error, error_bytes) != 0) {
        return -1;
    }
    if (file.layout.version != SPZ_VERSION) {
        return spz_parse_bare(bytes, count, &file, sink, error, error_bytes);
    }
    return find_unpacked(bytes, count, &file, error, error_bytes) == 0 ? spz_take_rows(&file, sink, error, error_bytes)
                                                                       : -1;
}

const scene_format scene_format_spz_bare = {.suffix = ".spz", .magic = SPZ_MAGIC, .parse = parse};
