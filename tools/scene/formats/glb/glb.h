/* SPDX-License-Identifier: Apache-2.0 */
/* glTF 2.0 in one file (.glb) with KHR_gaussian_splatting: a chunk of JSON that names attributes, a chunk with their
 * numbers. x points left, y up and z forward. */
#ifndef TRIM3R_TOOLS_GLB_H
#define TRIM3R_TOOLS_GLB_H

#include <stdio.h>

#include "scene/scene_rows.h"

#define GLB_MAGIC "glTF"
#define GLB_VERSION 2u
#define GLB_EXTENSION "KHR_gaussian_splatting"

enum {
    GLB_VERSION_AT = 4,
    GLB_LENGTH_AT = 8,
    GLB_HEADER_BYTES = 12,
    GLB_CHUNK_BYTES = 8 /* each chunk's header: length, then kind */
};
#define GLB_JSON 0x4E4F534Au
#define GLB_BINARY 0x004E4942u

/* Component types of accessors. */
enum { GLB_BYTE = 5120, GLB_UBYTE = 5121, GLB_SHORT = 5122, GLB_USHORT = 5123, GLB_FLOAT = 5126 };

/* The attributes of a Gaussian; harmonics of degree 1 to 3 follow, coefficient after coefficient. */
enum { GLB_POSITION, GLB_ROTATION, GLB_SCALE, GLB_OPACITY, GLB_HARMONIC, GLB_REST };
enum { GLB_ATTRIBUTES_MOST = GLB_REST + HARMONICS_REST_MOST, GLB_NAME_BYTES = 64 };

/* Returns the name and the number of components of attribute `index`. */
const char *glb_attribute_name(uint32_t index, char name[GLB_NAME_BYTES]);
uint32_t glb_components(uint32_t index);

/* like scene_format's */
int glb_parse(const uint8_t *bytes, size_t count, const scene_sink *sink, char *error, size_t error_bytes);
int glb_write(FILE *file, const scene_source *source, char *error, size_t error_bytes);

#endif
