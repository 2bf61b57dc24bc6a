/* SPDX-License-Identifier: Apache-2.0 */
/* Orders Gaussians along a Z-order curve, so that those of a chunk are neighbours. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "host/little_floats.h"
#include "host/reason.h"
#include "scene/formats/byte_codes.h"
#include "scene/formats/ply/packed_ply.h"
#include "scene/formats/ply/ply.h"
#include "scene/scene_format.h"
#include "scene/scene_order.h"

/* Clamps logarithms of scales; readers accept no more. */
#define SCALE_MOST 20.0

typedef struct chunk {
    scene_row rows[PACKED_PLY_CHUNK];
    uint32_t count;
    double bounds[PACKED_BOUNDS]; /* as in the file, rounded to floats */
} chunk;

static void read_chunk(const scene_source *source, const uint32_t *order, uint32_t index, chunk *out)
{
    const uint32_t first = index * PACKED_PLY_CHUNK, left = source->rows->count - first;
    out->count = left < PACKED_PLY_CHUNK ? left : PACKED_PLY_CHUNK;
    for (uint32_t i = 0; i < out->count; i++) {
        scene_row *row = &out->rows[i];
        scene_source_row(source, order[first + i], row);
        for (int k = 0; k < 3; k++) {
            row->log_scale[k] = fmin(fmax(row->log_scale[k], -SCALE_MOST), SCALE_MOST);
        }
    }
}

static double bounded(const scene_row *row, int bound)
{
    const int axis = bound % 3;
    return bound < PACKED_LOW_SCALE    ? row->position[axis]
           : bound < PACKED_LOW_COLOUR ? row->log_scale[axis]
                                       : scene_row_colour(row, axis);
}

static void bound_chunk(chunk *c)
{
    for (int low = 0; low < PACKED_BOUNDS; low++) {
        if (low % 6 >= 3) {
            continue;
        }
        c->bounds[low] = c->bounds[low + 3] = bounded(&c->rows[0], low);
        for (uint32_t i = 1; i < c->count; i++) {
            const double value = bounded(&c->rows[i], low);
            c->bounds[low] = fmin(c->bounds[low], value);
            c->bounds[low + 3] = fmax(c->bounds[low + 3], value);
        }
    }
    for (int i = 0; i < PACKED_BOUNDS; i++) {
        c->bounds[i] = (float)c->bounds[i];
    }
}

/* Quantizes a number of 0..1 to `bits` bits. */
static uint32_t steps(double share, uint32_t bits)
{
    const uint32_t most = (1u << bits) - 1;
    return share <= 0 ? 0 : share >= 1 ? most : (uint32_t)nearbyint(share * most);
}

/* Returns the position of a row's value between two bounds of its chunk, 0..1. */
static double share_of(const chunk *c, const scene_row *row, int low)
{
    const double size = c->bounds[low + 3] - c->bounds[low];
    return size > 0 ? (bounded(row, low) - c->bounds[low]) / size : 0;
}

static uint32_t pack_three(const chunk *c, const scene_row *row, int low)
{
    return steps(share_of(c, row, low), 11) << 21 | steps(share_of(c, row, low + 1), 10) << 11 |
           steps(share_of(c, row, low + 2), 11);
}

static uint32_t pack_rotation(const double rotation[4])
{
    uint32_t largest = 0;
    for (uint32_t i = 1; i < 4; i++) {
        largest = fabs(rotation[i]) > fabs(rotation[largest]) ? i : largest;
    }
    uint32_t word = largest;
    for (uint32_t i = 0; i < 4; i++) {
        if (i != largest) {
            word = word << 10 | steps(copysign(M_SQRT1_2, rotation[largest]) * rotation[i] + 0.5, 10);
        }
    }
    return word;
}

static uint32_t pack_colour(const chunk *c, const scene_row *row)
{
    return steps(share_of(c, row, PACKED_LOW_COLOUR), 8) << 24 |
           steps(share_of(c, row, PACKED_LOW_COLOUR + 1), 8) << 16 |
           steps(share_of(c, row, PACKED_LOW_COLOUR + 2), 8) << 8 | steps(scene_row_opacity(row), 8);
}

