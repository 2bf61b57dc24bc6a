/* SPDX-License-Identifier: Apache-2.0 */
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "cli/tables/json_input.h"
#include "core/little_endian.h"
#include "host/little_floats.h"
#include "host/reason.h"
#include "mcap/reader_limits.h"
#include "scene/formats/glb/glb.h"
#include "scene/formats/glb/glb_nodes.h"

typedef struct reader {
    const uint8_t *binary;
    uint32_t binary_bytes;
    char *error;
    size_t error_bytes;
} reader;

#define FAIL(r, ...) t3r_reason((r)->error, (r)->error_bytes, __VA_ARGS__)

/* Rows of numbers within the binary chunk. */
typedef struct accessor {
    const uint8_t *rows;
    uint32_t stride, component, count;
    bool normalized;
} accessor;

typedef struct glb_file {
    accessor attributes[GLB_ATTRIBUTES_MOST];
    uint32_t degree;
    const char *remark; /* as in scene_rows */
    glb_placement placement;
} glb_file;

/* ---- JSON -------------------------------------------------------------------------------------------------------- */

static const cJSON *get(const cJSON *object, const char *name)
{
    return cJSON_GetObjectItemCaseSensitive(object, name);
}

static bool is_text(const cJSON *object, const char *name, const char *text)
{
    const cJSON *item = get(object, name);
    return cJSON_IsString(item) && strcmp(item->valuestring, text) == 0;
}

/* Reads a whole number of 0..2^32 - 1; `missing` is the default. Returns 0, or -1. */
static int get_whole(const reader *r, const cJSON *object, const char *name, double missing, uint32_t *out)
{
    const cJSON *item = get(object, name);
    *out = 0;
    const double value = item == NULL ? missing : cJSON_IsNumber(item) ? item->valuedouble : -1;
    if (!(value >= 0 && value <= UINT32_MAX) || value != floor(value)) {
        return FAIL(r, "%s is missing or is not a whole number", name);
    }
    *out = (uint32_t)value;
    return 0;
}

/* Returns item `index` of an array of the file; NULL: there is none. */
static const cJSON *item_of(const cJSON *root, const char *name, uint32_t index)
{
    const cJSON *array = get(root, name);
    return index > INT32_MAX || !cJSON_IsArray(array) ? NULL : cJSON_GetArrayItem(array, (int)index);
}

static int get_array(const reader *r, const cJSON *object, const char *name, const cJSON **array)
{
    return json_array(object, name, array, r->error, r->error_bytes);
}

/* Finds the only primitive of Gaussians in the file's meshes, and its mesh. */
static int find_primitive(const reader *r, const cJSON *root, const cJSON **primitive, uint32_t *mesh_index)
{
    const cJSON *meshes, *mesh, *primitives, *each;
    uint32_t index = 0;
    *primitive = NULL;
    if (get_array(r, root, "meshes", &meshes) != 0) {
        return -1;
    }
    cJSON_ArrayForEach(mesh, meshes)
    {
        if (get_array(r, mesh, "primitives", &primitives) != 0) {
            return -1;
        }
        cJSON_ArrayForEach(each, primitives)
        {
            if (get(get(each, "extensions"), GLB_EXTENSION) == NULL) {
                continue;
            }
            if (*primitive != NULL) {
                return FAIL(r, "two primitives of Gaussians: files with one are read; export the scene as one .ply");
            }
            *primitive = each;
            *mesh_index = index;
        }
        index++;
    }
    return *primitive != NULL ? 0 : FAIL(r, "no primitive with " GLB_EXTENSION);
}

static int check_extensions(const reader *r, const cJSON *root, const cJSON *primitive)
{
    const cJSON *required, *each, *gaussians = get(get(primitive, "extensions"), GLB_EXTENSION);
    if (get_array(r, root, "extensionsRequired", &required) != 0) {
        return -1;
    }
    cJSON_ArrayForEach(each, required)
    {
        if (!cJSON_IsString(each) || strcmp(each->valuestring, GLB_EXTENSION) != 0) {
            return FAIL(r, "it needs the extension '%s', which is not read; export the scene as .ply or .spz",
                        cJSON_IsString(each) ? each->valuestring : "?");
        }
    }
    if (get(gaussians, "extensions") != NULL) {
        return FAIL(
            r,
            "the Gaussians have an extension of their own, as those packed as SPZ; export the scene as .ply or .spz");
    }
    return is_text(gaussians, "kernel", "ellipse") && is_text(gaussians, "colorSpace", "srgb_rec709_display")
               ? 0
               : FAIL(r, "only the kernel ellipse in the colour space srgb_rec709_display is read");
}

/* ---- numbers ----------------------------------------------------------------------------------------------------- */

static uint32_t bytes_of(uint32_t component)
{
    return component == GLB_BYTE || component == GLB_UBYTE     ? 1
           : component == GLB_SHORT || component == GLB_USHORT ? 2
           : component == GLB_FLOAT                            ? 4
                                                               : 0;
}

