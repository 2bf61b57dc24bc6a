/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/formats/ply/ply_header.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "host/reason.h"
#include "scene/formats/ply/ply.h"

#define MAX_HEADER_BYTES 262144u
#define MAX_LINE_BYTES 512u
#define MAX_ROW_BYTES 16384u

typedef struct reader {
    const uint8_t *bytes;
    size_t count;
    char *error;
    size_t error_bytes;
} reader;

#define FAIL(r, ...) t3r_reason((r)->error, (r)->error_bytes, __VA_ARGS__)

static bool is_remark(const char *line)
{
    return strncmp(line, "comment", 7) == 0 || strncmp(line, "obj_info", 8) == 0;
}

/* Replaces runs of blanks by one, and drops those at the end. */
static void trim(char *line)
{
    size_t length = 0;
    for (const char *c = line; *c != '\0'; c++) {
        const bool blank = *c == ' ' || *c == '\t' || *c == '\r';
        if (!blank || (length > 0 && line[length - 1] != ' ')) {
            line[length++] = blank ? ' ' : *c;
        }
    }
    line[length - (length > 0 && line[length - 1] == ' ')] = '\0';
}

/* Reads the line at *at without its end; *at moves past it. Comments may be longer than the line, which then has their
 * beginning. -1 when no line is left or it is too long. */
static int next_line(const reader *r, size_t *at, char line[MAX_LINE_BYTES])
{
    size_t limit = r->count < MAX_HEADER_BYTES ? r->count : MAX_HEADER_BYTES;
    size_t start = *at, end = start;
    while (end < limit && r->bytes[end] != '\n') {
        end++;
    }
    if (end == limit) {
        return FAIL(r, "byte %zu: the header has no end", start);
    }
    const size_t whole = end - start, length = whole < MAX_LINE_BYTES ? whole : MAX_LINE_BYTES - 1;
    if (memchr(r->bytes + start, 0, length) != NULL) {
        return FAIL(r, "byte %zu: a zero byte in the header", start);
    }
    memcpy(line, r->bytes + start, length);
    line[length] = '\0';
    trim(line);
    *at = end + 1;
    return length == whole || is_remark(line) ? 0 : FAIL(r, "byte %zu: a header line is too long", start);
}

/* Reads a comment of Brush or of Postshot on mip-splatting. */
static void read_render_mode(const char *line, ply_header *h)
{
    static const struct {
        const char *line;
        bool mip;
    } modes[] = {{PLY_MIP_COMMENT, true},
                 {"comment SplatRenderMode: default", false},
                 {"comment antialiased 1", true},
                 {"comment antialiased 0", false}};
    for (size_t i = 0; i < sizeof modes / sizeof modes[0]; i++) {
        h->mip = strcasecmp(line, modes[i].line) == 0 ? modes[i].mip : h->mip;
    }
}

/* Reads the end of Polycam's comment on the axis that points up. */
static void read_up(const char *line, ply_header *h)
{
    static const struct {
        const char *end;
        scene_up up;
    } ends[] = {{" with X-axis up", T3R_UP_X}, {" with Y-axis up", T3R_UP_Y}, {" with Z-axis up", T3R_UP_Z}};
    const size_t length = strlen(line);
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        const size_t end = strlen(ends[i].end);
        h->up = length > end && strcmp(line + length - end, ends[i].end) == 0 ? ends[i].up : h->up;
    }
}

/* Reads a line that begins with "comment" or "obj_info". */
static void read_comment(const char *line, ply_header *h)
{
    int local, end = 0;
    int32_t exponent;
    uint32_t backdrop;
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
    } else if (sscanf(line, PLY_BACKDROP_COMMENT "%" SCNu32 "%n", &backdrop, &end) == 1 && line[end] == '\0') {
        h->backdrop = backdrop;
    } else {
        read_render_mode(line, h);
        read_up(line, h);
    }
}

/* Sets kind and bytes; false: no such type. */
static bool find_type(const char *name, ply_property *property)
{
    static const struct {
        const char *name;
        char kind;
        uint32_t bytes;
    } types[] = {{"char", 'i', 1},  {"int8", 'i', 1},    {"uchar", 'u', 1},  {"uint8", 'u', 1},
                 {"short", 'i', 2}, {"int16", 'i', 2},   {"ushort", 'u', 2}, {"uint16", 'u', 2},
                 {"int", 'i', 4},   {"int32", 'i', 4},   {"uint", 'u', 4},   {"uint32", 'u', 4},
                 {"float", 'f', 4}, {"float32", 'f', 4}, {"double", 'f', 8}, {"float64", 'f', 8}};
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        if (strcmp(name, types[i].name) == 0) {
            property->kind = types[i].kind;
            property->bytes = types[i].bytes;
            return true;
        }
    }
    return false;
}

static int read_property(const reader *r, size_t at, const char *line, ply_header *h)
{
    if (h->element_count == 0) {
        return FAIL(r, "byte %zu: a property before the first element", at);
    }
    ply_element *element = &h->elements[h->element_count - 1];
    if (strncmp(line, "property list ", 14) == 0) {
        element->lists = true;
        return 0;
    }
    if (h->property_count == PLY_PROPERTIES_MOST) {
        return FAIL(r, "byte %zu: more than %u properties", at, PLY_PROPERTIES_MOST);
    }
    ply_property *property = &h->properties[h->property_count];
    char type[32];
    int end = 0;
    if (sscanf(line, "property %31s %63s%n", type, property->name, &end) != 2 || line[end] != '\0') {
        return FAIL(r, "byte %zu: '%.80s' is no property that can be read", at, line);
    }
    if (!find_type(type, property)) {
        return FAIL(r, "byte %zu: unknown property type '%s'", at, type);
    }
    if (ply_header_property(h, element, property->name) != NULL) {
        return FAIL(r, "byte %zu: property %s comes twice", at, property->name);
    }
    if (element->row_bytes + property->bytes > MAX_ROW_BYTES) {
        return FAIL(r, "byte %zu: an element of over %u bytes", at, MAX_ROW_BYTES);
    }
    property->offset = element->row_bytes;
    element->row_bytes += property->bytes;
    element->second = ++h->property_count;
    return 0;
}

