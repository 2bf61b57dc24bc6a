/* SPDX-License-Identifier: Apache-2.0 */
/* PlayCanvas's compressed .ply: Gaussians in chunks of 256, each in four 32-bit words relative to the bounds of its
 * chunk; harmonics above degree 0 are bytes. */
#ifndef TRIM3R_TOOLS_PACKED_PLY_H
#define TRIM3R_TOOLS_PACKED_PLY_H

#include "scene/formats/ply/ply_header.h"
#include "scene/scene_rows.h"

#define PACKED_PLY_CHUNK 256u

/* A chunk's bounds in the order of the file. Old files have no colour bounds: colours are from 0 to 1 then. */
enum {
    PACKED_LOW_POSITION = 0,
    PACKED_HIGH_POSITION = 3,
    PACKED_LOW_SCALE = 6,
    PACKED_HIGH_SCALE = 9,
    PACKED_LOW_COLOUR = 12,
    PACKED_HIGH_COLOUR = 15,
    PACKED_BOUNDS = 18
};
extern const char *const packed_ply_bounds[PACKED_BOUNDS];
enum { PACKED_POSITION, PACKED_ROTATION, PACKED_SCALE, PACKED_COLOUR, PACKED_WORDS };
extern const char *const packed_ply_words[PACKED_WORDS];

/* Whether a header belongs to such a file. */
bool packed_ply_is(const ply_header *header);
int packed_ply_parse(const ply_header *header, const uint8_t *bytes, size_t count, const scene_sink *sink, char *error,
                     size_t error_bytes);

#endif
