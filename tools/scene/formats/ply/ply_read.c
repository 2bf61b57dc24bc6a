/* SPDX-License-Identifier: Apache-2.0 */
/* 3DGS .ply: floats or doubles in any order, among other properties. */
#include "scene/formats/ply/ply.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/little_floats.h"
#include "host/reason.h"
#include "scene/formats/ply/packed_ply.h"
#include "scene/formats/ply/ply_body.h"
#include "scene/formats/ply/ply_header.h"
#include "scene/scene_rows.h"

/* The values read of each vertex, in this order; the harmonics above degree 0 follow. */
enum { X, Y, Z, DC_0, DC_1, DC_2, OPACITY, SCALE_0, SCALE_1, SCALE_2, ROT_0, ROT_1, ROT_2, ROT_3, WANTED_COUNT };
static const char *const wanted[WANTED_COUNT] = {"x",      "y",       "z",       "f_dc_0",  "f_dc_1",
                                                 "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2",
                                                 "rot_0",  "rot_1",   "rot_2",   "rot_3"};
enum { VALUES_MOST = WANTED_COUNT + 3 * HARMONICS_REST_MOST };

typedef struct ply_vertices {
    const uint8_t *rows;
    uint32_t row_bytes;
    uint32_t degree;
    uint32_t value_count; /* numbers read per row */
    /* NULL: missing. Colours may be bytes (red, green, blue) instead of harmonics. A flat Gaussian (2DGS) has no third
     * scale; a round one has one scale, and needs no rotation. */
    const ply_property *values[VALUES_MOST];
    bool has_bytes; /* colours are bytes */
    const char *remark;
} ply_vertices;

/* ---- header --------------------------------------------------------------------------------------------- */

static int find_wanted(const ply_header *header, const ply_element *vertex, const char *name, const ply_property **out,
                       char *error, size_t error_bytes)
{
    const ply_property *property = ply_header_property(header, vertex, name);
    if (property != NULL && property->kind != 'f') {
        return t3r_reason(error, error_bytes, "property %s is not a float or double", name);
    }
    *out = property;
    return 0;
}

/* Returns the number of properties whose names begin like those of harmonics. */
static uint32_t count_rest(const ply_header *header, const ply_element *vertex)
{
    uint32_t count = 0;
    for (uint32_t i = vertex->first; i < vertex->second; i++) {
        count += strncmp(header->properties[i].name, "f_rest_", strlen("f_rest_")) == 0;
    }
    return count;
}

/* Finds f_rest_0, f_rest_1 ...: all of red, then of green, then of blue. Those of degree 4 are skipped; all are, if
 * their number fits no degree, or one in between is missing. */
static int find_rest(const ply_header *header, const ply_element *vertex, ply_vertices *out, char *error,
                     size_t error_bytes)
{
    enum { DEGREES_KNOWN = 4 };
    const ply_property *rest[3 * ((DEGREES_KNOWN + 1) * (DEGREES_KNOWN + 1) - 1) + 1];
    const uint32_t there = count_rest(header, vertex);
    uint32_t count = 0, known = 0;
    for (; count < sizeof rest / sizeof rest[0]; count++) {
        char name[24];
        snprintf(name, sizeof name, "f_rest_%" PRIu32, count);
        if (find_wanted(header, vertex, name, &rest[count], error, error_bytes) != 0) {
            return -1;
        }
        if (rest[count] == NULL) {
            break;
        }
    }
    for (uint32_t degree = 0; degree <= DEGREES_KNOWN; degree++) {
        known = count == there && count == 3 * harmonics_rest(degree) ? degree : known;
    }
    out->degree = known < HARMONICS_DEGREE_MOST ? known : HARMONICS_DEGREE_MOST;
    out->remark = there != 3 * harmonics_rest(known) ? "harmonics whose number fits no degree are left out"
                  : known > HARMONICS_DEGREE_MOST    ? SCENE_REMARK_DEGREE_4
                                                     : NULL;
    const uint32_t read = harmonics_rest(out->degree);
    for (uint32_t i = 0; i < 3 * read; i++) {
        out->values[WANTED_COUNT + i] = rest[i / read * (count / 3) + i % read];
    }
    out->value_count = WANTED_COUNT + 3 * read;
    return 0;
}

/* Finds bytes red, green and blue for missing harmonics of degree 0. */
static void find_bytes(const ply_header *header, const ply_element *vertex, ply_vertices *out)
{
    static const char *const names[] = {"red", "green", "blue"};
    const ply_property *found[3];
    for (int i = 0; i < 3; i++) {
        found[i] = ply_header_property(header, vertex, names[i]);
        if (out->values[DC_0 + i] != NULL || found[i] == NULL || found[i]->kind != 'u' || found[i]->bytes != 1) {
            return;
        }
    }
    memcpy(&out->values[DC_0], found, sizeof found);
    out->has_bytes = true;
}

static bool may_be_missing(const ply_vertices *v, int index)
{
    const bool is_round = v->values[SCALE_0] != NULL && v->values[SCALE_1] == NULL && v->values[SCALE_2] == NULL;
    const bool is_turned =
        v->values[ROT_0] != NULL || v->values[ROT_1] != NULL || v->values[ROT_2] != NULL || v->values[ROT_3] != NULL;
    return index == SCALE_2 || (is_round && (index == SCALE_1 || (index >= ROT_0 && !is_turned)));
}

