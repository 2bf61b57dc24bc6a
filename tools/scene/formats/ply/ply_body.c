/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/formats/ply/ply_body.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/little_floats.h"
#include "host/reason.h"

/* The file's rows that are still to be read. */
typedef struct rows_left {
    const uint8_t *at, *end;
} rows_left;

static bool is_blank(uint8_t byte)
{
    return byte == ' ' || byte == '\n' || byte == '\r' || byte == '\t';
}

/* Reads the next number of a text. */
static int next_number(rows_left *left, double *value)
{
    char word[64], *end;
    size_t length = 0;
    while (left->at < left->end && is_blank(*left->at)) {
        left->at++;
    }
    while (left->at < left->end && !is_blank(*left->at) && length < sizeof word - 1) {
        word[length++] = (char)*left->at++;
    }
    word[length] = '\0';
    *value = strtod(word, &end);
    return length > 0 && *end == '\0' ? 0 : -1;
}

static void put_number(const ply_property *property, double value, uint8_t *out)
{
    if (property->kind == 'f' && property->bytes == 8) {
        uint64_t bits;
        memcpy(&bits, &value, sizeof bits);
        t3r_store_le64(out, bits);
    } else if (property->kind == 'f') {
        t3r_store_float(out, value);
    } else {
        const int64_t whole = fabs(value) < 0x1p32 ? (int64_t)value : 0;
        for (uint32_t i = 0; i < property->bytes; i++) {
            out[i] = (uint8_t)(whole >> (8 * i));
        }
    }
}

/* Converts one number. Returns 0, or -1 at the end of the file or where there is no number. */
static int convert_number(ply_encoding encoding, const ply_property *property, rows_left *left, uint8_t *out)
{
    double value;
    if (encoding == PLY_TEXT) {
        if (next_number(left, &value) != 0) {
            return -1;
        }
        put_number(property, value, out);
        return 0;
    }
    if ((size_t)(left->end - left->at) < property->bytes) {
        return -1;
    }
    for (uint32_t i = 0; i < property->bytes; i++) {
        out[i] = left->at[property->bytes - 1 - i];
    }
    left->at += property->bytes;
    return 0;
}

/* Converts the rows of an element. */
static int convert_rows(const ply_header *header, const ply_element *element, rows_left *left, uint8_t *out,
                        char *error, size_t error_bytes)
{
    for (uint32_t row = 0; row < element->count; row++) {
        for (uint32_t i = element->first; i < element->second; i++) {
            const ply_property *property = &header->properties[i];
            if (convert_number(header->encoding, property, left, out) != 0) {
                return t3r_reason(error, error_bytes, "%s %" PRIu32 ": %s is cut off or no number", element->name, row,
                                  property->name);
            }
            out += property->bytes;
        }
    }
    return 0;
}

/* Returns the bytes of all rows before the first list; 0 if the file is too short for them. */
static uint64_t converted_bytes(const ply_header *header, uint64_t left)
{
    uint64_t bytes = 0, least = 0;
    for (uint32_t i = 0; i < header->element_count && !header->elements[i].lists; i++) {
        const ply_element *element = &header->elements[i];
        bytes += (uint64_t)element->count * element->row_bytes;
        least += header->encoding == PLY_TEXT ? (uint64_t)element->count * 2 * (element->second - element->first)
                                              : (uint64_t)element->count * element->row_bytes;
    }
    return least <= left + 1 ? bytes : 0; /* a number and a blank each, but for the last blank */
}

uint8_t *ply_body_convert(ply_header *header, const uint8_t *bytes, size_t *count, char *error, size_t error_bytes)
{
    rows_left left = {bytes + header->bytes, bytes + *count};
    const uint64_t size = converted_bytes(header, *count - header->bytes);
    uint8_t *out = size > 0 ? malloc(size) : NULL;
    if (out == NULL) {
        (void)t3r_reason(error, error_bytes,
                         size > 0 ? "out of memory" : "cut off: the file is too short for its rows");
        return NULL;
    }
    ply_header_place(header, 0);
    for (uint32_t i = 0; i < header->element_count && !header->elements[i].lists; i++) {
        const ply_element *element = &header->elements[i];
        if (convert_rows(header, element, &left, out + element->at, error, error_bytes) != 0) {
            free(out);
            return NULL;
        }
    }
    *count = size;
    return out;
}
