/* SPDX-License-Identifier: Apache-2.0 */
/* An .spz file whose attributes are being found: unpacked in memory, or as they lie in the file. */
#ifndef TRIM3R_TOOLS_SPZ_FILE_H
#define TRIM3R_TOOLS_SPZ_FILE_H

#include "scene/formats/spz/spz.h"

typedef struct spz_file {
    spz_layout layout;
    scene_axes axes;
    const uint8_t *streams[SPZ_STREAMS];
} spz_file;

/* Reads and checks the header of a file that is not in gzip. Returns 0, or -1 with the reason in error[] (as do the
 * following). */
int spz_open(const uint8_t *bytes, size_t count, spz_file *file, char *error, size_t error_bytes);
/* Reads the fields that both headers have; the number of Gaussians is limited by `packed` bytes. */
int spz_read_header(const uint8_t *bytes, uint64_t packed, spz_layout *out, char *error, size_t error_bytes);
/* Checks that the version is one of 1 to 3. */
int spz_check_old(const spz_layout *layout, char *error, size_t error_bytes);
/* Returns the bytes of all attributes. */
size_t spz_whole_bytes(const spz_layout *layout);
/* Finds the attributes of versions 1 to 3 in the bytes after the header. */
void spz_find_streams(spz_file *file, const uint8_t *bytes);
/* A stream of version 4 as it lies in the file. */
typedef struct spz_stream {
    size_t at, bytes;
} spz_stream;
/* Finds the streams that are needed, and the axes, in the whole bytes of version 4. Returns the number of streams; -1
 * with the reason in error[]. */
int spz_find_packed(const uint8_t *bytes, size_t count, spz_file *file, spz_stream streams[SPZ_STREAMS], char *error,
                    size_t error_bytes);
/* Hands the rows to the sink, and returns what it returns. */
int spz_take_rows(spz_file *file, const scene_sink *sink, char *error, size_t error_bytes);
/* Parses the attributes of an opened file of versions 1 to 3, which lie bare in it. */
int spz_parse_bare(const uint8_t *bytes, size_t count, spz_file *file, const scene_sink *sink, char *error,
                   size_t error_bytes);

#endif
