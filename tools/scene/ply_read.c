/* 3DGS .ply, binary little-endian. The header is text from anywhere: every line, count and offset is checked. */
#include "scene/ply.h"

#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reason.h"
#include "scene/scene_rows.h"

#define MAX_HEADER_BYTES 65536u
#define MAX_LINE_BYTES 512u
#define MAX_ROW_BYTES 8192u
/* What is read of each vertex, in this order in `offset` and `value`. */
enum { X, Y, Z, DC_0, DC_1, DC_2, OPACITY, SCALE_0, SCALE_1, SCALE_2, ROT_0, ROT_1, ROT_2, ROT_3, WANTED_COUNT };
static const char *const wanted[WANTED_COUNT] = {"x",      "y",       "z",       "f_dc_0",  "f_dc_1",
                                                 "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2",
                                                 "rot_0",  "rot_1",   "rot_2",   "rot_3"};

typedef struct ply_header {
    size_t data;    /* byte offset of the first element */
    uint64_t skip;  /* bytes of elements before the vertices */
    uint32_t count; /* vertices */
    size_t row_bytes;
    size_t offset[WANTED_COUNT]; /* in a row */
    bool found[WANTED_COUNT];
    bool wide[WANTED_COUNT]; /* double instead of float */
    bool has_exponent, has_origin, local;
    t3r_scene_frame frame; /* as comments name it */
} ply_header;

typedef struct reader {
    const uint8_t *bytes;
    size_t count;
    char *error;
    size_t error_bytes;
} reader;

typedef struct ply_vertices {
    const uint8_t *bytes; /* of the file */
    const ply_header *header;
} ply_vertices;

#define FAIL(r, ...) t3r_reason((r)->error, (r)->error_bytes, __VA_ARGS__)

/* ---- header --------------------------------------------------------------------------------------------- */

/* The line at *at without its end; *at moves behind it. -1 when none is left or it is over-long. */
static int next_line(const reader *r, size_t *at, char line[MAX_LINE_BYTES])
{
    size_t limit = r->count < MAX_HEADER_BYTES ? r->count : MAX_HEADER_BYTES;
    size_t start = *at, end = start;
    while (end < limit && r->bytes[end] != '\n') {
        end++;
    }
    if (end == limit || end - start >= MAX_LINE_BYTES) {
        return FAIL(r, "byte %zu: %s", start, end == limit ? "the header has no end" : "a header line is too long");
    }
    size_t length = end - start;
    if (length > 0 && r->bytes[end - 1] == '\r') {
        length--;
    }
    if (memchr(r->bytes + start, 0, length) != NULL) {
        return FAIL(r, "byte %zu: a zero byte in the header", start);
    }
    memcpy(line, r->bytes + start, length);
    line[length] = '\0';
    *at = end + 1;
    return 0;
}

static size_t type_bytes(const char *name)
{
    static const struct {
        const char *name;
        size_t bytes;
    } types[] = {{"char", 1},   {"int8", 1},    {"uchar", 1},  {"uint8", 1},  {"short", 2}, {"int16", 2},
                 {"ushort", 2}, {"uint16", 2},  {"int", 4},    {"int32", 4},  {"uint", 4},  {"uint32", 4},
                 {"float", 4},  {"float32", 4}, {"double", 8}, {"float64", 8}};
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        if (strcmp(name, types[i].name) == 0) {
            return types[i].bytes;
        }
    }
    return 0;
}

static void read_comment(const char *line, ply_header *h)
{
    int local, end = 0;
    int32_t exponent;
    int64_t *origin = h->frame.origin_q32;
    if (sscanf(line, "comment trim3r exponent %" SCNd32 "%n", &exponent, &end) == 1 && line[end] == '\0') {
        h->frame.exponent = exponent;
        h->has_exponent = true;
    } else if (sscanf(line, "comment trim3r origin_q32 %" SCNd64 " %" SCNd64 " %" SCNd64 "%n", &origin[0], &origin[1],
                      &origin[2], &end) == 3 &&
               line[end] == '\0') {
        h->has_origin = true;
    } else if (sscanf(line, "comment trim3r local %d%n", &local, &end) == 1 && line[end] == '\0') {
        h->local = local != 0;
    }
}

