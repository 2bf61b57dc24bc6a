/* SPDX-License-Identifier: Apache-2.0 */
/* Checks a weight file: afterwards every offset, index, shift and sum is as the network requires. */
#include "weights.h"

#include <stdbool.h>

#include "core/little_endian.h"

#define MAGIC 0x57523354u /* "T3RW" */
#define CRC_FROM 16
#define SHIFT_LEAST (-30)
#define SHIFT_MOST 15

/* Computes the CRC-32 of IEEE 802.3, four bits a step. */
static uint32_t crc_of(const uint8_t *bytes, size_t count)
{
    static const uint32_t step[16] = {
        0x00000000, 0x1db71064, 0x3b6e20c8, 0x26d930ac, 0x76dc4190, 0x6b6b51f4, 0x4db26158, 0x5005713c,
        0xedb88320, 0xf00f9344, 0xd6d6a3e8, 0xcb61b38c, 0x9b64c2b0, 0x86d3d2d4, 0xa00ae278, 0xbdbdf21c,
    };
    uint32_t crc = UINT32_MAX;
    for (size_t i = 0; i < count; i++) {
        crc ^= bytes[i];
        crc = crc >> 4 ^ step[crc & 15];
        crc = crc >> 4 ^ step[crc & 15];
    }
    return ~crc;
}

t3r_weights_header t3r_weights_header_of(const void *weights)
{
    const uint8_t *p = weights;
    return (t3r_weights_header){
        .weight_bits = p[16],
        .activation_bits = p[17],
        .layers = p[18],
        .macs_q8 = t3r_load_le32(p + 20),
        .parameters = t3r_load_le32(p + 24),
        .bytes = t3r_load_le32(p + 8),
        .crc = t3r_load_le32(p + 12),
    };
}

t3r_layer t3r_weights_layer(const void *weights, uint32_t index)
{
    const uint8_t *p = (const uint8_t *)weights + T3R_WEIGHTS_HEADER_BYTES + (size_t)index * T3R_WEIGHTS_LAYER_BYTES;
    return (t3r_layer){
        .kind = (t3r_layer_kind)p[0],
        .level = p[1],
        .source = {p[2], p[3]},
        .inputs = t3r_load_le16(p + 4),
        .outputs = t3r_load_le16(p + 6),
        .kernel = p[8],
        .stride = p[9],
        .phases = p[10],
        .zero = (int16_t)t3r_load_le16(p + 12),
        .weights = t3r_load_le32(p + 16),
        .bias = t3r_load_le32(p + 20),
        .multiplier = t3r_load_le32(p + 24),
        .shift = t3r_load_le32(p + 28),
    };
}

static bool all_zero(const uint8_t *bytes, size_t count)
{
    uint8_t any = 0;
    for (size_t i = 0; i < count; i++) {
        any |= bytes[i];
    }
    return any == 0;
}

