#include "weight_file.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "core/little_endian.h"
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

void weight_number_put(uint8_t *to, int64_t value, uint32_t bytes)
{
    for (uint32_t i = 0; i < bytes; i++) {
        to[i] = (uint8_t)((uint64_t)value >> (8 * i));
    }
}

int64_t weight_number(const uint8_t *from, uint32_t bytes)
{
    uint64_t value = 0, sign = UINT64_C(1) << (8 * bytes - 1);
    for (uint32_t i = 0; i < bytes; i++) {
        value |= (uint64_t)from[i] << (8 * i);
    }
    return (int64_t)((value ^ sign) - sign);
}

void weight_file_seal(uint8_t *bytes, size_t count)
{
    t3r_store_le32(bytes + WEIGHT_AT_BYTES, (uint32_t)count);
    t3r_store_le32(bytes + WEIGHT_AT_CRC, (uint32_t)crc32_z(0, bytes + WEIGHT_AT_SEALED, count - WEIGHT_AT_SEALED));
}

static void put_header(uint8_t *to, const quantized_head *head)
{
    memcpy(to + WEIGHT_AT_MAGIC, "T3RW", 4); /* not a string. NOLINT(bugprone-not-null-terminated-result) */
    t3r_store_le16(to + WEIGHT_AT_FORMAT, T3R_WEIGHTS_FORMAT);
    t3r_store_le16(to + WEIGHT_AT_EPOCH, T3R_BITS_EPOCH);
    to[WEIGHT_AT_WEIGHT_BITS] = (uint8_t)head->weight_bits;
    to[WEIGHT_AT_ACTIVATION_BITS] = (uint8_t)head->activation_bits;
    to[WEIGHT_AT_LAYERS] = (uint8_t)head->graph.count;
    to[WEIGHT_AT_FEATURE_SET] = T3R_FEATURE_SET;
    t3r_store_le32(to + WEIGHT_AT_MACS, weight_macs_q8(&head->graph));
    t3r_store_le32(to + WEIGHT_AT_PARAMETERS, weight_parameters(&head->graph));
    memcpy(to + WEIGHT_AT_NAME, head->graph.name, strlen(head->graph.name));
}

static void put_row(uint8_t *to, const head_layer *layer, int16_t zero)
{
    to[LAYER_AT_KIND] = (uint8_t)layer->kind;
    to[LAYER_AT_LEVEL] = (uint8_t)layer->level;
    to[LAYER_AT_SOURCE] = (uint8_t)layer->sources[0];
    to[LAYER_AT_SOURCE + 1] = (uint8_t)layer->sources[1];
    t3r_store_le16(to + LAYER_AT_INPUTS, (uint16_t)layer->inputs);
    t3r_store_le16(to + LAYER_AT_OUTPUTS, (uint16_t)layer->outputs);
    to[LAYER_AT_KERNEL] = (uint8_t)layer->kernel;
    to[LAYER_AT_STRIDE] = (uint8_t)layer->stride;
    to[LAYER_AT_PHASES] = (uint8_t)layer->phases;
    t3r_store_le16(to + LAYER_AT_ZERO, (uint16_t)zero);
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
    put_header(bytes, head);
    size_t at = T3R_WEIGHTS_HEADER_BYTES + (size_t)head->graph.count * T3R_WEIGHTS_LAYER_BYTES;
    for (uint32_t n = 0; n < head->graph.count; n++) {
        const head_layer *layer = &head->graph.layers[n];
        uint8_t *row = bytes + T3R_WEIGHTS_HEADER_BYTES + (size_t)n * T3R_WEIGHTS_LAYER_BYTES;
        put_row(row, layer, head->layers[n].zero);
        for (int b = 0; b < WEIGHT_BLOCKS; b++) {
            enum weight_block block = (enum weight_block)b;
            uint32_t step = weight_block_step(block, head->weight_bits, head->activation_bits);
            size_t length = weight_block_bytes(layer, block, head->weight_bits, head->activation_bits);
            t3r_store_le32(row + LAYER_AT_WEIGHTS + 4 * b, (uint32_t)at);
            for (size_t i = 0; i < length / step && head->layers[n].weight != NULL; i++) {
                weight_number_put(bytes + at + i * step, block_number(&head->layers[n], block, i), step);
            }
            at += aligned(length);
        }
    }
    weight_file_seal(bytes, *count);
    return bytes;
}