static int read_property(const reader *r, size_t at, const char *line, ply_header *h, bool in_vertex, size_t *row)
{
    char type[32], name[64];
    int end = 0;
    if (sscanf(line, "property %31s %63s%n", type, name, &end) != 2 || line[end] != '\0') {
        return FAIL(r, "byte %zu: '%.80s' is no property that can be read%s", at, line,
                    strncmp(line, "property list", 13) == 0 ? " (lists are not)" : "");
    }
    size_t bytes = type_bytes(type);
    if (bytes == 0) {
        return FAIL(r, "byte %zu: unknown property type '%s'", at, type);
    }
    if (*row + bytes > MAX_ROW_BYTES) {
        return FAIL(r, "byte %zu: an element of over %u bytes", at, MAX_ROW_BYTES);
    }
    for (int i = 0; in_vertex && i < WANTED_COUNT; i++) {
        if (strcmp(name, wanted[i]) != 0) {
            continue;
        }
        if (h->found[i] || type[0] == 'i' || type[0] == 'u' || bytes < 4) {
            return FAIL(r, "byte %zu: property %s %s", at, name,
                        h->found[i] ? "comes twice" : "is not a float or double");
        }
        h->found[i] = true;
        h->offset[i] = *row;
        h->wide[i] = bytes == 8;
    }
    *row += bytes;
    return 0;
}

/* Where the header's reader stands. */
typedef struct header_walk {
    bool has_format, has_vertex, in_vertex, any_element;
    uint64_t element_count; /* of the element being read */
    size_t row;             /* bytes of one of them */
} header_walk;

static void end_element(const header_walk *w, ply_header *h)
{
    if (w->in_vertex) {
        h->row_bytes = w->row;
    } else if (w->any_element && !w->has_vertex) {
        h->skip += w->element_count * w->row; /* below 2^24 x 2^13 each, and below 2^13 of them fit the header */
    }
}

static int begin_element(const reader *r, size_t at, const char *line, header_walk *w, ply_header *h)
{
    char name[64];
    int end = 0;
    if (sscanf(line, "element %63s %" SCNu64 "%n", name, &w->element_count, &end) != 2 || line[end] != '\0' ||
        strchr(line, '-') != NULL) {
        return FAIL(r, "byte %zu: '%.80s' is no element", at, line);
    }
    if (w->element_count > T3R_MAX_GAUSSIANS) {
        return FAIL(r, "byte %zu: %" PRIu64 " elements '%s' are over the limit of %u", at, w->element_count, name,
                    T3R_MAX_GAUSSIANS);
    }
    if (strcmp(name, "chunk") == 0) {
        return FAIL(r, "byte %zu: packed .ply (SuperSplat) is not read; export it unpacked", at);
    }
    w->in_vertex = strcmp(name, "vertex") == 0;
    if (w->in_vertex && w->has_vertex) {
        return FAIL(r, "byte %zu: a second element vertex", at);
    }
    w->has_vertex = w->has_vertex || w->in_vertex;
    h->count = w->in_vertex ? (uint32_t)w->element_count : h->count;
    w->any_element = true;
    w->row = 0;
    return 0;
}

static int read_header_line(const reader *r, size_t at, const char *line, header_walk *w, ply_header *h)
{
    if (strncmp(line, "element ", 8) == 0) {
        end_element(w, h);
        return begin_element(r, at, line, w, h);
    }
    if (strncmp(line, "property ", 9) == 0) {
        if (!w->any_element) {
            return FAIL(r, "byte %zu: a property before the first element", at);
        }
        /* what follows the vertices is not read, so its properties may be anything */
        return w->in_vertex || !w->has_vertex ? read_property(r, at, line, h, w->in_vertex, &w->row) : 0;
    }
    if (strncmp(line, "format ", 7) == 0) {
        w->has_format = true;
        return strcmp(line, "format binary_little_endian 1.0") == 0
                   ? 0
                   : FAIL(r, "byte %zu: '%.80s': only binary_little_endian 1.0 is read", at, line);
    }
    if (strncmp(line, "comment", 7) == 0) {
        read_comment(line, h);
        return 0;
    }
    return strncmp(line, "obj_info", 8) == 0 ? 0 : FAIL(r, "byte %zu: unknown header line '%.80s'", at, line);
}