static bool is_name(const uint8_t name[16])
{
    uint32_t length = 0;
    while (length < 16 && name[length] != 0) {
        uint8_t c = name[length++];
        if (!((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_')) {
            return false;
        }
    }
    return length > 0 && length < 16 && all_zero(name + length, 16 - length);
}

static t3r_weights_fault header_fault(const uint8_t *p, size_t bytes)
{
    if (bytes < T3R_WEIGHTS_HEADER_BYTES || t3r_load_le32(p) != MAGIC) {
        return T3R_FAULT_FOREIGN;
    }
    if (t3r_load_le16(p + 4) != T3R_WEIGHTS_FORMAT) {
        return T3R_FAULT_FORMAT;
    }
    if (t3r_load_le16(p + 6) != T3R_BITS_EPOCH) {
        return T3R_FAULT_EPOCH;
    }
    t3r_weights_header header = t3r_weights_header_of(p);
    if (header.bytes != bytes || bytes > T3R_MAX_WEIGHTS_BYTES) {
        return T3R_FAULT_LENGTH;
    }
    if (header.crc != crc_of(p + CRC_FROM, bytes - CRC_FROM)) {
        return T3R_FAULT_CRC;
    }
    if ((header.weight_bits != 8 && header.weight_bits != 16) ||
        (header.activation_bits != 8 && header.activation_bits != 16)) {
        return T3R_FAULT_BITS;
    }
    if (p[19] != T3R_FEATURE_SET) {
        return T3R_FAULT_FEATURES;
    }
    if (!is_name(p + 32) || !all_zero(p + 28, 4) || !all_zero(p + 48, 16)) {
        return T3R_FAULT_HEADER;
    }
    if (header.layers < 1 || header.layers > T3R_MAX_LAYERS ||
        bytes < T3R_WEIGHTS_HEADER_BYTES + header.layers * T3R_WEIGHTS_LAYER_BYTES) {
        return T3R_FAULT_LAYERS;
    }
    return T3R_FAULT_NONE;
}

/* Checks the properties of a layer that do not depend on others. */
static t3r_weights_fault shape_fault(const uint8_t *row, const t3r_layer *layer)
{
    if (row[0] >= T3R_LAYER_KINDS || row[11] != 0 || row[14] != 0 || row[15] != 0) {
        return T3R_FAULT_KIND;
    }
    if (layer->inputs < 1 || layer->inputs > T3R_MAX_CHANNELS || layer->outputs < 1 ||
        layer->outputs > T3R_MAX_CHANNELS) {
        return T3R_FAULT_CHANNELS;
    }
    bool point = layer->kind == T3R_LAYER_POINT, depthwise = layer->kind == T3R_LAYER_DEPTHWISE;
    if (point) {
        bool sound =
            layer->level == 0 && layer->kernel == 1 && layer->stride == 1 && (layer->phases == 1 || layer->phases == 4);
        return sound ? T3R_FAULT_NONE : T3R_FAULT_POINT;
    }
    if (layer->level > T3R_MAX_LEVEL || layer->stride < 1 || layer->stride > 2 || layer->level + 1 < layer->stride ||
        layer->phases != 1) {
        return T3R_FAULT_SHAPE;
    }
    if (layer->kernel < 1 || layer->kernel > (depthwise ? 5 : T3R_MAX_KERNEL)) {
        return T3R_FAULT_KERNEL;
    }
    return depthwise && layer->outputs != layer->inputs ? T3R_FAULT_DEPTHWISE : T3R_FAULT_NONE;
}

/* Whether layer n (from 1) may read the source. Adds its channels. */
static bool may_read(const void *weights, uint32_t n, const t3r_layer *layer, uint32_t source, uint32_t *channels)
{
    if (source >= n) {
        return false;
    }
    if (source == T3R_SOURCE_FEATURES) {
        *channels += T3R_FEATURES;
        return layer->kind == T3R_LAYER_POINT || layer->level + 1 == layer->stride;
    }
    t3r_layer from = t3r_weights_layer(weights, source - 1);
    *channels += from.outputs;
    if (layer->kind == T3R_LAYER_POINT) {
        return from.kind != T3R_LAYER_POINT || source == n - 1;
    }
    return from.kind != T3R_LAYER_POINT && from.level + layer->stride - 1 >= layer->level;
}

static t3r_weights_fault source_fault(const void *weights, uint32_t n, const t3r_layer *layer)
{
    bool second = layer->source[1] != T3R_SOURCE_NONE;
    uint32_t channels = 0;
    if (!may_read(weights, n, layer, layer->source[0], &channels) ||
        (second && (layer->kind == T3R_LAYER_DEPTHWISE || !may_read(weights, n, layer, layer->source[1], &channels)))) {
        return T3R_FAULT_SOURCE;
    }
    if (channels != layer->inputs) {
        return T3R_FAULT_INPUTS;
    }
    if (layer->kind != T3R_LAYER_POINT && n > 1 && t3r_weights_layer(weights, n - 2).kind == T3R_LAYER_POINT) {
        return T3R_FAULT_BEHIND_POINT;
    }
    return T3R_FAULT_NONE;
}

static bool in_file(uint32_t offset, uint64_t block, const t3r_weights_header *header)
{
    uint32_t first = T3R_WEIGHTS_HEADER_BYTES + header->layers * T3R_WEIGHTS_LAYER_BYTES;
    return offset % T3R_WEIGHTS_ALIGN == 0 && offset >= first && offset <= header->bytes &&
           block <= header->bytes - offset;
}

static uint64_t magnitude(int64_t x)
{
    return x < 0 ? 0 - (uint64_t)x : (uint64_t)x;
}

/* Whether an output's sum stays within its accumulator in any order. At most 36 x 128 weights of at most 2^15 are
 * summed, times 2^15: below 2^43, and with any bias below 2^64. */
static bool sum_fits(const uint8_t *file, const t3r_weights_header *header, const t3r_layer *layer, uint32_t phase,
                     uint32_t output)
{
    bool depthwise = layer->kind == T3R_LAYER_DEPTHWISE, wide = header->activation_bits == 16;
    uint32_t taps = t3r_layer_taps(layer), row = phase * layer->outputs + output;
    uint32_t at = depthwise ? output : row * taps, step = depthwise ? layer->outputs : 1;
    uint64_t sum = 0;
    for (uint32_t t = 0; t < taps; t++, at += step) {
        const uint8_t *p = file + layer->weights + (size_t)at * (header->weight_bits / 8);
        sum += magnitude(header->weight_bits == 8 ? (int8_t)*p : (int16_t)t3r_load_le16(p));
    }
    const uint8_t *bias = file + layer->bias + (size_t)row * (wide ? 8 : 4);
    return wide ? magnitude((int64_t)t3r_load_le64(bias)) + (sum << 15) < (uint64_t)1 << 47
                : magnitude((int32_t)t3r_load_le32(bias)) + (sum << 7) < (uint64_t)1 << 31;
}

static t3r_weights_fault block_fault(const uint8_t *file, const t3r_weights_header *header, const t3r_layer *layer)
{
    uint32_t rows = (uint32_t)layer->phases * layer->outputs;
    if (!in_file(layer->weights, (uint64_t)rows * t3r_layer_taps(layer) * (header->weight_bits / 8), header) ||
        !in_file(layer->bias, (uint64_t)rows * (header->activation_bits == 16 ? 8 : 4), header) ||
        !in_file(layer->multiplier, (uint64_t)layer->outputs * 4, header) ||
        !in_file(layer->shift, layer->outputs, header)) {
        return T3R_FAULT_BLOCK;
    }
    for (uint32_t o = 0; o < layer->outputs; o++) {
        int8_t shift = (int8_t)file[layer->shift + o];
        if ((int32_t)t3r_load_le32(file + layer->multiplier + (size_t)o * 4) < 1 << 30 || shift < SHIFT_LEAST ||
            shift > SHIFT_MOST) {
            return T3R_FAULT_MULTIPLIER;
        }
        for (uint32_t phase = 0; phase < layer->phases; phase++) {
            if (!sum_fits(file, header, layer, phase, o)) {
                return T3R_FAULT_SUMS;
            }
        }
    }
    return T3R_FAULT_NONE;
}

static t3r_weights_fault layer_fault(const uint8_t *file, const t3r_weights_header *header, uint32_t n)
{
    t3r_layer layer = t3r_weights_layer(file, n - 1);
    t3r_weights_fault fault =
        shape_fault(file + T3R_WEIGHTS_HEADER_BYTES + (size_t)(n - 1) * T3R_WEIGHTS_LAYER_BYTES, &layer);
    if (fault == T3R_FAULT_NONE) {
        fault = source_fault(file, n, &layer);
    }
    if (fault == T3R_FAULT_NONE && header->activation_bits == 8 && n < header->layers &&
        (layer.zero < -128 || layer.zero > 127)) {
        fault = T3R_FAULT_ZERO;
    }
    return fault != T3R_FAULT_NONE ? fault : block_fault(file, header, &layer);
}

/* Checks the layers together: the last layer, the counts in the header, and that every output is read. At most 24
 * layers of 36 x 128 x 128 multiply-accumulates in Q8: below 2^32. */
static t3r_weights_fault graph_fault(const uint8_t *file, const t3r_weights_header *header)
{
    uint32_t macs_q8 = 0, parameters = 0, unread = 0;
    for (uint32_t n = 1; n <= header->layers; n++) {
        t3r_layer layer = t3r_weights_layer(file, n - 1);
        uint32_t macs = layer.outputs * t3r_layer_taps(&layer);
        macs_q8 += macs << (8 - 2 * layer.level);
        parameters += layer.phases * (macs + layer.outputs);
        unread |= 1u << n;
        for (int i = 0; i < 2; i++) {
            unread &= layer.source[i] == T3R_SOURCE_NONE ? UINT32_MAX : ~(1u << layer.source[i]);
        }
    }
    t3r_layer last = t3r_weights_layer(file, header->layers - 1);
    if (last.kind != T3R_LAYER_POINT || last.outputs != T3R_HEAD_OUTPUTS || last.zero != 0) {
        return T3R_FAULT_LAST;
    }
    if (unread != 1u << header->layers) {
        return T3R_FAULT_UNREAD;
    }
    if (macs_q8 != header->macs_q8 || parameters != header->parameters) {
        return T3R_FAULT_COUNTS;
    }
    return macs_q8 > T3R_MAX_HEAD_MACS << 8 ? T3R_FAULT_COST : T3R_FAULT_NONE;
}

t3r_weights_fault t3r_weights_fault_of(const void *weights, size_t bytes)
{
    if (weights == NULL || (uintptr_t)weights % T3R_WEIGHTS_ALIGN != 0) {
        return T3R_FAULT_MISALIGNED;
    }
    const uint8_t *file = weights;
    t3r_weights_fault fault = header_fault(file, bytes);
    if (fault != T3R_FAULT_NONE) {
        return fault;
    }
    t3r_weights_header header = t3r_weights_header_of(file);
    for (uint32_t n = 1; n <= header.layers && fault == T3R_FAULT_NONE; n++) {
        fault = layer_fault(file, &header, n);
    }
    return fault != T3R_FAULT_NONE ? fault : graph_fault(file, &header);
}

t3r_status t3r_weights_check(const void *weights, size_t bytes)
{
    const t3r_weights_fault fault = t3r_weights_fault_of(weights, bytes);
    return fault == T3R_FAULT_NONE ? T3R_OK : fault == T3R_FAULT_MISALIGNED ? T3R_ERR_ARGUMENT : T3R_ERR_WEIGHTS;
}
