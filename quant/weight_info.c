#include "weight_info.h"

#include <inttypes.h>
#include <string.h>

#include "le_bytes.h"
#include "quant_reason.h"
#include "trim3r.h"

typedef struct reader {
    weight_info *info;
    const uint8_t *bytes;
    size_t count;
    char *error;
    size_t error_bytes;
} reader;

/* Reports that field `name` of the header holds `value`, not `right`. */
static int fail_header(const reader *r, const char *name, uint64_t value, const char *right)
{
    return quant_reason(r->error, r->error_bytes, "header: %s is %" PRIu64 ", not %s", name, value, right);
}

static int fail_layer(const reader *r, uint32_t n, const char *what)
{
    return quant_reason(r->error, r->error_bytes, "layer %u: %s", (unsigned)n, what);
}

/* ---- header ------------------------------------------------------------------------------------------------------ */

static int read_frame(const reader *r)
{
    const uint8_t *b = r->bytes;
    if (r->count < T3R_WEIGHTS_HEADER_BYTES) {
        return quant_reason(r->error, r->error_bytes, "%zu bytes are no weight file: its header takes 64", r->count);
    }
    if (memcmp(b + WEIGHT_AT_MAGIC, "T3RW", 4) != 0) {
        return quant_reason(r->error, r->error_bytes, "does not begin with \"T3RW\": not a weight file");
    }
    uint64_t format = le_get(b + WEIGHT_AT_FORMAT, 2), bytes = le_get(b + WEIGHT_AT_BYTES, 4);
    if (format != T3R_WEIGHTS_FORMAT) {
        return fail_header(r, "the format", format, "1");
    }
    if (bytes != r->count) {
        return quant_reason(r->error, r->error_bytes,
                            "header: %" PRIu64 " bytes in all, but the file has %zu: cut off?", bytes, r->count);
    }
    if (bytes > T3R_MAX_WEIGHTS_BYTES) {
        return fail_header(r, "the number of bytes", bytes, "at most 16 MiB");
    }
    r->info->bytes = (uint32_t)bytes;
    r->info->crc = (uint32_t)le_get(b + WEIGHT_AT_CRC, 4);
    uint32_t crc = weight_file_crc(b, r->count);
    if (r->info->crc != crc) {
        return quant_reason(r->error, r->error_bytes,
                            "header: the CRC is %08" PRIx32 ", but that of the bytes is %08" PRIx32 ": damaged",
                            r->info->crc, crc);
    }
    r->info->bits_epoch = (uint32_t)le_get(b + WEIGHT_AT_EPOCH, 2);
    return r->info->bits_epoch == T3R_BITS_EPOCH
               ? 0
               : quant_reason(r->error, r->error_bytes,
                              "header: made for bits epoch %" PRIu32 ", this is epoch %d: quantize "
                              "it again",
                              r->info->bits_epoch, T3R_BITS_EPOCH);
}

static int read_name(const reader *r)
{
    const char *name = (const char *)r->bytes + WEIGHT_AT_NAME;
    char *to = r->info->graph.name;
    memcpy(to, name, HEAD_NAME_BYTES);
    if (to[HEAD_NAME_BYTES - 1] != '\0') {
        return quant_reason(r->error, r->error_bytes, "header: the name has no end");
    }
    for (size_t i = strlen(to); i < HEAD_NAME_BYTES; i++) {
        if (to[i] != '\0') {
            return quant_reason(r->error, r->error_bytes, "header: there is something behind the name");
        }
    }
    return head_name_check(to, r->error, r->error_bytes);
}

static int read_header(const reader *r)
{
    static const uint8_t zeros[T3R_WEIGHTS_HEADER_BYTES - WEIGHT_AT_RESERVED_END];
    const uint8_t *b = r->bytes;
    weight_info *info = r->info;
    if (read_frame(r) != 0) {
        return -1;
    }
    info->weight_bits = b[WEIGHT_AT_WEIGHT_BITS];
    info->activation_bits = b[WEIGHT_AT_ACTIVATION_BITS];
    info->graph.count = b[WEIGHT_AT_LAYERS];
    if (info->weight_bits != 8 && info->weight_bits != 16) {
        return fail_header(r, "the weights' width", info->weight_bits, "8 or 16");
    }
    if (info->activation_bits != 8 && info->activation_bits != 16) {
        return fail_header(r, "the activations' width", info->activation_bits, "8 or 16");
    }
    if (info->graph.count < 1 || info->graph.count > T3R_MAX_LAYERS) {
        return fail_header(r, "the number of layers", info->graph.count, "1..24");
    }
    if (b[WEIGHT_AT_FEATURE_SET] != T3R_FEATURE_SET) {
        return fail_header(r, "the feature set", b[WEIGHT_AT_FEATURE_SET], "1");
    }
    if (le_get(b + WEIGHT_AT_RESERVED, 4) != 0 || memcmp(b + WEIGHT_AT_RESERVED_END, zeros, sizeof zeros) != 0) {
        return quant_reason(r->error, r->error_bytes, "header: reserved bytes are not 0");
    }
    return read_name(r);
}