static void write_header(FILE *file, const scene_source *source)
{
    const uint32_t count = source->rows->count;
    fputs("ply\nformat binary_little_endian 1.0\n", file);
    fputs(source->rows->mip ? PLY_MIP_COMMENT "\n" : "", file);
    fprintf(file, "element chunk %" PRIu32 "\n", (count + PACKED_PLY_CHUNK - 1) / PACKED_PLY_CHUNK);
    for (int i = 0; i < PACKED_BOUNDS; i++) {
        fprintf(file, "property float %s\n", packed_ply_bounds[i]);
    }
    fprintf(file, "element vertex %" PRIu32 "\n", count);
    for (int i = 0; i < PACKED_WORDS; i++) {
        fprintf(file, "property uint %s\n", packed_ply_words[i]);
    }
    if (source->degree > 0) {
        fprintf(file, "element sh %" PRIu32 "\n", count);
    }
    for (uint32_t i = 0; i < 3 * harmonics_rest(source->degree); i++) {
        fprintf(file, "property uchar f_rest_%" PRIu32 "\n", i);
    }
    fputs("end_header\n", file);
}

static void write_bounds(FILE *file, const chunk *c)
{
    for (int i = 0; i < PACKED_BOUNDS; i++) {
        uint8_t bytes[4];
        t3r_store_float(bytes, c->bounds[i]);
        fwrite(bytes, 1, sizeof bytes, file);
    }
}

static void write_words(FILE *file, const chunk *c)
{
    for (uint32_t i = 0; i < c->count; i++) {
        const scene_row *row = &c->rows[i];
        uint8_t bytes[4 * PACKED_WORDS];
        t3r_store_le32(bytes, pack_three(c, row, PACKED_LOW_POSITION));
        t3r_store_le32(bytes + 4, pack_rotation(row->rotation));
        t3r_store_le32(bytes + 8, pack_three(c, row, PACKED_LOW_SCALE));
        t3r_store_le32(bytes + 12, pack_colour(c, row));
        fwrite(bytes, 1, sizeof bytes, file);
    }
}

static void write_harmonics(FILE *file, const scene_source *source, const uint32_t *order)
{
    const uint32_t rest = harmonics_rest(source->degree);
    for (uint32_t i = 0; i < source->rows->count && rest > 0; i++) {
        scene_row row;
        scene_source_row(source, order[i], &row);
        for (uint32_t k = 0; k < 3 * rest; k++) {
            fputc(byte_of(floor((row.rest[k % rest][k / rest] + 4) * 32)), file);
        }
    }
}

static int packed_ply_write(FILE *file, const scene_source *source, char *error, size_t error_bytes)
{
    const uint32_t chunks = (source->rows->count + PACKED_PLY_CHUNK - 1) / PACKED_PLY_CHUNK;
    uint32_t *order = scene_order_morton(source);
    chunk *c = malloc(sizeof *c);
    if (order == NULL || c == NULL) {
        free(order);
        free(c);
        return t3r_reason(error, error_bytes, "out of memory for %" PRIu32 " Gaussians", source->rows->count);
    }
    write_header(file, source);
    /* all bounds come before all words */
    for (int words = 0; words < 2; words++) {
        for (uint32_t i = 0; i < chunks; i++) {
            read_chunk(source, order, i, c);
            bound_chunk(c);
            (words ? write_words : write_bounds)(file, c);
        }
    }
    write_harmonics(file, source, order);
    free(c);
    free(order);
    return 0;
}

const scene_format scene_format_packed_ply = {.suffix = ".compressed.ply",
                                              .magic = "ply",
                                              .degree = 3,
                                              .harmonics = 4,
                                              .log_scale = {-SCALE_MOST, SCALE_MOST},
                                              .holds_mip = true,
                                              .shares_bits = true,
                                              .parse = ply_parse,
                                              .write = packed_ply_write};
