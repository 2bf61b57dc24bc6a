/* SPDX-License-Identifier: Apache-2.0 */
/* .spz without the libraries that unpack it: versions 1 to 3, which a browser unpacks if they are gzip streams. */
#include "host/reason.h"
#include "scene/formats/spz/spz_file.h"
#include "scene/scene_format.h"

static int parse(const uint8_t *bytes, size_t count, const scene_sink *sink, char *error, size_t error_bytes)
{
    spz_file file;
    if (spz_open(bytes, count, &file, error, error_bytes) != 0) {
        return -1;
    }
    return file.layout.version == SPZ_VERSION
               ? t3r_reason(error, error_bytes, "packed by Zstandard, which a browser does not unpack")
               : spz_parse_bare(bytes, count, &file, sink, error, error_bytes);
}

const scene_format scene_format_spz_bare = {.suffix = ".spz", .magic = SPZ_MAGIC, .parse = parse};