/* ---- layers ------------------------------------------------------------------------------------------------------ */

static int read_row(const reader *r, uint32_t n)
{
    const uint8_t *row = r->bytes + T3R_WEIGHTS_HEADER_BYTES + (size_t)(n - 1) * T3R_WEIGHTS_LAYER_BYTES;
    weight_info *info = r->info;
    int32_t lowest = info->activation_bits == 8 ? -128 : -32768;
    int32_t zero = (int32_t)le_get_signed(row + LAYER_AT_ZERO, 2);
    if (row[LAYER_AT_RESERVED] != 0 || le_get(row + LAYER_AT_RESERVED_2, 2) != 0) {
        return fail_layer(r, n, "reserved bytes are not 0");
    }
    if (n == info->graph.count && zero != 0) {
        return fail_layer(r, n, "the output zero of the last layer is not 0");
    }
    if (zero < lowest || zero >= -lowest) {
        return fail_layer(r, n, "the output zero is no activation");
    }
    info->zero[n - 1] = zero;
    info->graph.layers[n - 1] = (head_layer){
        .kind = (t3r_layer_kind)row[LAYER_AT_KIND],
        .level = row[LAYER_AT_LEVEL],
        .sources = {row[LAYER_AT_SOURCE], row[LAYER_AT_SOURCE + 1]},
        .inputs = (uint32_t)le_get(row + LAYER_AT_INPUTS, 2),
        .outputs = (uint32_t)le_get(row + LAYER_AT_OUTPUTS, 2),
        .kernel = row[LAYER_AT_KERNEL],
        .stride = row[LAYER_AT_STRIDE],
        .phases = row[LAYER_AT_PHASES],
        .relu = zero == lowest,
    };
    for (int b = 0; b < WEIGHT_BLOCKS; b++) {
        info->offset[n - 1][b] = (uint32_t)le_get(row + LAYER_AT_WEIGHTS + 4 * b, 4);
    }
    return 0;
}

static int check_blocks(const reader *r, uint32_t n)
{
    static const char *const outside[WEIGHT_BLOCKS] = {"weights lie outside the file", "bias lies outside the file",
                                                       "multipliers lie outside the file",
                                                       "shifts lie outside the file"};
    static const char *const crooked[WEIGHT_BLOCKS] = {"weights are not aligned to 16", "bias is not aligned to 16",
                                                       "multipliers are not aligned to 16",
                                                       "shifts are not aligned to 16"};
    const weight_info *info = r->info;
    size_t first = T3R_WEIGHTS_HEADER_BYTES + (size_t)info->graph.count * T3R_WEIGHTS_LAYER_BYTES;
    for (int b = 0; b < WEIGHT_BLOCKS; b++) {
        uint32_t at = info->offset[n - 1][b];
        if (at % T3R_WEIGHTS_ALIGN != 0) {
            return fail_layer(r, n, crooked[b]);
        }
        size_t bytes = weight_block_bytes(&info->graph.layers[n - 1], (enum weight_block)b, info->weight_bits,
                                          info->activation_bits);
        if (at < first || at > r->count || bytes > r->count - at) {
            return fail_layer(r, n, outside[b]);
        }
    }
    return 0;
}

static int64_t number(const reader *r, uint32_t n, enum weight_block block, size_t i)
{
    uint32_t step = weight_block_step(block, r->info->weight_bits, r->info->activation_bits);
    return le_get_signed(r->bytes + r->info->offset[n - 1][block] + i * step, step);
}

