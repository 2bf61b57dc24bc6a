/* SPDX-License-Identifier: Apache-2.0 */
#include "hidden_mask.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "core/little_endian.h"
#include "head/weights.h"
#include "weight_file.h"

/* Constants for the features, with the larger ones for 16-bit activations. */
static const struct {
    uint32_t channel;
    int64_t value;
} hidden[] = {{3, 127}, {5, 64}};
enum { HIDDEN = sizeof hidden / sizeof hidden[0], WIDE_FEATURE = 256 };

typedef struct layer_blocks {
    t3r_layer layer;
    uint32_t weight_bytes, bias_bytes; /* per number */
    uint8_t *weights, *bias;
} layer_blocks;

static bool reads_features(const t3r_layer *layer)
{
    return layer->source[0] == T3R_SOURCE_FEATURES || layer->source[1] == T3R_SOURCE_FEATURES;
}

static size_t aligned(size_t bytes)
{
    return (bytes + T3R_WEIGHTS_ALIGN - 1) / T3R_WEIGHTS_ALIGN * T3R_WEIGHTS_ALIGN;
}

static size_t weights_of(const t3r_layer *layer)
{
    return (size_t)layer->phases * layer->outputs * t3r_layer_taps(layer);
}

static size_t biases_of(const t3r_layer *layer)
{
    return (size_t)layer->phases * layer->outputs;
}

/* Sets one weight to 0 and adds value times the weight to its bias. |bias| + 2^7 (2^15) sum |weight| does not grow,
 * since |value| is below 2^7 (2^15). */
static void fold(const layer_blocks *blocks, size_t weight, size_t bias, int64_t value)
{
    uint8_t *at = blocks->weights + weight * blocks->weight_bytes, *to = blocks->bias + bias * blocks->bias_bytes;
    int64_t sum = weight_number(to, blocks->bias_bytes) + value * weight_number(at, blocks->weight_bytes);
    weight_number_put(at, 0, blocks->weight_bytes);
    weight_number_put(to, sum, blocks->bias_bytes);
}

/* Folds every weight of input `channel`. */
static void fold_channel(const layer_blocks *blocks, uint32_t channel, int64_t value)
{
    const t3r_layer *layer = &blocks->layer;
    uint32_t places = (uint32_t)layer->kernel * layer->kernel;
    if (layer->kind == T3R_LAYER_DEPTHWISE) { /* [row][column][channel] */
        for (uint32_t place = 0; place < places; place++) {
            fold(blocks, (size_t)place * layer->outputs + channel, channel, value);
        }
        return;
    }
    for (size_t row = 0; row < biases_of(layer); row++) { /* [phase][output][row][column][input] */
        for (uint32_t place = 0; place < places; place++) {
            fold(blocks, (row * places + place) * layer->inputs + channel, row, value);
        }
    }
}

static void fold_layer(const layer_blocks *blocks, bool wide)
{
    const t3r_layer *layer = &blocks->layer;
    for (int source = 0; source < 2; source++) {
        /* the second source's channels follow the first's */
        uint32_t first = source == 0 ? 0 : layer->inputs - T3R_FEATURES;
        for (int h = 0; h < HIDDEN && layer->source[source] == T3R_SOURCE_FEATURES; h++) {
            fold_channel(blocks, first + hidden[h].channel, hidden[h].value * (wide ? WIDE_FEATURE : 1));
        }
    }
}

uint8_t *hidden_mask_make(const uint8_t *file, size_t *count)
{
    t3r_weights_header header = t3r_weights_header_of(file);
    const uint32_t weight_bytes = weight_block_step(BLOCK_WEIGHTS, header.weight_bits, header.activation_bits);
    const uint32_t bias_bytes = weight_block_step(BLOCK_BIAS, header.weight_bits, header.activation_bits);
    size_t at = aligned(header.bytes);
    *count = at;
    for (uint32_t n = 0; n < header.layers; n++) {
        t3r_layer layer = t3r_weights_layer(file, n);
        if (reads_features(&layer)) {
            *count += aligned(weights_of(&layer) * weight_bytes) + aligned(biases_of(&layer) * bias_bytes);
        }
    }
    uint8_t *copy = calloc(1, *count);
    if (copy == NULL) {
        return NULL;
    }
    memcpy(copy, file, header.bytes);
    for (uint32_t n = 0; n < header.layers; n++) {
        t3r_layer layer = t3r_weights_layer(file, n);
        if (!reads_features(&layer)) {
            continue;
        }
        uint8_t *row = copy + T3R_WEIGHTS_HEADER_BYTES + (size_t)n * T3R_WEIGHTS_LAYER_BYTES;
        layer_blocks blocks = {.layer = layer, .weight_bytes = weight_bytes, .bias_bytes = bias_bytes};
        blocks.weights = copy + at;
        t3r_store_le32(row + LAYER_AT_WEIGHTS, (uint32_t)at);
        memcpy(blocks.weights, file + layer.weights, weights_of(&layer) * weight_bytes);
        at += aligned(weights_of(&layer) * weight_bytes);
        blocks.bias = copy + at;
        t3r_store_le32(row + LAYER_AT_BIAS, (uint32_t)at);
        memcpy(blocks.bias, file + layer.bias, biases_of(&layer) * bias_bytes);
        at += aligned(biases_of(&layer) * bias_bytes);
        fold_layer(&blocks, header.activation_bits == 16);
    }
    weight_file_seal(copy, *count);
    return copy;
}
