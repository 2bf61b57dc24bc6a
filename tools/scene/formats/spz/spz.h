/* SPDX-License-Identifier: Apache-2.0 */
/* Niantic's .spz: about 20 bytes per Gaussian before compression, attribute by attribute. Version 4 has a header of 32
 * bytes, extensions, a table of lengths and a Zstandard stream per attribute; versions 1 to 3 are a header of 16 bytes
 * and the same attributes, in one gzip stream or bare. */
#ifndef TRIM3R_TOOLS_SPZ_H
#define TRIM3R_TOOLS_SPZ_H

#include <stdio.h>

#include "scene/scene_rows.h"

#define SPZ_MAGIC "NGSP"
#define SPZ_VERSION 4u /* version written; 1 to 4 are read */

/* Sizes and offsets of both headers. */
enum {
    SPZ_VERSION_AT = 4,
    SPZ_COUNT_AT = 8,
    SPZ_DEGREE_AT = 12,
    SPZ_FRACTION_AT = 13, /* fraction bits of positions */
    SPZ_FLAGS_AT = 14,
    SPZ_OLD_HEADER_BYTES = 16,
    SPZ_STREAMS_AT = 15,
    SPZ_TABLE_AT = 16, /* offset of the table of lengths */
    SPZ_HEADER_BYTES = 32,
    SPZ_ENTRY_BYTES = 16 /* table entry: compressed and decompressed bytes of a stream */
};

enum { SPZ_FLAG_MIP = 1, SPZ_FLAG_EXTENSIONS = 2 };
/* An extension: its type, the number of bytes that follow, and these. */
enum { SPZ_EXTENSION_BYTES = 8 };
#define SPZ_EXTENSION_AXES 0xADBE0003u /* SPZ_ADOBE_coordinate_system: a scene_axes */

/* The attributes, in the order of the file. */
enum { SPZ_POSITIONS, SPZ_ALPHAS, SPZ_COLOURS, SPZ_SCALES, SPZ_ROTATIONS, SPZ_HARMONICS, SPZ_STREAMS };

/* Degree 4 is accepted, but its harmonics above degree 3 are skipped. */
#define SPZ_DEGREE_MOST 4u

typedef struct spz_layout {
    uint32_t version, count, degree, fraction_bits, flags;
} spz_layout;

/* Returns the bytes of an attribute per Gaussian. */
uint32_t spz_stream_bytes(const spz_layout *layout, int stream);

#define SPZ_COLOUR_SCALE 0.15 /* byte = 255 x (0.5 + SPZ_COLOUR_SCALE x harmonic of degree 0) */
/* A scale's byte is 16 x (ln scale + 10). */
#define SPZ_SCALE_STEPS 16.0
#define SPZ_SCALE_LEAST -10.0

/* As in scene_format: bare files, and gzip streams. */
int spz_parse(const uint8_t *bytes, size_t count, const scene_sink *sink, char *error, size_t error_bytes);
int spz_parse_gzip(const uint8_t *bytes, size_t count, const scene_sink *sink, char *error, size_t error_bytes);
int spz_write(FILE *file, const scene_source *source, char *error, size_t error_bytes);

#endif
