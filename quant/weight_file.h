/* SPDX-License-Identifier: Apache-2.0 */
/* Writes the .t3w weight file (runtime/head/weights.h). */
#ifndef T3R_QUANT_WEIGHT_FILE_H
#define T3R_QUANT_WEIGHT_FILE_H

#include <stddef.h>
#include <stdint.h>

#include "quantize.h"

/* Offsets of header and layer fields. */
enum {
    WEIGHT_AT_MAGIC = 0,
    WEIGHT_AT_FORMAT = 4,
    WEIGHT_AT_EPOCH = 6,
    WEIGHT_AT_BYTES = 8,
    WEIGHT_AT_CRC = 12,
    WEIGHT_AT_SEALED = 16, /* start of the bytes that the CRC covers */
    WEIGHT_AT_WEIGHT_BITS = 16,
    WEIGHT_AT_ACTIVATION_BITS = 17,
    WEIGHT_AT_LAYERS = 18,
    WEIGHT_AT_FEATURE_SET = 19,
    WEIGHT_AT_MACS = 20,
    WEIGHT_AT_PARAMETERS = 24,
    WEIGHT_AT_RESERVED = 28,
    WEIGHT_AT_NAME = 32,
    WEIGHT_AT_RESERVED_END = 48,

    LAYER_AT_KIND = 0,
    LAYER_AT_LEVEL = 1,
    LAYER_AT_SOURCE = 2,
    LAYER_AT_INPUTS = 4,
    LAYER_AT_OUTPUTS = 6,
    LAYER_AT_KERNEL = 8,
    LAYER_AT_STRIDE = 9,
    LAYER_AT_PHASES = 10,
    LAYER_AT_RESERVED = 11,
    LAYER_AT_ZERO = 12,
    LAYER_AT_RESERVED_2 = 14,
    LAYER_AT_WEIGHTS = 16,
    LAYER_AT_BIAS = 20,
    LAYER_AT_MULTIPLIER = 24,
    LAYER_AT_SHIFT = 28
};

/* The blocks of a layer, in the order of their offsets in its row. */
enum weight_block { BLOCK_WEIGHTS, BLOCK_BIAS, BLOCK_MULTIPLIER, BLOCK_SHIFT, WEIGHT_BLOCKS };

/* Return the bytes of one number of a block, and of the whole block without padding. */
uint32_t weight_block_step(enum weight_block block, uint32_t weight_bits, uint32_t activation_bits);
size_t weight_block_bytes(const head_layer *layer, enum weight_block block, uint32_t weight_bits,
                          uint32_t activation_bits);
/* Returns the bytes of the whole file, with padding. */
size_t weight_file_bytes(const head_graph *graph, uint32_t weight_bits, uint32_t activation_bits);

/* Return the sums in the header. */
uint32_t weight_macs_q8(const head_graph *graph);
uint32_t weight_parameters(const head_graph *graph);

/* Writes a number of a block, in two's complement of 1, 2, 4 or 8 bytes. */
void weight_number_put(uint8_t *to, int64_t value, uint32_t bytes);
int64_t weight_number(const uint8_t *from, uint32_t bytes);

/* Writes the number of bytes and the CRC into the header. */
void weight_file_seal(uint8_t *bytes, size_t count);

/* Returns the file's bytes, to be freed by free(); NULL without memory. Blocks of layers without numbers (all pointers
 * NULL) are 0: such a file shows the requirements of the head, but t3r_weights_check() refuses it. */
uint8_t *weight_file_make(const quantized_head *head, size_t *count);

#endif
