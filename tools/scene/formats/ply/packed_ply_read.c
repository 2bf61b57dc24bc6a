/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/formats/ply/packed_ply.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "host/little_floats.h"
#include "host/reason.h"
#include "scene/formats/byte_codes.h"

const char *const packed_ply_bounds[PACKED_BOUNDS] = {
    "min_x",       "min_y",       "min_z",       "max_x", "max_y", "max_z", "min_scale_x", "min_scale_y", "min_scale_z",
    "max_scale_x", "max_scale_y", "max_scale_z", "min_r", "min_g", "min_b", "max_r",       "max_g",       "max_b"};
const char *const packed_ply_words[PACKED_WORDS] = {"packed_position", "packed_rotation", "packed_scale",
                                                    "packed_color"};

/* Rows of an element, and the offsets of the wanted properties in a row. */
typedef struct column_set {
    const uint8_t *rows;
    uint32_t row_bytes;
    uint32_t offset[3 * HARMONICS_REST_MOST];
} column_set;

typedef struct packed_file {
    column_set chunks, vertices, harmonics;
    uint32_t degree;
    bool has_colours; /* chunks have colour bounds */
} packed_file;

bool packed_ply_is(const ply_header *header)
{
    return ply_header_element(header, "chunk") != NULL;
}

static int find_column(const ply_header *header, const ply_element *element, const char *name, char kind,
                       uint32_t bytes, uint32_t *offset, char *error, size_t error_bytes)
{
    const ply_property *property = ply_header_property(header, element, name);
    if (property == NULL || property->kind != kind || property->bytes != bytes) {
        return t3r_reason(error, error_bytes, "element %s has no property %s of its type", element->name, name);
    }
    *offset = property->offset;
    return 0;
}

static int find_harmonics(const ply_header *header, const uint8_t *bytes, size_t count, uint32_t vertices,
                          packed_file *out, char *error, size_t error_bytes)
{
    const ply_element *element = ply_header_element(header, "sh");
    if (element == NULL) {
        return 0;
    }
    if (ply_header_rows(header, "sh", count, &element, error, error_bytes) != 0) {
        return -1;
    }
    const uint32_t columns = element->second - element->first;
    while (out->degree < HARMONICS_DEGREE_MOST && 3 * harmonics_rest(out->degree) != columns) {
        out->degree++;
    }
    if (3 * harmonics_rest(out->degree) != columns || element->count != vertices) {
        return t3r_reason(error, error_bytes, "element sh has %" PRIu32 " rows of %" PRIu32 " properties",
                          element->count, columns);
    }
    out->harmonics.rows = bytes + element->at;
    out->harmonics.row_bytes = element->row_bytes;
    for (uint32_t i = 0; i < columns; i++) {
        char name[24];
        snprintf(name, sizeof name, "f_rest_%" PRIu32, i);
        if (find_column(header, element, name, 'u', 1, &out->harmonics.offset[i], error, error_bytes) != 0) {
            return -1;
        }
    }
    return 0;
}

static int find_columns(const ply_header *header, const uint8_t *bytes, size_t count, packed_file *out,
                        uint32_t *vertices, char *error, size_t error_bytes)
{
    const ply_element *chunk, *vertex;
    if (ply_header_rows(header, "chunk", count, &chunk, error, error_bytes) != 0 ||
        ply_header_rows(header, "vertex", count, &vertex, error, error_bytes) != 0) {
        return -1;
    }
    if (vertex->count == 0 || (vertex->count - 1) / PACKED_PLY_CHUNK + 1 != chunk->count) {
        return t3r_reason(error, error_bytes, "%" PRIu32 " Gaussians in %" PRIu32 " chunks, %u in each", vertex->count,
                          chunk->count, PACKED_PLY_CHUNK);
    }
    *vertices = vertex->count;
    out->chunks = (column_set){.rows = bytes + chunk->at, .row_bytes = chunk->row_bytes};
    out->vertices = (column_set){.rows = bytes + vertex->at, .row_bytes = vertex->row_bytes};
    out->has_colours = ply_header_property(header, chunk, packed_ply_bounds[PACKED_LOW_COLOUR]) != NULL;
    for (int i = 0; i < (out->has_colours ? PACKED_BOUNDS : PACKED_LOW_COLOUR); i++) {
        if (find_column(header, chunk, packed_ply_bounds[i], 'f', 4, &out->chunks.offset[i], error, error_bytes) != 0) {
            return -1;
        }
    }
    for (int i = 0; i < PACKED_WORDS; i++) {
        if (find_column(header, vertex, packed_ply_words[i], 'u', 4, &out->vertices.offset[i], error, error_bytes) !=
            0) {
            return -1;
        }
    }
    return find_harmonics(header, bytes, count, vertex->count, out, error, error_bytes);
}

