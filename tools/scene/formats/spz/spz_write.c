/* SPDX-License-Identifier: Apache-2.0 */
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <zstd.h>

#include "core/little_endian.h"
#include "host/reason.h"
#include "scene/formats/byte_codes.h"
#include "scene/formats/spz/spz.h"

enum {
    FRACTION_BITS_MOST = 23, /* 24 bits then still hold one unit */
    PACKING_LEVEL = 9,       /* Zstandard's level: close to the smallest result, and fast */
    STEPS_OF_DEGREE_1 = 8,   /* in 1/128: the reference writer keeps 5 bits of degree 1 ... */
    STEPS_BEYOND = 16        /* ... and 4 of the others */
};

typedef struct packed_stream {
    uint8_t *bytes;
    size_t count;
} packed_stream;

/* Returns as many of 23 fraction bits as the farthest coordinate allows; -1: it does not fit at all. */
static int choose_fraction(const scene_source *source)
{
    double farthest = 0;
    for (uint32_t i = 0; i < source->rows->count; i++) {
        scene_row row;
        scene_source_row(source, i, &row);
        farthest = fmax(farthest, fmax(fmax(fabs(row.position[0]), fabs(row.position[1])), fabs(row.position[2])));
    }
    int bits = FRACTION_BITS_MOST;
    while (bits >= 0 && ldexp(farthest, bits) > 0x7fffff) {
        bits--;
    }
    return bits;
}

static void put_position(uint8_t *bytes, double position, uint32_t fraction_bits)
{
    const uint32_t steps = (uint32_t)(int32_t)nearbyint(ldexp(position, (int)fraction_bits));
    bytes[0] = (uint8_t)steps;
    bytes[1] = (uint8_t)(steps >> 8);
    bytes[2] = (uint8_t)(steps >> 16);
}

/* Writes a rotation as spz_read.c reads it. */
static void put_rotation(uint8_t *bytes, const double rotation[4])
{
    const double xyzw[4] = {rotation[1], rotation[2], rotation[3], rotation[0]};
    uint32_t largest = 0;
    for (uint32_t i = 1; i < 4; i++) {
        largest = fabs(xyzw[i]) > fabs(xyzw[largest]) ? i : largest;
    }
    uint32_t word = largest;
    for (uint32_t i = 0; i < 4; i++) {
        if (i != largest) {
            const double size = nearbyint(fabs(xyzw[i]) * (511 * M_SQRT2));
            const bool negative = (xyzw[i] < 0) != (xyzw[largest] < 0);
            word = word << 10 | (negative ? 512u : 0u) | (size < 511 ? (uint32_t)size : 511u);
        }
    }
    t3r_store_le32(bytes, word);
}

/* Returns 128 + 128 x the coefficient, rounded to a multiple of `step` steps of 1/128. */
static uint8_t harmonic_byte(double value, int step)
{
    return byte_of(nearbyint(value * 128 / step) * step + 128);
}

static void put_row(const scene_row *row, const spz_layout *layout, int stream, uint8_t *out)
{
    const uint32_t rest = harmonics_rest(layout->degree);
    switch (stream) {
    case SPZ_POSITIONS:
        for (int i = 0; i < 3; i++) {
            put_position(out + 3 * i, row->position[i], layout->fraction_bits);
        }
        return;
    case SPZ_ALPHAS:
        *out = byte_of(255 * scene_row_opacity(row));
        return;
    case SPZ_COLOURS:
        for (int i = 0; i < 3; i++) {
            out[i] = byte_of(255 * (0.5 + SPZ_COLOUR_SCALE * row->harmonic[i]));
        }
        return;
    case SPZ_SCALES:
        for (int i = 0; i < 3; i++) {
            out[i] = byte_of((row->log_scale[i] - SPZ_SCALE_LEAST) * SPZ_SCALE_STEPS);
        }
        return;
    case SPZ_ROTATIONS:
        put_rotation(out, row->rotation);
        return;
    default:
        for (uint32_t i = 0; i < 3 * rest; i++) {
            out[i] = harmonic_byte(row->rest[i / 3][i % 3], i < 9 ? STEPS_OF_DEGREE_1 : STEPS_BEYOND);
        }
    }
}

