/* SPDX-License-Identifier: Apache-2.0 */
#include "safetensors.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>

#include "core/little_endian.h"
#include "json_object.h"
#include "quant_reason.h"

#define LENGTH_BYTES 8u
#define MAX_HEADER_BYTES (1u << 20) /* a head's is a few KB; every two bytes may be a value that takes 80 in memory */
#define METADATA "__metadata__"

typedef struct reader {
    const uint8_t *data; /* after the header */
    uint64_t data_bytes;
    char *error;
    size_t error_bytes;
} reader;

static int fail(const reader *r, const char *name, const char *what)
{
    return quant_reason(r->error, r->error_bytes, "tensor '%.64s': %s", name, what);
}

/* Reads a whole number from 0 to 2^53. */
static bool whole(const cJSON *item, uint64_t *value)
{
    if (!cJSON_IsNumber(item) || !(item->valuedouble >= 0 && item->valuedouble <= 0x1p53) ||
        floor(item->valuedouble) != item->valuedouble) {
        return false;
    }
    *value = (uint64_t)item->valuedouble;
    return true;
}

static int read_shape(const reader *r, const cJSON *item, safetensors_tensor *tensor)
{
    const cJSON *shape = cJSON_GetObjectItemCaseSensitive(item, "shape"), *side;
    if (!cJSON_IsArray(shape)) {
        return fail(r, tensor->name, "shape is not an array");
    }
    tensor->elements = 1;
    cJSON_ArrayForEach(side, shape)
    {
        uint64_t n;
        if (tensor->rank == SAFETENSORS_MAX_RANK) {
            return fail(r, tensor->name, "shape has more than 8 dimensions");
        }
        if (!whole(side, &n)) {
            return fail(r, tensor->name, "shape holds something else than whole numbers");
        }
        /* no file is this large, and products of two such numbers do not overflow */
        if (n > UINT32_MAX || tensor->elements * n > UINT32_MAX) {
            return fail(r, tensor->name, "shape has more than 2^32 elements");
        }
        tensor->shape[tensor->rank++] = n;
        tensor->elements *= n;
    }
    return 0;
}

static int read_tensor(const reader *r, const cJSON *item, safetensors_tensor *tensor)
{
    tensor->name = item->string;
    if (!cJSON_IsObject(item)) {
        return fail(r, tensor->name, "not an object");
    }
    const cJSON *dtype = cJSON_GetObjectItemCaseSensitive(item, "dtype");
    if (!cJSON_IsString(dtype) || strcmp(dtype->valuestring, "F32") != 0) {
        return fail(r, tensor->name, "dtype is not F32");
    }
    if (read_shape(r, item, tensor) != 0) {
        return -1;
    }
    const cJSON *offsets = cJSON_GetObjectItemCaseSensitive(item, "data_offsets");
    uint64_t begin, end;
    if (!cJSON_IsArray(offsets) || cJSON_GetArraySize(offsets) != 2 || !whole(offsets->child, &begin) ||
        !whole(offsets->child->next, &end)) {
        return fail(r, tensor->name, "data_offsets is not two whole numbers");
    }
    if (begin > end || end > r->data_bytes) {
        return fail(r, tensor->name, "data_offsets lie outside the file");
    }
    if (end - begin != 4 * tensor->elements) {
        return fail(r, tensor->name, "data_offsets and shape do not agree");
    }
    tensor->bytes = r->data + begin;
    return 0;
}

static int by_place(const void *left, const void *right)
{
    const safetensors_tensor *a = left, *b = right;
    if (a->bytes != b->bytes) {
        return a->bytes < b->bytes ? -1 : 1;
    }
    /* at the same place an empty tensor comes first */
    return a->elements < b->elements ? -1 : a->elements > b->elements;
}

