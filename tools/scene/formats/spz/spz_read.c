/* SPDX-License-Identifier: Apache-2.0 */
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "core/little_endian.h"
#include "host/reason.h"
#include "mcap/reader_limits.h"
#include "scene/formats/byte_codes.h"
#include "scene/formats/spz/spz_file.h"

uint32_t spz_stream_bytes(const spz_layout *layout, int stream)
{
    static const uint32_t bytes[] = {
        [SPZ_POSITIONS] = 9, [SPZ_ALPHAS] = 1, [SPZ_COLOURS] = 3, [SPZ_SCALES] = 3, [SPZ_ROTATIONS] = 4};
    return stream == SPZ_HARMONICS                           ? 3 * harmonics_rest(layout->degree)
           : stream == SPZ_POSITIONS && layout->version == 1 ? 6
           : stream == SPZ_ROTATIONS && layout->version <= 2 ? 3
                                                             : bytes[stream];
}

/* ---- Gaussians --------------------------------------------------------------------------------------------------- */

/* Converts a float of 16 bits (IEEE 754). */
static double half_of(uint32_t bits)
{
    const uint32_t exponent = bits >> 10 & 31, fraction = bits & 1023;
    const double size = exponent == 31 ? (fraction == 0 ? INFINITY : NAN)
                        : exponent > 0 ? ldexp(1024 + fraction, (int)exponent - 25)
                                       : ldexp(fraction, -24);
    return (bits & 0x8000) != 0 ? -size : size;
}

