/* SPDX-License-Identifier: Apache-2.0 */
/* Weight files for tests: a head's graph as a list, with random but useful numbers, written from the text of
 * runtime/head/weights.h. */
#ifndef T3R_TESTS_WEIGHTS_MAKER_H
#define T3R_TESTS_WEIGHTS_MAKER_H

#include <stddef.h>
#include <stdint.h>

#include "head/weights.h"

typedef struct made_layer {
    t3r_layer_kind kind;
    uint8_t level, source[2], kernel, stride, phases;
    uint16_t outputs;
} made_layer;

/* A U-net of about the size of the shipped `small`, and one with three times its multiply-accumulates; their lengths.
 */
extern const made_layer small_shape[], wide_shape[];
extern const uint32_t small_layers, wide_layers;
#define SMALL_SHAPE_COLUMN_BYTES 704 /* of head work, for any width and bits */

/* Returns the file, aligned to 16 and to be freed; *bytes: its length. */
uint8_t *make_weights(const made_layer *layers, uint32_t count, uint32_t weight_bits, uint32_t activation_bits,
                      uint64_t seed, size_t *bytes);

/* Corrects the length and CRC of a changed file. */
void seal_weights(uint8_t *file, size_t bytes);

#endif
