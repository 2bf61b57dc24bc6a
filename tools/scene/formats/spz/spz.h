/* Niantic's .spz: about 20 bytes a Gaussian before compression, attribute after attribute. Version 4 has a header of 32
 * bytes, a table of lengths and a Zstandard stream an attribute; versions 2 and 3 are one gzip stream of the same
 * attributes behind a header of 16 bytes. */
#ifndef TRIM3R_TOOLS_SPZ_H
#define TRIM3R_TOOLS_SPZ_H

#include <stdio.h>

#include "scene/scene_rows.h"

#define SPZ_MAGIC "NGSP"
#define SPZ_VERSION 4u /* that is written; 2 to 4 are read */

/* Bytes of both headers. */
enum {
    SPZ_VERSION_AT = 4,
    SPZ_COUNT_AT = 8,
    SPZ_DEGREE_AT = 12,
    SPZ_FRACTION_AT = 13, /* fraction bits of positions */
    SPZ_FLAGS_AT = 14,
    SPZ_OLD_HEADER_BYTES = 16,
    SPZ_STREAMS_AT = 15,
    SPZ_TABLE_AT = 16, /* the byte at which the table of lengths begins */
    SPZ_HEADER_BYTES = 32,
    SPZ_ENTRY_BYTES = 16 /* of the table: packed and unpacked bytes of a stream */
};

/* The attributes, in the order of the file. */
enum { SPZ_POSITIONS, SPZ_ALPHAS, SPZ_COLOURS, SPZ_SCALES, SPZ_ROTATIONS, SPZ_HARMONICS, SPZ_STREAMS };

/* Degree 4 is known, though its harmonics above 3 are passed over. */
#define SPZ_DEGREE_MOST 4u

typedef struct spz_layout {
    uint32_t version, count, degree, fraction_bits;
} spz_layout;

/* Bytes of an attribute of one Gaussian. */
uint32_t spz_stream_bytes(const spz_layout *layout, int stream);

#define SPZ_COLOUR_SCALE 0.15 /* byte = 255 x (0.5 + SPZ_COLOUR_SCALE x harmonic of degree 0) */
/* A scale's byte is 16 x (ln scale + 10). */
#define SPZ_SCALE_STEPS 16.0
#define SPZ_SCALE_LEAST -10.0

/* As scene_format has them: version 4, and versions 2 and 3. */
int spz_parse(const uint8_t *bytes, size_t count, scene_file *out, char *error, size_t error_bytes);
int spz_parse_gzip(const uint8_t *bytes, size_t count, scene_file *out, char *error, size_t error_bytes);
int spz_write(FILE *file, const scene_source *source, char *error, size_t error_bytes);

#endif