/* Returns `bits` of a word from bit `shift` on, as 0..1. */
static double share(uint32_t word, uint32_t shift, uint32_t bits)
{
    const uint32_t most = (1u << bits) - 1;
    return (double)(word >> shift & most) / most;
}

/* Interpolates between a chunk's bounds `low` and `high`. */
static double between(const packed_file *file, const uint8_t *chunk, int low, int high, double at)
{
    return t3r_load_float(chunk + file->chunks.offset[low]) * (1 - at) +
           t3r_load_float(chunk + file->chunks.offset[high]) * at;
}

static void unpack_rotation(uint32_t word, double rotation[4])
{
    const uint32_t largest = word >> 30;
    double left = 1;
    for (uint32_t i = 0, shift = 20; i < 4; i++) {
        if (i != largest) {
            rotation[i] = (share(word, shift, 10) - 0.5) * M_SQRT2;
            left -= rotation[i] * rotation[i];
            shift -= 10;
        }
    }
    rotation[largest] = sqrt(fmax(left, 0));
}

/* Returns the middle of one of 256 steps from -4 to 4; the outermost steps give -4 and 4. */
static double harmonic_of(uint8_t byte)
{
    return byte == 0 ? -4 : byte == 255 ? 4 : (byte + 0.5) / 32 - 4;
}

static int read_row(void *user, uint32_t index, scene_row *row, char *error, size_t error_bytes)
{
    const packed_file *file = user;
    const uint8_t *chunk = file->chunks.rows + (size_t)(index / PACKED_PLY_CHUNK) * file->chunks.row_bytes;
    uint32_t word[PACKED_WORDS];
    for (int i = 0; i < PACKED_WORDS; i++) {
        word[i] =
            t3r_load_le32(file->vertices.rows + (size_t)index * file->vertices.row_bytes + file->vertices.offset[i]);
    }
    static const uint32_t shift[3] = {21, 11, 0}, bits[3] = {11, 10, 11};
    *row = (scene_row){.opacity_logit = logit_of_byte((uint8_t)word[PACKED_COLOUR])};
    for (int i = 0; i < 3; i++) {
        row->position[i] = between(file, chunk, PACKED_LOW_POSITION + i, PACKED_HIGH_POSITION + i,
                                   share(word[PACKED_POSITION], shift[i], bits[i]));
        row->log_scale[i] = between(file, chunk, PACKED_LOW_SCALE + i, PACKED_HIGH_SCALE + i,
                                    share(word[PACKED_SCALE], shift[i], bits[i]));
        double colour = share(word[PACKED_COLOUR], 24 - 8 * (uint32_t)i, 8);
        if (file->has_colours) {
            colour = between(file, chunk, PACKED_LOW_COLOUR + i, PACKED_HIGH_COLOUR + i, colour);
        }
        row->harmonic[i] = (colour - 0.5) / HARMONICS_ZERO;
        if (!isfinite(row->position[i]) || !isfinite(row->log_scale[i]) || !isfinite(row->harmonic[i])) {
            return t3r_reason(error, error_bytes, "chunk %" PRIu32 ": a bound is not a finite number",
                              index / PACKED_PLY_CHUNK);
        }
    }
    unpack_rotation(word[PACKED_ROTATION], row->rotation);
    const uint32_t rest = harmonics_rest(file->degree);
    const size_t first = (size_t)index * file->harmonics.row_bytes;
    for (uint32_t i = 0; i < 3 * rest; i++) {
        row->rest[i % rest][i / rest] = harmonic_of(file->harmonics.rows[first + file->harmonics.offset[i]]);
    }
    return 0;
}

int packed_ply_parse(const ply_header *header, const uint8_t *bytes, size_t count, const scene_sink *sink, char *error,
                     size_t error_bytes)
{
    packed_file file = {0};
    uint32_t vertices = 0;
    if (find_columns(header, bytes, count, &file, &vertices, error, error_bytes) != 0) {
        return -1;
    }
    const scene_rows rows = {.count = vertices,
                             .degree = file.degree,
                             .mip = header->mip,
                             .up = header->up,
                             .read = read_row,
                             .user = &file};
    return sink->take(sink->user, &rows, error, error_bytes);
}
