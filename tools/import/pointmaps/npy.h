/* SPDX-License-Identifier: Apache-2.0 */
/* NumPy's .npy: a header in text, then numbers without gaps. Little-endian floats in C order are read. */
#ifndef TRIM3R_TOOLS_NPY_H
#define TRIM3R_TOOLS_NPY_H

#include <stddef.h>
#include <stdint.h>

#define NPY_MOST_DIMENSIONS 5

typedef struct npy_array {
    uint32_t dimensions;
    uint32_t shape[NPY_MOST_DIMENSIONS];
    uint32_t item_bytes; /* 4: float32, 8: float64 */
    size_t count;        /* number of items */
    size_t header_bytes; /* offset of the numbers */
} npy_array;

/* Parses the header of a .npy (versions 1 to 3) of `file_bytes`, of which the first `count` are given. The file must
 * have exactly the bytes of its shape, and at most 5 dimensions, none of them 0. Returns 0, or -1 with what is wrong in
 * error[]. */
int npy_parse(const uint8_t *bytes, size_t count, uint64_t file_bytes, npy_array *out, char *error, size_t error_bytes);

double npy_value(const npy_array *array, const uint8_t *bytes);

/* Writes the shape, such as "2x288x512x3". */
void npy_shape_text(const npy_array *array, char *text, size_t bytes);

#endif