static int begin_element(const reader *r, size_t at, const char *line, ply_header *h)
{
    uint64_t count;
    int end = 0;
    if (h->element_count == PLY_ELEMENTS_MOST) {
        return FAIL(r, "byte %zu: more than %u elements", at, PLY_ELEMENTS_MOST);
    }
    ply_element *element = &h->elements[h->element_count];
    if (sscanf(line, "element %63s %" SCNu64 "%n", element->name, &count, &end) != 2 || line[end] != '\0' ||
        strchr(line, '-') != NULL) {
        return FAIL(r, "byte %zu: '%.80s' is no element", at, line);
    }
    if (count > UINT32_MAX) {
        return FAIL(r, "byte %zu: %" PRIu64 " elements '%s' are over the limit of 2^32", at, count, element->name);
    }
    if (ply_header_element(h, element->name) != NULL) {
        return FAIL(r, "byte %zu: a second element %s", at, element->name);
    }
    element->count = (uint32_t)count;
    element->first = element->second = h->property_count;
    h->element_count++;
    return 0;
}

static int read_format(const reader *r, size_t at, const char *line, ply_header *h)
{
    static const char *const names[] = {[PLY_LITTLE_ENDIAN] = "format binary_little_endian 1.0",
                                        [PLY_BIG_ENDIAN] = "format binary_big_endian 1.0",
                                        [PLY_TEXT] = "format ascii 1.0"};
    for (int i = PLY_LITTLE_ENDIAN; i <= PLY_TEXT; i++) {
        if (strcmp(line, names[i]) == 0) {
            h->encoding = (ply_encoding)i;
            return 0;
        }
    }
    return FAIL(r, "byte %zu: '%.80s': binary_little_endian, binary_big_endian and ascii 1.0 are read", at, line);
}

static int read_line(const reader *r, size_t at, const char *line, ply_header *h, bool *has_format)
{
    if (strncmp(line, "element ", 8) == 0) {
        return begin_element(r, at, line, h);
    }
    if (strncmp(line, "property ", 9) == 0) {
        return read_property(r, at, line, h);
    }
    if (strncmp(line, "format ", 7) == 0) {
        *has_format = true;
        return read_format(r, at, line, h);
    }
    if (is_remark(line)) {
        read_comment(line, h);
        return 0;
    }
    return line[0] == '\0' ? 0 : FAIL(r, "byte %zu: unknown header line '%.80s'", at, line);
}

void ply_header_place(ply_header *h, uint64_t data)
{
    uint64_t at = data; /* below 16 x 2^32 x 2^14 from there on */
    bool lists = false;
    for (uint32_t i = 0; i < h->element_count; i++) {
        ply_element *element = &h->elements[i];
        lists = lists || element->lists;
        element->lists = lists;
        element->at = at;
        at += (uint64_t)element->count * element->row_bytes;
    }
}

int ply_header_read(const uint8_t *bytes, size_t count, ply_header *out, char *error, size_t error_bytes)
{
    const reader r = {bytes, count, error, error_bytes};
    char line[MAX_LINE_BYTES];
    bool has_format = false;
    size_t at = 0;
    *out = (ply_header){0};
    if (count < 4 || memcmp(bytes, "ply", 3) != 0 || (bytes[3] != '\n' && bytes[3] != '\r')) {
        return FAIL(&r, "byte 0: not a .ply file");
    }
    if (next_line(&r, &at, line) != 0) {
        return -1;
    }
    for (;;) {
        size_t line_at = at;
        if (next_line(&r, &at, line) != 0) {
            return -1;
        }
        if (strcmp(line, "end_header") == 0) {
            break;
        }
        if (read_line(&r, line_at, line, out, &has_format) != 0) {
            return -1;
        }
    }
    out->bytes = at;
    ply_header_place(out, at);
    return has_format ? 0 : FAIL(&r, "the header names no format");
}

int ply_header_rows(const ply_header *header, const char *name, size_t count, const ply_element **out, char *error,
                    size_t error_bytes)
{
    const ply_element *element = ply_header_element(header, name);
    if (element == NULL) {
        return t3r_reason(error, error_bytes, "the header names no element %s", name);
    }
    if (element->lists) {
        return t3r_reason(error, error_bytes, "element %s has lists or follows some: they are not read", name);
    }
    if (element->count > T3R_MAX_GAUSSIANS) {
        return t3r_reason(error, error_bytes, "%" PRIu32 " elements '%s' are over the limit of %u", element->count,
                          name, T3R_MAX_GAUSSIANS);
    }
    const uint64_t end = element->at + (uint64_t)element->count * element->row_bytes;
    if (end > count) {
        return t3r_reason(error, error_bytes, "byte %zu: cut off: element %s ends at byte %" PRIu64, count, name, end);
    }
    *out = element;
    return 0;
}

const ply_element *ply_header_element(const ply_header *header, const char *name)
{
    for (uint32_t i = 0; i < header->element_count; i++) {
        if (strcmp(header->elements[i].name, name) == 0) {
            return &header->elements[i];
        }
    }
    return NULL;
}

const ply_property *ply_header_property(const ply_header *header, const ply_element *element, const char *name)
{
    for (uint32_t i = element->first; i < element->second; i++) {
        if (strcmp(header->properties[i].name, name) == 0) {
            return &header->properties[i];
        }
    }
    return NULL;
}
