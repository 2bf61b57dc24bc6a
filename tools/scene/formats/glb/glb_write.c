/* SPDX-License-Identifier: Apache-2.0 */
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "core/little_endian.h"
#include "host/little_floats.h"
#include "host/reason.h"
#include "scene/formats/byte_codes.h"
#include "scene/formats/glb/glb.h"
#include "scene/formats/json_stream.h"

/* One attribute after the other. COLOR_0 is last: programs that do not know Gaussians draw points from it. */
typedef struct glb_layout {
    uint32_t count;
    uint32_t attributes; /* without COLOR_0 */
    double low[3], high[3];
} glb_layout;

enum { SHORTS_BYTES = 8, COLOUR_BYTES = 4, VERTEX_ATTRIBUTES = 34962 };

/* Returns an attribute's bytes: rotations are four shorts, all others floats. */
static uint32_t bytes_of(uint32_t attribute)
{
    return attribute == GLB_ROTATION ? SHORTS_BYTES : 4 * glb_components(attribute);
}

static uint64_t binary_bytes(const glb_layout *layout)
{
    uint64_t each = COLOUR_BYTES;
    for (uint32_t i = 0; i < layout->attributes; i++) {
        each += bytes_of(i);
    }
    return each * layout->count;
}

/* Returns the bytes of the Gaussians' attribute in the binary part; the last one is the colour. */
static uint64_t attribute_bytes(const glb_layout *layout, uint32_t attribute)
{
    return (uint64_t)(attribute == layout->attributes ? COLOUR_BYTES : bytes_of(attribute)) * layout->count;
}

/* Appends the names of the attributes, which are accessors in their order. */
static void put_names(json_stream *json, const glb_layout *layout)
{
    char name[GLB_NAME_BYTES];
    for (uint32_t i = 0; i < layout->attributes; i++) {
        json_stream_put(json, "\"%s\":%" PRIu32 ",", glb_attribute_name(i, name), i);
    }
    json_stream_put(json, "\"COLOR_0\":%" PRIu32, layout->attributes);
}

static void put_views(json_stream *json, const glb_layout *layout)
{
    uint64_t offset = 0;
    for (uint32_t i = 0; i <= layout->attributes; i++) {
        const uint64_t bytes = attribute_bytes(layout, i);
        json_stream_put(json, "%s{\"buffer\":0,\"byteOffset\":%" PRIu64 ",\"byteLength\":%" PRIu64 ",\"target\":%d}",
                        i > 0 ? "," : "", offset, bytes, VERTEX_ATTRIBUTES);
        offset += bytes;
    }
}

/* Appends ,"name":[x,y,z], each the float that is nearest. */
static void put_floats(json_stream *json, const char *name, const double values[3])
{
    const double floats[3] = {(double)(float)values[0], (double)(float)values[1], (double)(float)values[2]};
    json_stream_put(json, ",");
    json_stream_numbers(json, name, floats, 3);
}

static void put_accessors(json_stream *json, const glb_layout *layout)
{
    static const char *const types[] = {[1] = "SCALAR", [3] = "VEC3", [4] = "VEC4"};
    for (uint32_t i = 0; i <= layout->attributes; i++) {
        const bool colour = i == layout->attributes;
        const int component = colour ? GLB_UBYTE : i == GLB_ROTATION ? GLB_SHORT : GLB_FLOAT;
        json_stream_put(json,
                        "%s{\"bufferView\":%" PRIu32 ",\"componentType\":%d,\"count\":%" PRIu32 ",\"type\":\"%s\"%s",
                        i > 0 ? "," : "", i, component, layout->count, types[colour ? 4 : glb_components(i)],
                        component != GLB_FLOAT ? ",\"normalized\":true" : "");
        if (i == GLB_POSITION) {
            put_floats(json, "min", layout->low);
            put_floats(json, "max", layout->high);
        }
        json_stream_put(json, "}");
    }
}

/* Puts the scene's origin where it is in the world. */
static void put_translation(json_stream *json, const scene_source *source)
{
    int64_t turned_q32[3];
    double origin[3];
    scene_turn_origin(&source->turn, source->frame.origin_q32, turned_q32);
    for (int axis = 0; axis < 3; axis++) {
        origin[axis] = ldexp((double)turned_q32[axis], -32);
    }
    json_stream_put(json, ",");
    json_stream_numbers(json, "translation", origin, 3);
}

/* Returns NULL when out of memory. */
static char *make_json(const scene_source *source, const glb_layout *layout)
{
    json_stream json;
    json_stream_begin(&json);
    json_stream_put(&json,
                    "{\"asset\":{\"version\":\"2.0\",\"generator\":\"trim3r\"},\"extensionsUsed\":[\"" GLB_EXTENSION
                    "\"],\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0");
    if ((source->flags & T3R_SCENE_LOCAL) != 0 && (source->flags & T3R_SCENE_COMMENTS) != 0) {
        put_translation(&json, source);
    }
    json_stream_put(&json,
                    "}],\"buffers\":[{\"byteLength\":%" PRIu64
                    "}],\"meshes\":[{\"primitives\":[{\"mode\":0,\"attributes\":{",
                    binary_bytes(layout)); /* mode 0: points */
    put_names(&json, layout);
    json_stream_put(&json, "},\"extensions\":{\"" GLB_EXTENSION
                           "\":{\"kernel\":\"ellipse\",\"colorSpace\":\"srgb_rec709_display\"}}}]}],\"bufferViews\":[");
    put_views(&json, layout);
    json_stream_put(&json, "],\"accessors\":[");
    put_accessors(&json, layout);
    json_stream_put(&json, "]}");
    return json_stream_end(&json);
}

