/* SPDX-License-Identifier: Apache-2.0 */
/* Reads the header of a .ply. It is untrusted text, so every line, count and offset is checked. */
#ifndef TRIM3R_TOOLS_PLY_HEADER_H
#define TRIM3R_TOOLS_PLY_HEADER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "scene/scene_turn.h"
#include "trim3r.h"

#define PLY_ELEMENTS_MOST 16u
#define PLY_PROPERTIES_MOST 2048u /* over all elements */
#define PLY_NAME_BYTES 64u

typedef struct ply_property {
    char name[PLY_NAME_BYTES];
    char kind;       /* 'i', 'u' or 'f': signed, unsigned, float */
    uint32_t bytes;  /* 1, 2, 4 or 8 */
    uint32_t offset; /* within a row */
} ply_property;

typedef struct ply_element {
    char name[PLY_NAME_BYTES];
    uint32_t count; /* rows */
    uint32_t row_bytes;
    uint64_t at;     /* byte of the file where its rows begin */
    bool lists;      /* it has lists or follows some: `at` and row_bytes are unknown */
    uint32_t first;  /* index of its first property in the header */
    uint32_t second; /* index after its last property */
} ply_element;

typedef enum ply_encoding { PLY_LITTLE_ENDIAN, PLY_BIG_ENDIAN, PLY_TEXT } ply_encoding;

typedef struct ply_header {
    ply_encoding encoding;
    size_t bytes; /* of the header */
    ply_element elements[PLY_ELEMENTS_MOST];
    uint32_t element_count;
    ply_property properties[PLY_PROPERTIES_MOST];
    uint32_t property_count;
    bool has_exponent, has_origin, local;
    t3r_scene_frame frame; /* as given in comments */
    bool mip;              /* a comment says "SplatRenderMode: mip" or "antialiased 1" */
    scene_up up;           /* a comment ends in "with Y-axis up" */
    uint32_t backdrop;     /* as given in a comment: the last so many vertices */
} ply_header;

/* Each returns 0, or -1 with "byte: what" in error[]. */
int ply_header_read(const uint8_t *bytes, size_t count, ply_header *out, char *error, size_t error_bytes);
/* Computes where each element's rows begin, the first at byte `data`. */
void ply_header_place(ply_header *header, uint64_t data);
/* Finds an element of at most T3R_MAX_GAUSSIANS rows, which all lie within the file's `count` bytes. */
int ply_header_rows(const ply_header *header, const char *name, size_t count, const ply_element **out, char *error,
                    size_t error_bytes);

/* Returns NULL if there is none. */
const ply_element *ply_header_element(const ply_header *header, const char *name);
const ply_property *ply_header_property(const ply_header *header, const ply_element *element, const char *name);

#endif
