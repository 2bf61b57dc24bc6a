/* SPDX-License-Identifier: Apache-2.0 */
/* .splat: 32 bytes per Gaussian, without a header. Position and linear scale are three floats each; red, green, blue,
 * opacity and the rotation w x y z (128 + 128 q) are bytes. Viewers draw Gaussians in the order of the file while they
 * load. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "host/little_floats.h"
#include "host/reason.h"
#include "scene/formats/byte_codes.h"
#include "scene/scene_format.h"

enum { ROW_BYTES = 32, SCALE_AT = 12, COLOUR_AT = 24, OPACITY_AT = 27, ROTATION_AT = 28 };

static int read_row(void *user, uint32_t index, scene_row *row, char *error, size_t error_bytes)
{
    const uint8_t *bytes = (const uint8_t *)user + (size_t)index * ROW_BYTES;
    *row = (scene_row){.opacity_logit = logit_of_byte(bytes[OPACITY_AT])};
    for (int i = 0; i < 3; i++) {
        const double scale = t3r_load_float(bytes + SCALE_AT + 4 * i);
        row->position[i] = t3r_load_float(bytes + 4 * i);
        row->harmonic[i] = (bytes[COLOUR_AT + i] / 255.0 - 0.5) / HARMONICS_ZERO;
        row->log_scale[i] = log(scale);
        if (!isfinite(row->position[i]) || !isfinite(scale) || scale < 0) {
            return t3r_reason(error, error_bytes,
                              "byte %zu: Gaussian %" PRIu32 ": a position that is not finite, or a scale below 0",
                              (size_t)index * ROW_BYTES, index);
        }
    }
    for (int i = 0; i < 4; i++) {
        row->rotation[i] = (bytes[ROTATION_AT + i] - 128) / 128.0;
    }
    return 0;
}

static int splat_parse(const uint8_t *bytes, size_t count, const scene_sink *sink, char *error, size_t error_bytes)
{
    if (count == 0 || count % ROW_BYTES != 0 || count / ROW_BYTES > T3R_MAX_GAUSSIANS) {
        return t3r_reason(error, error_bytes, "%zu bytes are not those of 1..%u Gaussians, 32 each", count,
                          T3R_MAX_GAUSSIANS);
    }
    const scene_rows rows = {
        .count = (uint32_t)(count / ROW_BYTES), .read = read_row, .user = (void *)(uintptr_t)bytes};
    return sink->take(sink->user, &rows, error, error_bytes);
}

typedef struct ranked {
    double rank;
    uint32_t index;
} ranked;

/* Sorts the Gaussians that cover most to the front; ties keep the scene's order. */
static int compare_ranks(const void *a, const void *b)
{
    const ranked *x = a, *y = b;
    return x->rank != y->rank ? (x->rank < y->rank) - (x->rank > y->rank)
                              : (x->index > y->index) - (x->index < y->index);
}

static double rank_of(const scene_row *row)
{
    return row->log_scale[0] + row->log_scale[1] + row->log_scale[2] + log(scene_row_opacity(row));
}

/* Writes w x y z as bytes 128 + 128 q. +1 has no byte, so the equivalent quaternion whose largest component is negative
 * is written. */
static void put_rotation(uint8_t *bytes, const double rotation[4])
{
    int largest = 0;
    for (int i = 1; i < 4; i++) {
        largest = fabs(rotation[i]) > fabs(rotation[largest]) ? i : largest;
    }
    const double sign = rotation[largest] > 0 ? -1 : 1;
    for (int i = 0; i < 4; i++) {
        bytes[i] = byte_of(128 + 128 * sign * rotation[i]);
    }
}

static int splat_write(FILE *file, const scene_source *source, char *error, size_t error_bytes)
{
    const uint32_t count = source->rows->count;
    ranked *order = malloc((count + (size_t)1) * sizeof *order);
    if (order == NULL) {
        return t3r_reason(error, error_bytes, "out of memory for %" PRIu32 " Gaussians", count);
    }
    scene_row row;
    for (uint32_t i = 0; i < count; i++) {
        scene_source_row(source, i, &row);
        order[i] = (ranked){rank_of(&row), i};
    }
    qsort(order, count, sizeof *order, compare_ranks);
    for (uint32_t i = 0; i < count; i++) {
        uint8_t bytes[ROW_BYTES];
        scene_source_row(source, order[i].index, &row);
        for (int k = 0; k < 3; k++) {
            t3r_store_float(bytes + 4 * k, row.position[k]);
            t3r_store_float(bytes + SCALE_AT + 4 * k, exp(row.log_scale[k]));
            bytes[COLOUR_AT + k] = byte_of(255 * scene_row_colour(&row, k));
        }
        bytes[OPACITY_AT] = byte_of(255 * scene_row_opacity(&row));
        put_rotation(bytes + ROTATION_AT, row.rotation);
        fwrite(bytes, 1, sizeof bytes, file);
    }
    free(order);
    return 0;
}

const scene_format scene_format_splat = {
    .suffix = ".splat", .colour = {0, 1}, .parse = splat_parse, .write = splat_write};