/* Checks that the tensors, sorted by place, each begin where the previous one ends. */
static int check_places(const reader *r, const safetensors *file)
{
    safetensors_tensor *sorted = malloc((file->count + 1) * sizeof *sorted);
    if (sorted == NULL) {
        return quant_reason(r->error, r->error_bytes, "out of memory");
    }
    memcpy(sorted, file->tensors, file->count * sizeof *sorted);
    qsort(sorted, file->count, sizeof *sorted, by_place);
    const uint8_t *end = r->data;
    int status = 0;
    for (uint32_t i = 0; i < file->count && status == 0; i++) {
        if (sorted[i].bytes != end) {
            status = fail(r, sorted[i].name, sorted[i].bytes < end ? "overlaps another one" : "a gap lies before it");
        }
        end = sorted[i].bytes + 4 * sorted[i].elements;
    }
    if (status == 0 && end != r->data + r->data_bytes) {
        status = quant_reason(r->error, r->error_bytes, "%llu bytes after the last tensor belong to none",
                              (unsigned long long)(r->data + r->data_bytes - end));
    }
    free(sorted);
    return status;
}

static int check_metadata(const reader *r, const cJSON *metadata)
{
    const cJSON *item;
    if (metadata == NULL) {
        return 0;
    }
    if (!cJSON_IsObject(metadata)) {
        return quant_reason(r->error, r->error_bytes, METADATA ": not an object");
    }
    cJSON_ArrayForEach(item, metadata)
    {
        if (!cJSON_IsString(item)) {
            return quant_reason(r->error, r->error_bytes, METADATA ": '%.64s' is not a string", item->string);
        }
    }
    return 0;
}

static int read_tensors(const reader *r, safetensors *file)
{
    const cJSON *item;
    if (check_metadata(r, cJSON_GetObjectItemCaseSensitive(file->header, METADATA)) != 0) {
        return -1;
    }
    file->tensors = calloc((size_t)cJSON_GetArraySize(file->header) + 1, sizeof *file->tensors);
    if (file->tensors == NULL) {
        return quant_reason(r->error, r->error_bytes, "out of memory");
    }
    cJSON_ArrayForEach(item, file->header)
    {
        if (strcmp(item->string, METADATA) == 0) {
            continue;
        }
        if (read_tensor(r, item, &file->tensors[file->count]) != 0) {
            return -1;
        }
        file->count++;
    }
    return check_places(r, file);
}

int safetensors_parse(safetensors *file, const void *bytes, size_t count, char *error, size_t error_bytes)
{
    const uint8_t *b = bytes;
    uint64_t header_bytes = 0;
    *file = (safetensors){0};
    if (count < LENGTH_BYTES) {
        return quant_reason(error, error_bytes, "%zu bytes are no .safetensors: its header's length takes 8", count);
    }
    for (int i = 0; i < 8; i++) {
        header_bytes |= (uint64_t)b[i] << (8 * i);
    }
    if (header_bytes > count - LENGTH_BYTES || header_bytes > MAX_HEADER_BYTES) {
        return quant_reason(error, error_bytes,
                            "a header of %llu bytes in a file of %zu: not a .safetensors, or cut off",
                            (unsigned long long)header_bytes, count);
    }
    reader r = {.data = b + LENGTH_BYTES + header_bytes,
                .data_bytes = count - LENGTH_BYTES - header_bytes,
                .error = error,
                .error_bytes = error_bytes};
    file->header =
        json_object_parse("header", (const char *)b + LENGTH_BYTES, (size_t)header_bytes, error, error_bytes);
    if (file->header == NULL) {
        return -1;
    }
    if (read_tensors(&r, file) != 0) {
        safetensors_free(file);
        return -1;
    }
    return 0;
}

void safetensors_free(safetensors *file)
{
    free(file->tensors);
    cJSON_Delete(file->header);
    *file = (safetensors){0};
}

const safetensors_tensor *safetensors_find(const safetensors *file, const char *name)
{
    for (uint32_t i = 0; i < file->count; i++) {
        if (strcmp(file->tensors[i].name, name) == 0) {
            return &file->tensors[i];
        }
    }
    return NULL;
}

const char *safetensors_metadata(const safetensors *file, const char *key)
{
    const cJSON *metadata = cJSON_GetObjectItemCaseSensitive(file->header, METADATA);
    const cJSON *item = metadata == NULL ? NULL : cJSON_GetObjectItemCaseSensitive(metadata, key);
    return item == NULL ? NULL : item->valuestring;
}

float safetensors_element(const safetensors_tensor *tensor, uint64_t i)
{
    const uint32_t bits = t3r_load_le32(tensor->bytes + 4 * i);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}