static int read_accessor(const reader *r, const cJSON *root, uint32_t index, uint32_t attribute, accessor *out)
{
    static const char *const types[] = {[1] = "SCALAR", [3] = "VEC3", [4] = "VEC4"};
    const cJSON *it = item_of(root, "accessors", index);
    const uint32_t components = glb_components(attribute);
    uint32_t view_index, offset, view_offset, view_bytes, buffer;
    if (get_whole(r, it, "bufferView", -1, &view_index) != 0 ||
        get_whole(r, it, "componentType", -1, &out->component) != 0 ||
        get_whole(r, it, "count", -1, &out->count) != 0 || get_whole(r, it, "byteOffset", 0, &offset) != 0) {
        return -1;
    }
    const cJSON *view = item_of(root, "bufferViews", view_index);
    const uint32_t size = components * bytes_of(out->component);
    if (get_whole(r, view, "buffer", -1, &buffer) != 0 || get_whole(r, view, "byteOffset", 0, &view_offset) != 0 ||
        get_whole(r, view, "byteLength", -1, &view_bytes) != 0 ||
        get_whole(r, view, "byteStride", size, &out->stride) != 0) {
        return -1;
    }
    if (size == 0 || !is_text(it, "type", types[components]) || get(it, "sparse") != NULL || buffer != 0 ||
        out->stride < size) {
        return FAIL(r, "accessor %" PRIu32 ": a type that is not read", index);
    }
    const uint64_t last = (uint64_t)offset + (uint64_t)out->stride * (out->count - (uint64_t)(out->count > 0)) + size;
    if (out->count == 0 || last > view_bytes || (uint64_t)view_offset + view_bytes > r->binary_bytes) {
        return FAIL(r, "accessor %" PRIu32 ": %" PRIu32 " rows reach beyond the file's numbers", index, out->count);
    }
    out->normalized = cJSON_IsTrue(get(it, "normalized"));
    out->rows = r->binary + view_offset + offset;
    return 0;
}

/* Says what harmonics the reader leaves out; NULL: none. */
static const char *remark_of(const cJSON *attributes, uint32_t degree)
{
    const cJSON *each;
    uint32_t count = 0;
    bool has_more = false; /* a higher degree than the runtime draws */
    cJSON_ArrayForEach(each, attributes)
    {
        count += strncmp(each->string, GLB_EXTENSION ":SH_DEGREE_", sizeof GLB_EXTENSION ":SH_DEGREE_" - 1) == 0;
        has_more = has_more || strcmp(each->string, GLB_EXTENSION ":SH_DEGREE_4_COEF_0") == 0;
    }
    return count <= 1 + harmonics_rest(degree) ? NULL
           : has_more && degree == HARMONICS_DEGREE_MOST
               ? SCENE_REMARK_DEGREE_4
               : "harmonics of a degree that lacks a coefficient are left out";
}

static int find_attributes(const reader *r, const cJSON *root, const cJSON *primitive, glb_file *out)
{
    const cJSON *attributes = get(primitive, "attributes");
    for (uint32_t i = 0; i < GLB_ATTRIBUTES_MOST; i++) {
        char name[GLB_NAME_BYTES];
        uint32_t index;
        if (i >= GLB_REST && get(attributes, glb_attribute_name(i, name)) == NULL) {
            break;
        }
        if (get_whole(r, attributes, glb_attribute_name(i, name), -1, &index) != 0 ||
            read_accessor(r, root, index, i, &out->attributes[i]) != 0) {
            return -1;
        }
        if (out->attributes[i].count != out->attributes[0].count || out->attributes[i].count > T3R_MAX_GAUSSIANS) {
            return FAIL(r, "%s has %" PRIu32 " rows", name, out->attributes[i].count);
        }
        if (out->degree < HARMONICS_DEGREE_MOST && i + 1 == GLB_REST + harmonics_rest(out->degree + 1)) {
            out->degree++;
        }
    }
    out->remark = remark_of(attributes, out->degree);
    return 0;
}

static double number_of(const accessor *a, uint32_t row, uint32_t item)
{
    const uint8_t *bytes = a->rows + (size_t)row * a->stride + (size_t)item * bytes_of(a->component);
    switch (a->component) {
    case GLB_BYTE:
        return a->normalized ? fmax((int8_t)*bytes / 127.0, -1) : (int8_t)*bytes;
    case GLB_UBYTE:
        return a->normalized ? *bytes / 255.0 : *bytes;
    case GLB_SHORT:
        return a->normalized ? fmax((int16_t)t3r_load_le16(bytes) / 32767.0, -1) : (int16_t)t3r_load_le16(bytes);
    case GLB_USHORT:
        return a->normalized ? t3r_load_le16(bytes) / 65535.0 : t3r_load_le16(bytes);
    default:
        return t3r_load_float(bytes);
    }
}

/* Moves a row by the nodes' transform. Returns 0, or -1 if its position overflows. */
static int place_row(const glb_file *file, scene_row *row)
{
    const glb_placement *to = &file->placement;
    scene_turn_apply(&to->turn, row->position, row->rotation, file->degree, row->rest);
    for (int i = 0; i < 3; i++) {
        row->position[i] = row->position[i] * to->scale + to->translation[i];
        row->log_scale[i] += log(to->scale);
        if (!isfinite(row->position[i])) {
            return -1;
        }
    }
    return 0;
}

