#include "weight_file.h"

#include <stdlib.h>
#include <string.h>

#include "le_bytes.h"
#include "trim3r.h"

static size_t aligned(size_t bytes)
{
    return (bytes + T3R_WEIGHTS_ALIGN - 1) / T3R_WEIGHTS_ALIGN * T3R_WEIGHTS_ALIGN;
}

uint32_t weight_block_step(enum weight_block block, uint32_t weight_bits, uint32_t activation_bits)
{
    switch (block) {
    case BLOCK_WEIGHTS:
        return weight_bits / 8;
    case BLOCK_BIAS:
        return activation_bits / 2; /* int32, int64 */
    case BLOCK_MULTIPLIER:
        return 4;
    default:
        return 1;
    }
}

size_t weight_block_bytes(const head_layer *layer, enum weight_block block, uint32_t weight_bits,
                          uint32_t activation_bits)
{
    size_t count = block == BLOCK_WEIGHTS ? head_weight_count(layer)
                   : block == BLOCK_BIAS  ? head_bias_count(layer)
                                          : layer->outputs;
    return count * weight_block_step(block, weight_bits, activation_bits);
}

size_t weight_file_bytes(const head_graph *graph, uint32_t weight_bits, uint32_t activation_bits)
{
    size_t bytes = T3R_WEIGHTS_HEADER_BYTES + (size_t)graph->count * T3R_WEIGHTS_LAYER_BYTES;
    for (uint32_t i = 0; i < graph->count; i++) {
        for (int b = 0; b < WEIGHT_BLOCKS; b++) {
            bytes += aligned(weight_block_bytes(&graph->layers[i], (enum weight_block)b, weight_bits, activation_bits));
        }
    }
    return bytes;
}

uint32_t weight_macs_q8(const head_graph *graph)
{
    uint32_t macs = 0; /* 24 layers of at most 128 x 36 x 128 x 2^8: below 2^32 */
    for (uint32_t i = 0; i < graph->count; i++) {
        macs += head_macs_q8(&graph->layers[i]);
    }
    return macs;
}

uint32_t weight_parameters(const head_graph *graph)
{
    size_t parameters = 0;
    for (uint32_t i = 0; i < graph->count; i++) {
        parameters += head_weight_count(&graph->layers[i]) + head_bias_count(&graph->layers[i]);
    }
    return (uint32_t)parameters;
}

uint32_t weight_file_crc(const uint8_t *bytes, size_t count)
{
    uint32_t crc = 0xffffffffu;
    for (size_t i = 16; i < count; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++) {
            crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xedb88320u : 0);
        }
    }
    return ~crc;
}

static void put_header(uint8_t *to, const quantized_head *head, size_t count)
{
    memcpy(to + WEIGHT_AT_MAGIC, "T3RW", 4); /* not a string. NOLINT(bugprone-not-null-terminated-result) */
    le_put(to + WEIGHT_AT_FORMAT, T3R_WEIGHTS_FORMAT, 2);
    le_put(to + WEIGHT_AT_EPOCH, T3R_BITS_EPOCH, 2);
    le_put(to + WEIGHT_AT_BYTES, count, 4);
    le_put(to + WEIGHT_AT_WEIGHT_BITS, head->weight_bits, 1);
    le_put(to + WEIGHT_AT_ACTIVATION_BITS, head->activation_bits, 1);
    le_put(to + WEIGHT_AT_LAYERS, head->graph.count, 1);
    le_put(to + WEIGHT_AT_FEATURE_SET, T3R_FEATURE_SET, 1);
    le_put(to + WEIGHT_AT_MACS, weight_macs_q8(&head->graph), 4);
    le_put(to + WEIGHT_AT_PARAMETERS, weight_parameters(&head->graph), 4);
    memcpy(to + WEIGHT_AT_NAME, head->graph.name, strlen(head->graph.name));
}

static void put_row(uint8_t *to, const head_layer *layer, int16_t zero)
{
    le_put(to + LAYER_AT_KIND, layer->kind, 1);
    le_put(to + LAYER_AT_LEVEL, layer->level, 1);
    le_put(to + LAYER_AT_SOURCE, layer->sources[0], 1);
    le_put(to + LAYER_AT_SOURCE + 1, layer->sources[1], 1);
    le_put(to + LAYER_AT_INPUTS, layer->inputs, 2);
    le_put(to + LAYER_AT_OUTPUTS, layer->outputs, 2);
    le_put(to + LAYER_AT_KERNEL, layer->kernel, 1);
    le_put(to + LAYER_AT_STRIDE, layer->stride, 1);
    le_put(to + LAYER_AT_PHASES, layer->phases, 1);
    le_put(to + LAYER_AT_ZERO, (uint64_t)(int64_t)zero, 2);
}

static int64_t block_number(const quantized_layer *layer, enum weight_block block, size_t i)
{
    switch (block) {
    case BLOCK_WEIGHTS:
        return layer->weight[i];
    case BLOCK_BIAS:
        return layer->bias[i];
    case BLOCK_MULTIPLIER:
        return layer->multiplier[i];
    default:
        return layer->shift[i];
    }
}

uint8_t *weight_file_make(const quantized_head *head, size_t *count)
{
    *count = weight_file_bytes(&head->graph, head->weight_bits, head->activation_bits);
    uint8_t *bytes = calloc(1, *count);
    if (bytes == NULL) {
        return NULL;
    }
    put_header(bytes, head, *count);
    size_t at = T3R_WEIGHTS_HEADER_BYTES + (size_t)head->graph.count * T3R_WEIGHTS_LAYER_BYTES;
    for (uint32_t n = 0; n < head->graph.count; n++) {
        const head_layer *layer = &head->graph.layers[n];
        uint8_t *row = bytes + T3R_WEIGHTS_HEADER_BYTES + (size_t)n * T3R_WEIGHTS_LAYER_BYTES;
        put_row(row, layer, head->layers[n].zero);
        for (int b = 0; b < WEIGHT_BLOCKS; b++) {
            enum weight_block block = (enum weight_block)b;
            uint32_t step = weight_block_step(block, head->weight_bits, head->activation_bits);
            size_t length = weight_block_bytes(layer, block, head->weight_bits, head->activation_bits);
            le_put(row + LAYER_AT_WEIGHTS + 4 * b, at, 4);
            for (size_t i = 0; i < length / step && head->layers[n].weight != NULL; i++) {
                le_put(bytes + at + i * step, (uint64_t)block_number(&head->layers[n], block, i), step);
            }
            at += aligned(length);
        }
    }
    le_put(bytes + WEIGHT_AT_CRC, weight_file_crc(bytes, *count), 4);
    return bytes;
}
