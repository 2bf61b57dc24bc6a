/* SPDX-License-Identifier: Apache-2.0 */
#include "import/pointmaps/npy.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "host/little_floats.h"
#include "host/reason.h"

#define MAGIC "\x93NUMPY"
#define MAGIC_BYTES 6
#define MOST_ITEMS ((uint64_t)1 << 30) /* bounds products of sizes */

/* The unread part of the header's text. */
typedef struct remainder {
    const char *at, *end;
} remainder;

static void skip_spaces(remainder *t)
{
    while (t->at < t->end && (*t->at == ' ' || *t->at == '\n')) {
        t->at++;
    }
}

static bool take(remainder *t, char expected)
{
    skip_spaces(t);
    if (t->at < t->end && *t->at == expected) {
        t->at++;
        return true;
    }
    return false;
}

static bool take_word(remainder *t, const char *word)
{
    size_t length = strlen(word);
    skip_spaces(t);
    if ((size_t)(t->end - t->at) >= length && memcmp(t->at, word, length) == 0) {
        t->at += length;
        return true;
    }
    return false;
}

/* Takes 'word' as Python writes it: no escapes. */
static bool take_string(remainder *t, char *out, size_t bytes)
{
    size_t length = 0;
    if (!take(t, '\'')) {
        return false;
    }
    while (t->at < t->end && *t->at != '\'' && length + 1 < bytes) {
        out[length++] = *t->at++;
    }
    out[length] = '\0';
    return t->at < t->end && *t->at++ == '\'';
}

static bool take_number(remainder *t, uint32_t *out)
{
    uint64_t value = 0;
    skip_spaces(t);
    const char *begin = t->at;
    while (t->at < t->end && *t->at >= '0' && *t->at <= '9' && value < MOST_ITEMS) {
        value = value * 10 + (uint64_t)(*t->at++ - '0');
    }
    *out = (uint32_t)value;
    return t->at > begin && value >= 1 && value < MOST_ITEMS;
}

/* Takes (2, 3) or (7,) or (). */
static const char *take_shape(remainder *t, npy_array *out)
{
    out->dimensions = 0;
    if (!take(t, '(')) {
        return "shape is not a tuple";
    }
    while (!take(t, ')')) {
        if (out->dimensions == NPY_MOST_DIMENSIONS) {
            return "more than 5 dimensions";
        }
        if (!take_number(t, &out->shape[out->dimensions++])) {
            return "a dimension is not a number from 1 to 2^30";
        }
        if (!take(t, ',') && (t->at == t->end || *t->at != ')')) {
            return "shape is not a tuple";
        }
    }
    return NULL;
}

static const char *take_type(remainder *t, npy_array *out, char *type, size_t bytes)
{
    if (!take_string(t, type, bytes)) {
        return "descr is not one type";
    }
    out->item_bytes = strcmp(type, "<f4") == 0 ? 4 : strcmp(type, "<f8") == 0 ? 8 : 0;
    return out->item_bytes != 0 ? NULL : "descr is neither '<f4' nor '<f8', little-endian float32 and float64";
}

/* Reads {'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), } with its entries in any order, each once. */
static const char *read_header(remainder *t, npy_array *out)
{
    bool type = false, order = false, shape = false;
    char name[24], value[24];
    if (!take(t, '{')) {
        return "the header is not a dictionary";
    }
    while (!take(t, '}')) {
        const char *wrong = NULL;
        if (!take_string(t, name, sizeof name) || !take(t, ':')) {
            return "the header is not a dictionary";
        }
        if (strcmp(name, "descr") == 0 && !type) {
            wrong = take_type(t, out, value, sizeof value);
            type = true;
        } else if (strcmp(name, "fortran_order") == 0 && !order) {
            wrong = take_word(t, "False") ? NULL : "fortran_order is not False: numpy.ascontiguousarray() helps";
            order = true;
        } else if (strcmp(name, "shape") == 0 && !shape) {
            wrong = take_shape(t, out);
            shape = true;
        } else {
            wrong = "the header has an unknown entry or one twice";
        }
        if (wrong != NULL) {
            return wrong;
        }
        if (!take(t, ',') && (t->at == t->end || *t->at != '}')) {
            return "the header is not a dictionary";
        }
    }
    skip_spaces(t);
    return t->at != t->end             ? "there is something after the header's dictionary"
           : !(type && order && shape) ? "the header lacks descr, fortran_order or shape"
                                       : NULL;
}

int npy_parse(const uint8_t *bytes, size_t count, uint64_t file_bytes, npy_array *out, char *error, size_t error_bytes)
{
    *out = (npy_array){0};
    if (count < MAGIC_BYTES + 4 || memcmp(bytes, MAGIC, MAGIC_BYTES) != 0) {
        return t3r_reason(error, error_bytes, "not a NumPy array (.npy)");
    }
    uint32_t major = bytes[6], length_bytes = major == 1 ? 2 : 4;
    if (major < 1 || major > 3 || bytes[7] != 0) {
        return t3r_reason(error, error_bytes, "version %u.%u of .npy is not known", major, bytes[7]);
    }
    size_t start = MAGIC_BYTES + 2 + length_bytes;
    size_t header = count < start ? 0 : major == 1 ? t3r_load_le16(bytes + 8) : t3r_load_le32(bytes + 8);
    if (count < start || header > count - start) {
        return t3r_reason(error, error_bytes, "%s",
                          count < file_bytes ? "a header of over 65,000 bytes" : "cut off in its header");
    }
    remainder t = {(const char *)bytes + start, (const char *)bytes + start + header};
    const char *wrong = read_header(&t, out);
    if (wrong != NULL) {
        return t3r_reason(error, error_bytes, "%s", wrong);
    }
    uint64_t items = 1;
    for (uint32_t i = 0; i < out->dimensions; i++) {
        items *= out->shape[i]; /* below 2^30 times 2^30 */
        if (items >= MOST_ITEMS) {
            return t3r_reason(error, error_bytes, "2^30 numbers or more");
        }
    }
    uint64_t left = file_bytes - start - header;
    if (left != items * out->item_bytes) {
        char shape[64];
        npy_shape_text(out, shape, sizeof shape);
        return t3r_reason(error, error_bytes, "%llu bytes of numbers, but %s of %u bytes are %llu%s",
                          (unsigned long long)left, shape, out->item_bytes,
                          (unsigned long long)(items * out->item_bytes),
                          left < items * out->item_bytes ? ": cut off" : "");
    }
    out->count = (size_t)items;
    out->header_bytes = start + header;
    return 0;
}

double npy_value(const npy_array *array, const uint8_t *bytes)
{
    return array->item_bytes == 4 ? t3r_load_float(bytes) : t3r_load_double(bytes);
}

void npy_shape_text(const npy_array *array, char *text, size_t bytes)
{
    size_t used = 0;
    text[0] = '\0';
    for (uint32_t i = 0; i < array->dimensions && used < bytes; i++) {
        used += (size_t)snprintf(text + used, bytes - used, "%s%u", i > 0 ? "x" : "", array->shape[i]);
    }
    if (array->dimensions == 0) {
        snprintf(text, bytes, "one number");
    }
}