/* Fills all streams in one pass over the scene, then compresses them. Returns 0, or -1 without memory. */
static int pack_streams(const scene_source *source, const spz_layout *layout, int stream_count, packed_stream *out)
{
    uint8_t *bytes[SPZ_STREAMS] = {NULL};
    bool is_made = true;
    for (int k = 0; k < stream_count; k++) {
        bytes[k] = malloc((size_t)layout->count * spz_stream_bytes(layout, k) + 1);
        is_made = is_made && bytes[k] != NULL;
    }
    for (uint32_t i = 0; i < layout->count && is_made; i++) {
        scene_row row;
        scene_source_row(source, i, &row);
        for (int k = 0; k < stream_count; k++) {
            put_row(&row, layout, k, bytes[k] + (size_t)i * spz_stream_bytes(layout, k));
        }
    }
    for (int k = 0; k < stream_count; k++) {
        const size_t size = (size_t)layout->count * spz_stream_bytes(layout, k), most = ZSTD_compressBound(size);
        out[k].bytes = is_made ? malloc(most) : NULL;
        is_made = out[k].bytes != NULL;
        out[k].count = is_made ? ZSTD_compress(out[k].bytes, most, bytes[k], size, PACKING_LEVEL) : 0;
        is_made = is_made && !ZSTD_isError(out[k].count);
        free(bytes[k]);
    }
    return is_made ? 0 : -1;
}

static void write_packed(FILE *file, const spz_layout *layout, const packed_stream *streams, int stream_count)
{
    uint8_t header[SPZ_HEADER_BYTES] = SPZ_MAGIC;
    t3r_store_le32(header + SPZ_VERSION_AT, layout->version);
    t3r_store_le32(header + SPZ_COUNT_AT, layout->count);
    header[SPZ_DEGREE_AT] = (uint8_t)layout->degree;
    header[SPZ_FRACTION_AT] = (uint8_t)layout->fraction_bits;
    header[SPZ_FLAGS_AT] = (uint8_t)layout->flags;
    header[SPZ_STREAMS_AT] = (uint8_t)stream_count;
    t3r_store_le32(header + SPZ_TABLE_AT, SPZ_HEADER_BYTES);
    fwrite(header, 1, sizeof header, file);
    for (int i = 0; i < stream_count; i++) {
        uint8_t entry[SPZ_ENTRY_BYTES];
        t3r_store_le64(entry, streams[i].count);
        t3r_store_le64(entry + 8, (uint64_t)layout->count * spz_stream_bytes(layout, i));
        fwrite(entry, 1, sizeof entry, file);
    }
    for (int i = 0; i < stream_count; i++) {
        fwrite(streams[i].bytes, 1, streams[i].count, file);
    }
}

int spz_write(FILE *file, const scene_source *source, char *error, size_t error_bytes)
{
    const int fraction_bits = choose_fraction(source);
    if (fraction_bits < 0) {
        return t3r_reason(error, error_bytes, "positions of 2^23 world units and more have no place in an .spz");
    }
    const spz_layout layout = {SPZ_VERSION, source->rows->count, source->degree, (uint32_t)fraction_bits,
                               source->rows->mip ? SPZ_FLAG_MIP : 0};
    const int stream_count = source->degree > 0 ? SPZ_STREAMS : SPZ_HARMONICS;
    packed_stream streams[SPZ_STREAMS] = {0};
    const int result = pack_streams(source, &layout, stream_count, streams);
    if (result == 0) {
        write_packed(file, &layout, streams, stream_count);
    } else {
        (void)t3r_reason(error, error_bytes, "out of memory for %" PRIu32 " Gaussians", layout.count);
    }
    for (int i = 0; i < SPZ_STREAMS; i++) {
        free(streams[i].bytes);
    }
    return result;
}