static double position_of(const uint8_t *bytes, const spz_layout *layout)
{
    if (layout->version == 1) {
        return half_of(t3r_load_le16(bytes));
    }
    const uint32_t low = (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16;
    return ldexp((double)((int32_t)(low << 8) >> 8), -(int)layout->fraction_bits);
}

/* Reads x y z from bytes; computes w. */
static void read_three(const uint8_t *bytes, double rotation[4])
{
    double left = 1;
    for (int i = 0; i < 3; i++) {
        rotation[1 + i] = bytes[i] / 127.5 - 1;
        left -= rotation[1 + i] * rotation[1 + i];
    }
    rotation[0] = sqrt(fmax(left, 0));
}

/* Reads the index of the largest of x y z w from the highest two bits, then sign and nine bits of each of the others,
 * the last one lowest. */
static void read_smallest(const uint8_t *bytes, double rotation[4])
{
    uint32_t word = t3r_load_le32(bytes);
    const uint32_t largest = word >> 30;
    double left = 1;
    for (uint32_t i = 4; i-- > 0;) {
        if (i != largest) {
            const double size = (word & 511) / 511.0 * M_SQRT1_2;
            rotation[(i + 1) % 4] = (word & 512) != 0 ? -size : size;
            left -= size * size;
            word >>= 10;
        }
    }
    rotation[(largest + 1) % 4] = sqrt(fmax(left, 0));
}

static int read_row(void *user, uint32_t index, scene_row *row, char *error, size_t error_bytes)
{
    (void)error;
    (void)error_bytes;
    const spz_file *file = user;
    const uint8_t *at[SPZ_STREAMS];
    for (int i = 0; i < SPZ_STREAMS; i++) {
        at[i] = file->streams[i] + (size_t)index * spz_stream_bytes(&file->layout, i);
    }
    *row = (scene_row){.opacity_logit = logit_of_byte(*at[SPZ_ALPHAS])};
    for (int i = 0; i < 3; i++) {
        row->position[i] = position_of(at[SPZ_POSITIONS] + (file->layout.version == 1 ? 2 : 3) * i, &file->layout);
        row->harmonic[i] = (at[SPZ_COLOURS][i] / 255.0 - 0.5) / SPZ_COLOUR_SCALE;
        row->log_scale[i] = at[SPZ_SCALES][i] / SPZ_SCALE_STEPS + SPZ_SCALE_LEAST;
    }
    (file->layout.version <= 2 ? read_three : read_smallest)(at[SPZ_ROTATIONS], row->rotation);
    const uint32_t rest = harmonics_rest(file->layout.degree);
    for (uint32_t i = 0; i < (rest < HARMONICS_REST_MOST ? rest : HARMONICS_REST_MOST); i++) {
        for (int channel = 0; channel < 3; channel++) {
            row->rest[i][channel] = (at[SPZ_HARMONICS][3 * i + (uint32_t)channel] - 128) / 128.0;
        }
    }
    return 0;
}

int spz_take_rows(spz_file *file, const scene_sink *sink, char *error, size_t error_bytes)
{
    const uint32_t degree = file->layout.degree;
    const scene_rows rows = {.count = file->layout.count,
                             .degree = degree < HARMONICS_DEGREE_MOST ? degree : HARMONICS_DEGREE_MOST,
                             .axes = file->axes,
                             .remark = degree > HARMONICS_DEGREE_MOST ? SCENE_REMARK_DEGREE_4 : NULL,
                             .mip = (file->layout.flags & SPZ_FLAG_MIP) != 0,
                             .read = read_row,
                             .user = file};
    return sink->take(sink->user, &rows, error, error_bytes);
}

/* ---- containers -------------------------------------------------------------------------------------------------- */

int spz_read_header(const uint8_t *bytes, uint64_t packed, spz_layout *out, char *error, size_t error_bytes)
{
    *out = (spz_layout){.version = t3r_load_le32(bytes + SPZ_VERSION_AT),
                        .count = t3r_load_le32(bytes + SPZ_COUNT_AT),
                        .degree = bytes[SPZ_DEGREE_AT],
                        .fraction_bits = bytes[SPZ_FRACTION_AT],
                        .flags = bytes[SPZ_FLAGS_AT]};
    if (out->degree > SPZ_DEGREE_MOST || out->fraction_bits > 30) {
        return t3r_reason(error, error_bytes,
                          "byte %d: harmonics of degree %" PRIu32 ", positions of %" PRIu32 " fraction bits",
                          SPZ_DEGREE_AT, out->degree, out->fraction_bits);
    }
    if (out->count == 0 || out->count > t3r_limit_gaussians(packed)) {
        return t3r_reason(error, error_bytes,
                          "byte %d: %" PRIu32 " Gaussians; 1..%" PRIu64 " are read from %" PRIu64 " bytes",
                          SPZ_COUNT_AT, out->count, t3r_limit_gaussians(packed), packed);
    }
    return 0;
}

size_t spz_whole_bytes(const spz_layout *layout)
{
    size_t bytes = 0;
    for (int i = 0; i < SPZ_STREAMS; i++) {
        bytes += (size_t)layout->count * spz_stream_bytes(layout, i);
    }
    return bytes;
}

void spz_find_streams(spz_file *file, const uint8_t *bytes)
{
    for (int i = 0; i < SPZ_STREAMS; i++) {
        file->streams[i] = bytes;
        bytes += (size_t)file->layout.count * spz_stream_bytes(&file->layout, i);
    }
}

int spz_check_old(const spz_layout *layout, char *error, size_t error_bytes)
{
    return layout->version >= 1 && layout->version < SPZ_VERSION
               ? 0
               : t3r_reason(error, error_bytes, "byte %d: version %" PRIu32 "; 1 to 4 are read", SPZ_VERSION_AT,
                            layout->version);
}

int spz_open(const uint8_t *bytes, size_t count, spz_file *file, char *error, size_t error_bytes)
{
    *file = (spz_file){.axes = SCENE_AXES_RUB};
    if (count < SPZ_HEADER_BYTES || memcmp(bytes, SPZ_MAGIC, 4) != 0) {
        return t3r_reason(error, error_bytes, "byte 0: not an .spz file");
    }
    return spz_read_header(bytes, count, &file->layout, error, error_bytes);
}

int spz_parse_bare(const uint8_t *bytes, size_t count, spz_file *file, const scene_sink *sink, char *error,
                   size_t error_bytes)
{
    if (spz_check_old(&file->layout, error, error_bytes) != 0) {
        return -1;
    }
    const size_t size = SPZ_OLD_HEADER_BYTES + spz_whole_bytes(&file->layout);
    if (count < size) {
        return t3r_reason(error, error_bytes, "byte %zu: cut off: %" PRIu32 " Gaussians end at byte %zu", count,
                          file->layout.count, size);
    }
    spz_find_streams(file, bytes + SPZ_OLD_HEADER_BYTES);
    return spz_take_rows(file, sink, error, error_bytes);
}

/* Reads the extensions between the header and the table: of those known, the axes change what is read. */
static int read_extensions(const uint8_t *bytes, uint64_t end, spz_file *file, char *error, size_t error_bytes)
{
    uint64_t at = SPZ_HEADER_BYTES;
    while ((file->layout.flags & SPZ_FLAG_EXTENSIONS) != 0 && at < end) {
        const uint64_t size = end - at < SPZ_EXTENSION_BYTES ? UINT32_MAX : t3r_load_le32(bytes + at + 4);
        if (size > end - at - SPZ_EXTENSION_BYTES) {
            return t3r_reason(error, error_bytes, "byte %" PRIu64 ": an extension reaches beyond the others", at);
        }
        if (t3r_load_le32(bytes + at) == SPZ_EXTENSION_AXES && size >= 4) {
            const uint32_t axes = t3r_load_le32(bytes + at + SPZ_EXTENSION_BYTES);
            if (axes > SCENE_AXES_LAST) {
                return t3r_reason(error, error_bytes, "byte %" PRIu64 ": axes %" PRIu32 "; 1 to %d are known", at, axes,
                                  SCENE_AXES_LAST);
            }
            file->axes = axes > 0 ? (scene_axes)axes : SCENE_AXES_RUB;
        }
        at += SPZ_EXTENSION_BYTES + size;
    }
    return 0;
}

int spz_find_packed(const uint8_t *bytes, size_t count, spz_file *file, spz_stream streams[SPZ_STREAMS], char *error,
                    size_t error_bytes)
{
    const uint64_t table = t3r_load_le32(bytes + SPZ_TABLE_AT);
    const uint32_t listed = bytes[SPZ_STREAMS_AT];
    const uint32_t needed = file->layout.degree > 0 ? SPZ_STREAMS : SPZ_HARMONICS;
    uint64_t at = table + (uint64_t)listed * SPZ_ENTRY_BYTES;
    if (listed < needed || table < SPZ_HEADER_BYTES || at > count) {
        return t3r_reason(error, error_bytes, "byte %d: %" PRIu32 " streams, their table at byte %" PRIu64,
                          SPZ_STREAMS_AT, listed, table);
    }
    if (read_extensions(bytes, table, file, error, error_bytes) != 0) {
        return -1;
    }
    for (uint32_t i = 0; i < needed; i++) {
        const uint64_t packed = t3r_load_le64(bytes + table + i * SPZ_ENTRY_BYTES);
        if (packed > count - at) {
            return t3r_reason(error, error_bytes, "byte %zu: cut off in stream %" PRIu32, count, i);
        }
        streams[i] = (spz_stream){(size_t)at, (size_t)packed};
        at += packed;
    }
    return (int)needed;
}