static int find_values(const ply_header *header, const ply_element *vertex, ply_vertices *out, char *error,
                       size_t error_bytes)
{
    for (int i = 0; i < WANTED_COUNT; i++) {
        if (find_wanted(header, vertex, wanted[i], &out->values[i], error, error_bytes) != 0) {
            return -1;
        }
    }
    find_bytes(header, vertex, out);
    for (int i = 0; i < WANTED_COUNT; i++) {
        if (out->values[i] == NULL && !may_be_missing(out, i)) {
            return t3r_reason(error, error_bytes, "property %s is missing: not a file of Gaussians", wanted[i]);
        }
    }
    return find_rest(header, vertex, out, error, error_bytes);
}

/* ---- vertices --------------------------------------------------------------------------------------------- */

/* Returns the value of a column that the file does not have. */
static double value_of_missing(uint32_t index, const double value[VALUES_MOST], bool is_round)
{
    return index == ROT_0 ? 1 : index > ROT_0 ? 0 : is_round ? value[SCALE_0] : -INFINITY; /* flat */
}

static double load(const ply_property *property, const uint8_t *bytes)
{
    return property->kind == 'u'  ? (*bytes / 255.0 - 0.5) / HARMONICS_ZERO
           : property->bytes == 8 ? t3r_load_double(bytes)
                                  : t3r_load_float(bytes);
}

/* Whether an infinity is intended: exporters write the logit of opacity 1 or 0, and the logarithm of scale 0, so. */
static bool is_meant(uint32_t index, double value)
{
    return isfinite(value) ||
           (isinf(value) && (index == OPACITY || (index >= SCALE_0 && index <= SCALE_2 && value < 0)));
}

static int read_vertex(void *user, uint32_t index, scene_row *row, char *error, size_t error_bytes)
{
    const ply_vertices *vertices = user;
    double value[VALUES_MOST];
    const size_t at = (size_t)index * vertices->row_bytes;
    for (uint32_t i = 0; i < vertices->value_count; i++) {
        const ply_property *property = vertices->values[i];
        if (property == NULL) {
            value[i] = value_of_missing(i, value, vertices->values[SCALE_1] == NULL);
            continue;
        }
        value[i] = load(property, vertices->rows + at + property->offset);
        if (!is_meant(i, value[i])) {
            return t3r_reason(error, error_bytes, "vertex %" PRIu32 ": %s is not a finite number", index,
                              property->name);
        }
    }
    *row = (scene_row){.position = {value[X], value[Y], value[Z]},
                       .harmonic = {value[DC_0], value[DC_1], value[DC_2]},
                       .opacity_logit = value[OPACITY],
                       .log_scale = {value[SCALE_0], value[SCALE_1], value[SCALE_2]},
                       .rotation = {value[ROT_0], value[ROT_1], value[ROT_2], value[ROT_3]}};
    const uint32_t rest = harmonics_rest(vertices->degree);
    for (uint32_t i = 0; i < 3 * rest; i++) {
        row->rest[i % rest][i / rest] = value[WANTED_COUNT + i];
    }
    return 0;
}

/* Whether another row could follow the last element's. */
static bool has_more(const ply_header *header, const ply_element *vertex, size_t count)
{
    const ply_element *last = &header->elements[header->element_count - 1];
    return last == vertex && count - vertex->at - (uint64_t)vertex->count * vertex->row_bytes >= vertex->row_bytes;
}

static int parse_vertices(const ply_header *header, const uint8_t *bytes, size_t count, const scene_sink *sink,
                          char *error, size_t error_bytes)
{
    const ply_element *vertex;
    ply_vertices vertices = {0};
    if (ply_header_rows(header, "vertex", count, &vertex, error, error_bytes) != 0 ||
        find_values(header, vertex, &vertices, error, error_bytes) != 0) {
        return -1;
    }
    if (vertex->count == 0) {
        return t3r_reason(error, error_bytes, "the file holds no Gaussians");
    }
    if (header->backdrop > vertex->count) {
        return t3r_reason(error, error_bytes, "the header names a backdrop of %" PRIu32 " of %" PRIu32 " Gaussians",
                          header->backdrop, vertex->count);
    }
    vertices.rows = bytes + vertex->at;
    vertices.row_bytes = vertex->row_bytes;
    scene_rows rows = {.count = vertex->count,
                       .has_frame = header->has_exponent && header->has_origin,
                       .local = header->local,
                       .frame = header->frame,
                       .degree = vertices.degree,
                       .mip = header->mip,
                       .up = header->up,
                       .backdrop = header->backdrop,
                       .remark = vertices.remark != NULL ? vertices.remark
                                 : has_more(header, vertex, count)
                                     ? "rows beyond those that the header states are left out"
                                     : NULL,
                       .read = read_vertex,
                       .user = &vertices};
    return sink->take(sink->user, &rows, error, error_bytes);
}

static int parse_body(const ply_header *header, const uint8_t *bytes, size_t count, const scene_sink *sink, char *error,
                      size_t error_bytes)
{
    return packed_ply_is(header) ? packed_ply_parse(header, bytes, count, sink, error, error_bytes)
                                 : parse_vertices(header, bytes, count, sink, error, error_bytes);
}

int ply_parse(const uint8_t *bytes, size_t count, const scene_sink *sink, char *error, size_t error_bytes)
{
    ply_header header;
    if (ply_header_read(bytes, count, &header, error, error_bytes) != 0) {
        return -1;
    }
    if (header.encoding == PLY_LITTLE_ENDIAN) {
        return parse_body(&header, bytes, count, sink, error, error_bytes);
    }
    uint8_t *converted = ply_body_convert(&header, bytes, &count, error, error_bytes);
    const int result = converted != NULL ? parse_body(&header, converted, count, sink, error, error_bytes) : -1;
    free(converted);
    return result;
}