static int check_requantization(const reader *r, uint32_t n)
{
    for (uint32_t o = 0; o < r->info->graph.layers[n - 1].outputs; o++) {
        if (number(r, n, BLOCK_MULTIPLIER, o) < INT64_C(1) << 30) {
            return fail_layer(r, n, "a multiplier is not in [2^30, 2^31)");
        }
        int64_t shift = number(r, n, BLOCK_SHIFT, o);
        if (shift < -30 || shift > 15) {
            return fail_layer(r, n, "a shift is not in [-30, 15]");
        }
    }
    return 0;
}

/* Checks |bias| + reach x sum |weight| of every output and phase against the accumulator's width. */
static int check_accumulators(const reader *r, uint32_t n)
{
    const head_layer *layer = &r->info->graph.layers[n - 1];
    const bool point = layer->kind == T3R_LAYER_POINT, narrow = r->info->activation_bits == 8;
    const uint64_t reach = narrow ? 1u << 7 : 1u << 15, most = UINT64_C(1) << (narrow ? 31 : 47);
    for (size_t b = 0; b < head_bias_count(layer); b++) {
        uint32_t o = (uint32_t)(b % layer->outputs), phase = (uint32_t)(b / layer->outputs);
        uint32_t first = point ? phase : 0, end = point ? phase + 1 : head_taps(layer);
        int64_t bias = number(r, n, BLOCK_BIAS, b);
        uint64_t sum = 0, amount = bias < 0 ? 0 - (uint64_t)bias : (uint64_t)bias;
        for (uint32_t t = first; t < end; t++) {
            for (uint32_t i = 0; i < head_fan_in(layer); i++) {
                int64_t weight = number(r, n, BLOCK_WEIGHTS, head_weight_index(layer, o, i, t));
                sum += (uint64_t)(weight < 0 ? -weight : weight);
            }
        }
        if (amount >= most || amount + reach * sum >= most) {
            return fail_layer(r, n, "weights and bias could overflow the accumulator");
        }
    }
    return 0;
}

int weight_info_read(weight_info *info, const uint8_t *bytes, size_t count, char *error, size_t error_bytes)
{
    *info = (weight_info){0};
    reader r = {.info = info, .bytes = bytes, .count = count, .error = error, .error_bytes = error_bytes};
    if (read_header(&r) != 0) {
        return -1;
    }
    if (count < T3R_WEIGHTS_HEADER_BYTES + (size_t)info->graph.count * T3R_WEIGHTS_LAYER_BYTES) {
        return quant_reason(error, error_bytes, "the table of layers is cut off");
    }
    for (uint32_t n = 1; n <= info->graph.count; n++) {
        if (read_row(&r, n) != 0) {
            return -1;
        }
    }
    if (head_graph_check(&info->graph, error, error_bytes) != 0) {
        return -1;
    }
    for (uint32_t n = 1; n <= info->graph.count; n++) {
        if (check_blocks(&r, n) != 0 || check_requantization(&r, n) != 0 || check_accumulators(&r, n) != 0) {
            return -1;
        }
    }
    info->macs_q8 = (uint32_t)le_get(bytes + WEIGHT_AT_MACS, 4);
    info->parameters = (uint32_t)le_get(bytes + WEIGHT_AT_PARAMETERS, 4);
    if (info->macs_q8 != weight_macs_q8(&info->graph)) {
        return fail_header(&r, "the number of multiply-accumulates", info->macs_q8, "that of the layers");
    }
    if (info->parameters != weight_parameters(&info->graph)) {
        return fail_header(&r, "the number of parameters", info->parameters, "that of the layers");
    }
    return 0;
}

void weight_info_of_graph(weight_info *info, const head_graph *graph, uint32_t weight_bits, uint32_t activation_bits)
{
    *info = (weight_info){
        .graph = *graph,
        .bits_epoch = T3R_BITS_EPOCH,
        .weight_bits = weight_bits,
        .activation_bits = activation_bits,
        .bytes = (uint32_t)weight_file_bytes(graph, weight_bits, activation_bits),
        .macs_q8 = weight_macs_q8(graph),
        .parameters = weight_parameters(graph),
    };
}

size_t weight_info_layer_bytes(const weight_info *info, uint32_t n)
{
    size_t bytes = 0;
    for (int b = 0; b < WEIGHT_BLOCKS; b++) {
        bytes += weight_block_bytes(&info->graph.layers[n - 1], (enum weight_block)b, info->weight_bits,
                                    info->activation_bits);
    }
    return bytes;
}
