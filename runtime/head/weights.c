/* The weight file checked: afterwards every offset, index, shift and sum of it is what the network counts on. */
#include "weights.h"

#include <stdbool.h>

#include "core/little_endian.h"

#define MAGIC 0x57523354u /* "T3RW" */
#define CRC_FROM 16
#define SHIFT_LEAST (-30)
#define SHIFT_MOST 15

/* CRC-32 of IEEE 802.3, four bits a step. */
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
        .macs_q8 = t3r_le_u32(p + 20),
        .parameters = t3r_le_u32(p + 24),
        .bytes = t3r_le_u32(p + 8),
        .crc = t3r_le_u32(p + 12),
    };
}

t3r_layer t3r_weights_layer(const void *weights, uint32_t index)
{
    const uint8_t *p = (const uint8_t *)weights + T3R_WEIGHTS_HEADER_BYTES + (size_t)index * T3R_WEIGHTS_LAYER_BYTES;
    return (t3r_layer){
        .kind = (t3r_layer_kind)p[0],
        .level = p[1],
        .source = {p[2], p[3]},
        .inputs = (uint16_t)t3r_le_u16(p + 4),
        .outputs = (uint16_t)t3r_le_u16(p + 6),
        .kernel = p[8],
        .stride = p[9],
        .phases = p[10],
        .zero = (int16_t)t3r_le_u16(p + 12),
        .weights = t3r_le_u32(p + 16),
        .bias = t3r_le_u32(p + 20),
        .multiplier = t3r_le_u32(p + 24),
        .shift = t3r_le_u32(p + 28),
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

static const char *header_error(const uint8_t *p, size_t bytes)
{
    if (bytes < T3R_WEIGHTS_HEADER_BYTES || t3r_le_u32(p) != MAGIC) {
        return "not a weight file";
    }
    if (t3r_le_u16(p + 4) != T3R_WEIGHTS_FORMAT) {
        return "a weight file of another format";
    }
    if (t3r_le_u16(p + 6) != T3R_BITS_EPOCH) {
        return "weights of another bits epoch";
    }
    t3r_weights_header header = t3r_weights_header_of(p);
    if (header.bytes != bytes || bytes > T3R_MAX_WEIGHTS_BYTES) {
        return "the file is not as long as it says, or over 16 MiB";
    }
    if (header.crc != crc_of(p + CRC_FROM, bytes - CRC_FROM)) {
        return "damaged: the CRC does not match";
    }
    if ((header.weight_bits != 8 && header.weight_bits != 16) ||
        (header.activation_bits != 8 && header.activation_bits != 16)) {
        return "weights and activations must have 8 or 16 bits";
    }
    if (p[19] != T3R_FEATURE_SET) {
        return "made for other features";
    }
    if (!is_name(p + 32) || !all_zero(p + 28, 4) || !all_zero(p + 48, 16)) {
        return "the header's name or reserved bytes are not as they must be";
    }
    if (header.layers < 1 || header.layers > T3R_MAX_LAYERS ||
        bytes < T3R_WEIGHTS_HEADER_BYTES + header.layers * T3R_WEIGHTS_LAYER_BYTES) {
        return "layers must be 1..24, their table in the file";
    }
    return NULL;
}

/* Shape: what of a layer is said without looking at another. */
static const char *shape_error(const uint8_t *row, const t3r_layer *layer)
{
    if (row[0] >= T3R_LAYER_KINDS || row[11] != 0 || row[14] != 0 || row[15] != 0) {
        return "a layer's kind or reserved bytes are not as they must be";
    }
    if (layer->inputs < 1 || layer->inputs > T3R_MAX_CHANNELS || layer->outputs < 1 ||
        layer->outputs > T3R_MAX_CHANNELS) {
        return "a layer's channels must be 1..128";
    }
    bool point = layer->kind == T3R_LAYER_POINT, depthwise = layer->kind == T3R_LAYER_DEPTHWISE;
    if (point) {
        bool sound =
            layer->level == 0 && layer->kernel == 1 && layer->stride == 1 && (layer->phases == 1 || layer->phases == 4);
        return sound ? NULL : "a point layer's level, kernel, stride and phases must be 0, 1, 1 and 1 or 4";
    }
    if (layer->level > T3R_MAX_LEVEL || layer->stride < 1 || layer->stride > 2 || layer->level + 1 < layer->stride ||
        layer->phases != 1) {
        return "a layer's level, stride or phases are out of range";
    }
    if (layer->kernel < 1 || layer->kernel > (depthwise ? 5 : T3R_MAX_KERNEL)) {
        return "a layer's kernel is out of range";
    }
    return depthwise && layer->outputs != layer->inputs ? "a depthwise layer's outputs must be its inputs" : NULL;
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

static const char *source_error(const void *weights, uint32_t n, const t3r_layer *layer)
{
    bool second = layer->source[1] != T3R_SOURCE_NONE;
    uint32_t channels = 0;
    if (!may_read(weights, n, layer, layer->source[0], &channels) ||
        (second && (layer->kind == T3R_LAYER_DEPTHWISE || !may_read(weights, n, layer, layer->source[1], &channels)))) {
        return "a layer's source is none that it may read";
    }
    if (channels != layer->inputs) {
        return "a layer's inputs are not the channels of its sources";
    }
    if (layer->kind != T3R_LAYER_POINT && n > 1 && t3r_weights_layer(weights, n - 2).kind == T3R_LAYER_POINT) {
        return "a layer stands behind a point layer";
    }
    return NULL;
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

/* Whether no order of an output's sum can leave its accumulator. At most 36 x 128 weights of at most 2^15 are summed,
 * times 2^15: below 2^43, and with any bias below 2^64. */
static bool sum_fits(const uint8_t *file, const t3r_weights_header *header, const t3r_layer *layer, uint32_t phase,
                     uint32_t output)
{
    bool depthwise = layer->kind == T3R_LAYER_DEPTHWISE, wide = header->activation_bits == 16;
    uint32_t taps = t3r_layer_taps(layer), row = phase * layer->outputs + output;
    uint32_t at = depthwise ? output : row * taps, step = depthwise ? layer->outputs : 1;
    uint64_t sum = 0;
    for (uint32_t t = 0; t < taps; t++, at += step) {
        const uint8_t *p = file + layer->weights + (size_t)at * (header->weight_bits / 8);
        sum += magnitude(header->weight_bits == 8 ? (int8_t)*p : (int16_t)t3r_le_u16(p));
    }
    const uint8_t *bias = file + layer->bias + (size_t)row * (wide ? 8 : 4);
    return wide ? magnitude(t3r_le_i64(bias)) + (sum << 15) < (uint64_t)1 << 47
                : magnitude(t3r_le_i32(bias)) + (sum << 7) < (uint64_t)1 << 31;
}

static const char *block_error(const uint8_t *file, const t3r_weights_header *header, const t3r_layer *layer)
{
    uint32_t rows = (uint32_t)layer->phases * layer->outputs;
    if (!in_file(layer->weights, (uint64_t)rows * t3r_layer_taps(layer) * (header->weight_bits / 8), header) ||
        !in_file(layer->bias, (uint64_t)rows * (header->activation_bits == 16 ? 8 : 4), header) ||
        !in_file(layer->multiplier, (uint64_t)layer->outputs * 4, header) ||
        !in_file(layer->shift, layer->outputs, header)) {
        return "a layer's block lies outside the file or is not aligned to 16";
    }
    for (uint32_t o = 0; o < layer->outputs; o++) {
        int8_t shift = (int8_t)file[layer->shift + o];
        if (t3r_le_i32(file + layer->multiplier + (size_t)o * 4) < 1 << 30 || shift < SHIFT_LEAST ||
            shift > SHIFT_MOST) {
            return "a multiplier or shift is out of range";
        }
        for (uint32_t phase = 0; phase < layer->phases; phase++) {
            if (!sum_fits(file, header, layer, phase, o)) {
                return "a layer's sums could leave their accumulators";
            }
        }
    }
    return NULL;
}

static const char *layer_error(const uint8_t *file, const t3r_weights_header *header, uint32_t n)
{
    t3r_layer layer = t3r_weights_layer(file, n - 1);
    const char *error =
        shape_error(file + T3R_WEIGHTS_HEADER_BYTES + (size_t)(n - 1) * T3R_WEIGHTS_LAYER_BYTES, &layer);
    if (error == NULL) {
        error = source_error(file, n, &layer);
    }
    if (error == NULL && header->activation_bits == 8 && n < header->layers &&
        (layer.zero < -128 || layer.zero > 127)) {
        error = "an output zero is no int8";
    }
    return error != NULL ? error : block_error(file, header, &layer);
}

/* What holds of the layers together: the last layer, the counts in the header, and that every output is read. At most
 * 24 layers of 36 x 128 x 128 multiply-accumulates in Q8: below 2^32. */
static const char *graph_error(const uint8_t *file, const t3r_weights_header *header)
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
        return "the last layer is not a linear point layer of 9 outputs";
    }
    if (unread != 1u << header->layers) {
        return "a layer is read by none";
    }
    if (macs_q8 != header->macs_q8 || parameters != header->parameters) {
        return "the header's counts are not those of the layers";
    }
    return macs_q8 > T3R_MAX_HEAD_MACS << 8 ? "over 65536 multiply-accumulates a pixel" : NULL;
}

const char *t3r_weights_error(const void *weights, size_t bytes)
{
    if (weights == NULL || (uintptr_t)weights % T3R_WEIGHTS_ALIGN != 0) {
        return "no weights, or not aligned to 16 bytes";
    }
    const uint8_t *file = weights;
    const char *error = header_error(file, bytes);
    if (error != NULL) {
        return error;
    }
    t3r_weights_header header = t3r_weights_header_of(file);
    for (uint32_t n = 1; n <= header.layers && error == NULL; n++) {
        error = layer_error(file, &header, n);
    }
    return error != NULL ? error : graph_error(file, &header);
}

t3r_status t3r_weights_check(const void *weights, size_t bytes)
{
    if (weights == NULL || (uintptr_t)weights % T3R_WEIGHTS_ALIGN != 0) {
        return T3R_ERR_ARGUMENT;
    }
    return t3r_weights_error(weights, bytes) == NULL ? T3R_OK : T3R_ERR_WEIGHTS;
}