static int check_header(const reader *r, const header_walk *w, const ply_header *h)
{
    if (!w->has_format || !w->has_vertex || h->count == 0) {
        return FAIL(r, "%s",
                    !w->has_format   ? "the header names no format"
                    : !w->has_vertex ? "the header names no element vertex"
                                     : "the file holds no Gaussians");
    }
    for (int i = 0; i < WANTED_COUNT; i++) {
        if (!h->found[i]) {
            return FAIL(r, "property %s is missing: not a file of Gaussians", wanted[i]);
        }
    }
    uint64_t need = h->skip + (uint64_t)h->count * h->row_bytes;
    if (r->count - h->data < need) {
        return FAIL(r, "byte %zu: cut off: the header promises %" PRIu64 " bytes of data, %zu are there", r->count,
                    need, r->count - h->data);
    }
    return 0;
}

static int read_header(const reader *r, ply_header *h)
{
    char line[MAX_LINE_BYTES];
    header_walk w = {0};
    size_t at = 0;
    *h = (ply_header){0};
    if (r->count < 4 || memcmp(r->bytes, "ply", 3) != 0 || (r->bytes[3] != '\n' && r->bytes[3] != '\r')) {
        return FAIL(r, "byte 0: not a .ply file");
    }
    if (next_line(r, &at, line) != 0) {
        return -1;
    }
    for (;;) {
        size_t line_at = at;
        if (next_line(r, &at, line) != 0) {
            return -1;
        }
        if (strcmp(line, "end_header") == 0) {
            break;
        }
        if (read_header_line(r, line_at, line, &w, h) != 0) {
            return -1;
        }
    }
    end_element(&w, h);
    h->data = at;
    return check_header(r, &w, h);
}

/* ---- vertices --------------------------------------------------------------------------------------------- */

static double get_number(const uint8_t *bytes, bool wide)
{
    uint64_t bits = 0;
    for (int i = 0; i < (wide ? 8 : 4); i++) {
        bits |= (uint64_t)bytes[i] << (8 * i);
    }
    if (wide) {
        double value;
        memcpy(&value, &bits, sizeof value);
        return value;
    }
    uint32_t narrow = (uint32_t)bits;
    float value;
    memcpy(&value, &narrow, sizeof value);
    return value;
}

static int read_vertex(void *user, uint32_t index, scene_row *row, char *error, size_t error_bytes)
{
    const ply_vertices *vertices = user;
    const ply_header *h = vertices->header;
    double value[WANTED_COUNT];
    size_t at = h->data + (size_t)h->skip + (size_t)index * h->row_bytes;
    for (int i = 0; i < WANTED_COUNT; i++) {
        value[i] = get_number(vertices->bytes + at + h->offset[i], h->wide[i]);
        /* exporters write the logit of opacity 1 or 0, and the logarithm of scale 0, as infinities */
        bool meant = isinf(value[i]) && (i == OPACITY || (i >= SCALE_0 && i <= SCALE_2 && value[i] < 0));
        if (!isfinite(value[i]) && !meant) {
            return t3r_reason(error, error_bytes, "byte %zu: vertex %" PRIu32 ": %s is not a finite number",
                              at + h->offset[i], index, wanted[i]);
        }
    }
    *row = (scene_row){.position = {value[X], value[Y], value[Z]},
                       .harmonic = {value[DC_0], value[DC_1], value[DC_2]},
                       .opacity_logit = value[OPACITY],
                       .log_scale = {value[SCALE_0], value[SCALE_1], value[SCALE_2]},
                       .rotation = {value[ROT_0], value[ROT_1], value[ROT_2], value[ROT_3]}};
    return 0;
}

int ply_parse(const uint8_t *bytes, size_t count, scene_file *out, char *error, size_t error_bytes)
{
    *out = (scene_file){0};
    reader r = {bytes, count, error, error_bytes};
    ply_header h;
    if (read_header(&r, &h) != 0) {
        return -1;
    }
    ply_vertices vertices = {bytes, &h};
    scene_rows rows = {.count = h.count,
                       .has_frame = h.has_exponent && h.has_origin,
                       .local = h.local,
                       .frame = h.frame,
                       .read = read_vertex,
                       .user = &vertices};
    return scene_file_from_rows(&rows, out, error, error_bytes);
}