static int read_row(void *user, uint32_t index, scene_row *row, char *error, size_t error_bytes)
{
    const glb_file *file = user;
    double value[GLB_ATTRIBUTES_MOST][4];
    const uint32_t rest = harmonics_rest(file->degree);
    for (uint32_t i = 0; i < GLB_REST + rest; i++) {
        for (uint32_t k = 0; k < glb_components(i); k++) {
            value[i][k] = number_of(&file->attributes[i], index, k);
            if (!isfinite(value[i][k]) || (i == GLB_SCALE && value[i][k] < 0)) {
                char name[GLB_NAME_BYTES];
                return t3r_reason(error, error_bytes, "Gaussian %" PRIu32 ": %s is %g", index,
                                  glb_attribute_name(i, name), value[i][k]);
            }
        }
    }
    const double opacity = fmin(fmax(value[GLB_OPACITY][0], 0), 1);
    *row = (scene_row){.opacity_logit = log(opacity) - log(1 - opacity)};
    for (int i = 0; i < 3; i++) {
        row->position[i] = value[GLB_POSITION][i];
        row->harmonic[i] = value[GLB_HARMONIC][i];
        row->log_scale[i] = log(value[GLB_SCALE][i]);
        for (uint32_t k = 0; k < rest; k++) {
            row->rest[k][i] = value[GLB_REST + k][i];
        }
    }
    for (int i = 0; i < 4; i++) { /* x y z w */
        row->rotation[(i + 1) % 4] = value[GLB_ROTATION][i];
    }
    return file->placement.none || place_row(file, row) == 0
               ? 0
               : t3r_reason(error, error_bytes, "Gaussian %" PRIu32 ": nodes put it infinitely far away", index);
}

/* ---- containers -------------------------------------------------------------------------------------------------- */

static int parse_json(const reader *r, const cJSON *root, const scene_sink *sink)
{
    const cJSON *primitive;
    uint32_t mesh_index = 0;
    glb_file file = {0};
    if (find_primitive(r, root, &primitive, &mesh_index) != 0 || check_extensions(r, root, primitive) != 0 ||
        glb_find_placement(root, mesh_index, &file.placement, r->error, r->error_bytes) != 0 ||
        find_attributes(r, root, primitive, &file) != 0) {
        return -1;
    }
    const scene_rows rows = {.count = file.attributes[GLB_POSITION].count,
                             .degree = file.degree,
                             .axes = SCENE_AXES_LUF,
                             .remark = file.remark,
                             .read = read_row,
                             .user = &file};
    return sink->take(sink->user, &rows, r->error, r->error_bytes);
}

/* Reads the chunk at *at, which moves past it. */
static int next_chunk(const reader *r, const uint8_t *bytes, size_t count, size_t *at, uint32_t kind,
                      const uint8_t **chunk, uint32_t *length)
{
    if (count - *at < GLB_CHUNK_BYTES || t3r_load_le32(bytes + *at + 4) != kind) {
        return FAIL(r, "byte %zu: the chunk of %s is missing", *at, kind == GLB_JSON ? "JSON" : "numbers");
    }
    *length = t3r_load_le32(bytes + *at);
    if (*length > count - *at - GLB_CHUNK_BYTES) {
        return FAIL(r, "byte %zu: cut off: the chunk at byte %zu has %" PRIu32 " bytes", count, *at, *length);
    }
    *chunk = bytes + *at + GLB_CHUNK_BYTES;
    *at += GLB_CHUNK_BYTES + *length;
    return 0;
}

int glb_parse(const uint8_t *bytes, size_t count, const scene_sink *sink, char *error, size_t error_bytes)
{
    reader r = {NULL, 0, error, error_bytes};
    const uint8_t *text;
    uint32_t text_bytes;
    size_t at = GLB_HEADER_BYTES;
    if (count < GLB_HEADER_BYTES || memcmp(bytes, GLB_MAGIC, 4) != 0 ||
        t3r_load_le32(bytes + GLB_VERSION_AT) != GLB_VERSION) {
        return FAIL(&r, "byte 0: not a .glb of version 2");
    }
    if (next_chunk(&r, bytes, count, &at, GLB_JSON, &text, &text_bytes) != 0 ||
        next_chunk(&r, bytes, count, &at, GLB_BINARY, &r.binary, &r.binary_bytes) != 0) {
        return -1;
    }
    if (text_bytes > T3R_LIMIT_TEXT_BYTES) {
        return FAIL(&r, "byte %d: JSON of %" PRIu32 " bytes; at most %" PRIu32 " are read", GLB_HEADER_BYTES,
                    text_bytes, T3R_LIMIT_TEXT_BYTES);
    }
    cJSON *root = json_parse((const char *)text, text_bytes, error, error_bytes);
    if (root == NULL) {
        return -1;
    }
    const int result = parse_json(&r, root, sink);
    cJSON_Delete(root);
    return result;
}
