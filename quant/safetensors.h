/* SPDX-License-Identifier: Apache-2.0 */
/* Reads .safetensors: 8 bytes of header length, a JSON header, then the tensors' bytes, all little-endian. Nothing in
 * it is trusted: the header must be one JSON object, names must differ, every tensor must be F32 with the bytes of its
 * shape, and the tensors must fill the bytes after the header without overlap or gap. */
#ifndef T3R_QUANT_SAFETENSORS_H
#define T3R_QUANT_SAFETENSORS_H

#include <stddef.h>
#include <stdint.h>

#define SAFETENSORS_MAX_RANK 8

typedef struct safetensors_tensor {
    const char *name;
    uint32_t rank;
    uint64_t shape[SAFETENSORS_MAX_RANK];
    uint64_t elements;    /* the product of the shape */
    const uint8_t *bytes; /* within the file, not aligned */
} safetensors_tensor;

typedef struct safetensors {
    safetensors_tensor *tensors; /* in the header's order */
    uint32_t count;
    struct cJSON *header;
} safetensors;

/* Parses `bytes`, which must outlive the result. Returns 0, after which safetensors_free() is due; or -1 with "what,
 * where" in error[]. */
int safetensors_parse(safetensors *file, const void *bytes, size_t count, char *error, size_t error_bytes);
void safetensors_free(safetensors *file);

const safetensors_tensor *safetensors_find(const safetensors *file, const char *name);
/* Returns a text of __metadata__, or NULL. */
const char *safetensors_metadata(const safetensors *file, const char *key);
/* Returns element i, i < elements. */
float safetensors_element(const safetensors_tensor *tensor, uint64_t i);

#endif