static void put_attribute(const scene_row *row, uint32_t attribute, uint8_t *out)
{
    const double opacity = scene_row_opacity(row);
    double scale[3];
    for (int i = 0; i < 3; i++) {
        scale[i] = exp(row->log_scale[i]);
    }
    if (attribute == GLB_ROTATION) {
        for (int i = 0; i < 4; i++) { /* x y z w */
            t3r_store_le16(out + 2 * i, (uint16_t)(int16_t)nearbyint(32767 * row->rotation[(i + 1) % 4]));
        }
        return;
    }
    const double *values = attribute == GLB_POSITION   ? row->position
                           : attribute == GLB_SCALE    ? scale
                           : attribute == GLB_OPACITY  ? &opacity
                           : attribute == GLB_HARMONIC ? row->harmonic
                                                       : row->rest[attribute - GLB_REST];
    for (uint32_t i = 0; i < glb_components(attribute); i++) {
        t3r_store_float(out + 4 * i, values[i]);
    }
}

/* Converts sRGB, as screens show, to linear light, as COLOR_0 needs. */
static double linear_light(double shown)
{
    return shown <= 0.04045 ? shown / 12.92 : pow((shown + 0.055) / 1.055, 2.4);
}

static void put_colour(const scene_row *row, uint8_t *out)
{
    for (int i = 0; i < 3; i++) {
        out[i] = byte_of(255 * linear_light(fmin(fmax(scene_row_colour(row, i), 0), 1)));
    }
    out[3] = byte_of(255 * scene_row_opacity(row));
}

/* Returns all numbers, made in one pass over the scene; free() them. NULL: out of memory. */
static uint8_t *make_numbers(const scene_source *source, const glb_layout *layout)
{
    uint8_t *bytes = malloc((size_t)binary_bytes(layout) + 1);
    for (uint32_t i = 0; i < layout->count && bytes != NULL; i++) {
        scene_row row;
        uint8_t *at = bytes;
        scene_source_row(source, i, &row);
        for (uint32_t attribute = 0; attribute < layout->attributes; attribute++) {
            put_attribute(&row, attribute, at + (size_t)i * bytes_of(attribute));
            at += (size_t)layout->count * bytes_of(attribute);
        }
        put_colour(&row, at + (size_t)i * COLOUR_BYTES);
    }
    return bytes;
}

static glb_layout layout_of(const scene_source *source)
{
    glb_layout layout = {.count = source->rows->count, .attributes = GLB_REST + harmonics_rest(source->degree)};
    for (uint32_t i = 0; i < layout.count; i++) {
        scene_row row;
        scene_source_row(source, i, &row);
        for (int axis = 0; axis < 3; axis++) {
            layout.low[axis] = i == 0 ? row.position[axis] : fmin(layout.low[axis], row.position[axis]);
            layout.high[axis] = i == 0 ? row.position[axis] : fmax(layout.high[axis], row.position[axis]);
        }
    }
    return layout;
}

static void write_chunk_header(FILE *file, uint64_t length, uint32_t kind)
{
    uint8_t bytes[GLB_CHUNK_BYTES];
    t3r_store_le32(bytes, (uint32_t)length);
    t3r_store_le32(bytes + 4, kind);
    fwrite(bytes, 1, sizeof bytes, file);
}

static void write_file(FILE *file, const char *json, const uint8_t *numbers, uint64_t number_bytes, uint64_t whole)
{
    const size_t text = strlen(json), padding = (4 - text % 4) % 4;
    uint8_t header[GLB_HEADER_BYTES] = GLB_MAGIC;
    t3r_store_le32(header + GLB_VERSION_AT, GLB_VERSION);
    t3r_store_le32(header + GLB_LENGTH_AT, (uint32_t)whole);
    fwrite(header, 1, sizeof header, file);
    write_chunk_header(file, text + padding, GLB_JSON);
    fwrite(json, 1, text, file);
    fwrite("   ", 1, padding, file);
    write_chunk_header(file, number_bytes, GLB_BINARY);
    fwrite(numbers, 1, (size_t)number_bytes, file);
}

int glb_write(FILE *file, const scene_source *source, char *error, size_t error_bytes)
{
    enum { JSON_BYTES_MOST = 65536 }; /* enough for 20 attributes */
    const glb_layout layout = layout_of(source);
    const uint64_t number_bytes = binary_bytes(&layout); /* a multiple of 4, as all attributes are */
    if (number_bytes > UINT32_MAX - JSON_BYTES_MOST) {
        return t3r_reason(error, error_bytes, "%" PRIu64 " bytes: a .glb ends at 4 GiB", number_bytes);
    }
    char *json = make_json(source, &layout);
    uint8_t *numbers = make_numbers(source, &layout);
    const bool is_made = json != NULL && numbers != NULL;
    if (is_made) {
        const uint64_t text = (strlen(json) + 3) / 4 * 4;
        write_file(file, json, numbers, number_bytes, GLB_HEADER_BYTES + 2 * GLB_CHUNK_BYTES + text + number_bytes);
    }
    free(json);
    free(numbers);
    return is_made ? 0 : t3r_reason(error, error_bytes, "out of memory for %" PRIu32 " Gaussians", layout.count);
}
