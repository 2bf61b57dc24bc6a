/* SPDX-License-Identifier: Apache-2.0 */
/* The .t3w weight file: a quantized head as it lies in flash (SPEC.md, "Weights").
 *
 * Little-endian throughout and used in place. A header of 64 bytes, a table of layers of 32 bytes each, then the
 * blocks that the table points to, each aligned to 16. Nothing in it is trusted: t3r_weights_check() reads it once,
 * when a head is bound; after that the layers are walked without further checks.
 *
 *   header   0 "T3RW" | 4 u16 format (1) | 6 u16 bits epoch | 8 u32 bytes in all | 12 u32 CRC-32 (IEEE) of byte 16 on
 *           16 u8 weight bits (8, 16) | 17 u8 activation bits (8, 16) | 18 u8 layers | 19 u8 feature set (1)
 *           20 u32 multiply-accumulates a pixel at 100 % kept, Q8 (exact: level 4 is 1/256 of the pixels)
 *           24 u32 parameters: weights and biases | 28 u32 0
 *           32 name, 16 bytes: 1..15 of a-z 0-9 _, the rest 0 | 48 16 bytes 0
 *   layer    0 u8 kind (t3r_layer_kind) | 1 u8 level | 2 u8 source[2] | 4 u16 inputs | 6 u16 outputs
 *            8 u8 kernel | 9 u8 stride | 10 u8 phases | 11 u8 0 | 12 i16 output zero | 14 u16 0
 *           16 u32 weights | 20 u32 bias | 24 u32 multiplier | 28 u32 shift: offsets from the start of the file
 *
 * Layers come in the order in which they run. Source 0 is the feature planes (level 0, T3R_FEATURES channels, zero
 * point 0), source n the output of layer n (counted from 1), source 255 none; a source comes before its reader. A layer
 * of level l has ceil(width / 2^l) x ceil(height / 2^l) pixels. Where it reads two sources their channels follow each
 * other, first the first's; a source coarser than wanted is read at x >> difference: nearest-neighbour upsampling.
 *
 *   conv       kernel k of 1..6, stride s of 1 or 2, its sources' grid being of level (level - log2 s) or coarser.
 *              Output (x, y) reads columns s x - p .. s x - p + k - 1, p = (k - s + 1) / 2 rounded down, rows likewise;
 *              outside the grid is the source's zero point. Weights [outputs][k][k][inputs].
 *   depthwise  the same with outputs = inputs, kernel of 1..5, one source. Weights [k][k][outputs].
 *   point      evaluated at retained pixels only: each source at (x >> level, y >> level) of its own level, or the
 *              output of the point layer before (source = that layer). phases 1, or 4: weights of phase
 *              2 (y & 1) + (x & 1). Weights [phases][outputs][inputs], bias [phases][outputs]; multiplier and shift
 *              [outputs] in every kind. Level 0, kernel and stride 1. No other layer reads a point layer, and a point
 *              layer none but the one directly before it. Phases are 1 in the other kinds.
 *
 * Point layers follow all others, and every layer but the last is read by a later one. The blocks follow the table in
 * any order and may share bytes.
 *
 * Arithmetic: acc = bias + sum weight x (activation - zero point of its source). Zero points are folded into the bias
 * (bias' = bias - sum weight x zero), so that padding reads the zero point itself; the file holds bias', and
 * acc = bias' + sum weight x activation. No order of the sum can overflow: for every output (and phase)
 * |bias'| + 2^7 sum |weight| < 2^31 with int8 activations, |bias'| + 2^15 sum |weight| < 2^47 with int16 ones, so that
 * the product with the multiplier stays within 2^62. With int16 activations features are the int8 numbers times 2^8,
 * about as large as the activations beside them, so that weights of 8 bits resolve both.
 *
 * int8 activations: int32 accumulators, output = clamp(output zero + round_half_up(acc x multiplier / 2^(31 - shift))),
 * multiplier an int32 in [2^30, 2^31), shift an int8 in [-30, 15], the quotient 64 bits wide until it is clamped:
 * TFLite's single-rounding reference. int16 activations: int64 accumulators, multiplier reduced to 16 bits first,
 * ((multiplier + 2^15) >> 16, at most 32767), over 2^(15 - shift), as TFLite's int64 reference. ReLU is the clamp at an
 * output zero of -128 (int16: -32768); a linear layer has output zero 0. Weights int8 or int16; bias int32 (int16
 * activations: int64); multiplier int32; shift int8.
 *
 * The last layer is a point layer of T3R_HEAD_OUTPUTS channels whose output is always int16, output zero 0, in the
 * formats of t3r_head_output. */
#ifndef T3R_WEIGHTS_H
#define T3R_WEIGHTS_H

#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

#define T3R_WEIGHTS_FORMAT 1
#define T3R_WEIGHTS_HEADER_BYTES 64
#define T3R_WEIGHTS_LAYER_BYTES 32
#define T3R_WEIGHTS_ALIGN 16
#define T3R_FEATURE_SET 1
#define T3R_FEATURES 9 /* channels of the feature planes, head_features.h */
#define T3R_MAX_LAYERS 24
#define T3R_MAX_LEVEL 4
#define T3R_MAX_CHANNELS 128 /* of a layer's inputs and of its outputs */
#define T3R_MAX_KERNEL 6
#define T3R_MAX_WEIGHTS_BYTES (1u << 24)
#define T3R_MAX_HEAD_MACS 65536u /* multiply-accumulates a pixel at 100 % kept */
#define T3R_SOURCE_FEATURES 0
#define T3R_SOURCE_NONE 255

typedef enum t3r_layer_kind { T3R_LAYER_CONV, T3R_LAYER_DEPTHWISE, T3R_LAYER_POINT, T3R_LAYER_KINDS } t3r_layer_kind;

/* The last layer's channels. */
typedef enum t3r_head_output {
    T3R_OUT_OFFSET_X, /* Q14, in units of the local spacing: +-2 */
    T3R_OUT_OFFSET_Y,
    T3R_OUT_LOG_L11, /* Q13, log2 of the Cholesky factor's diagonal over the spacing: +-4 */
    T3R_OUT_LOG_L22,
    T3R_OUT_L21,     /* Q14, over the spacing: +-2 */
    T3R_OUT_OPACITY, /* Q15: below 0 is 0 */
    T3R_OUT_RED,     /* Q7, 8-bit levels added to the pixel's own colour: +-256 */
    T3R_OUT_GREEN,
    T3R_OUT_BLUE,
    T3R_HEAD_OUTPUTS
} t3r_head_output;

/* The header of a file that was checked. */
typedef struct t3r_weights_header {
    uint32_t weight_bits, activation_bits; /* 8 or 16 */
    uint32_t layers;
    uint32_t macs_q8;
    uint32_t parameters;
    uint32_t bytes;
    uint32_t crc;
} t3r_weights_header;

/* A layer; the last four are offsets from the start of the file. */
typedef struct t3r_layer {
    t3r_layer_kind kind;
    uint8_t level, source[2], kernel, stride, phases;
    uint16_t inputs, outputs;
    int16_t zero;
    uint32_t weights, bias, multiplier, shift;
} t3r_layer;

/* Faults that t3r_weights_check() finds. The texts are separate, so that a firmware links them only if it uses them. */
#define T3R_WEIGHTS_FAULTS(X)                                                                                          \
    X(FOREIGN, "not a weight file")                                                                                    \
    X(FORMAT, "a weight file of another format")                                                                       \
    X(EPOCH, "weights of another bits epoch")                                                                          \
    X(LENGTH, "the file is not as long as it says, or over 16 MiB")                                                    \
    X(CRC, "damaged: the CRC does not match")                                                                          \
    X(BITS, "weights and activations must have 8 or 16 bits")                                                          \
    X(FEATURES, "made for other features")                                                                             \
    X(HEADER, "the header's name or reserved bytes are not as they must be")                                           \
    X(LAYERS, "layers must be 1..24, their table in the file")                                                         \
    X(KIND, "a layer's kind or reserved bytes are not as they must be")                                                \
    X(CHANNELS, "a layer's channels must be 1..128")                                                                   \
    X(POINT, "a point layer's level, kernel, stride and phases must be 0, 1, 1 and 1 or 4")                            \
    X(SHAPE, "a layer's level, stride or phases are out of range")                                                     \
    X(KERNEL, "a layer's kernel is out of range")                                                                      \
    X(DEPTHWISE, "a depthwise layer's outputs must be its inputs")                                                     \
    X(SOURCE, "a layer's source is none that it may read")                                                             \
    X(INPUTS, "a layer's inputs are not the channels of its sources")                                                  \
    X(BEHIND_POINT, "a layer follows a point layer")                                                                   \
    X(BLOCK, "a layer's block lies outside the file or is not aligned to 16")                                          \
    X(MULTIPLIER, "a multiplier or shift is out of range")                                                             \
    X(SUMS, "a layer's sums could leave their accumulators")                                                           \
    X(ZERO, "an output zero is no int8")                                                                               \
    X(LAST, "the last layer is not a linear point layer of 9 outputs")                                                 \
    X(UNREAD, "a layer is read by none")                                                                               \
    X(COUNTS, "the header's counts are not those of the layers")                                                       \
    X(COST, "over 65536 multiply-accumulates a pixel")                                                                 \
    X(MISALIGNED, "no weights, or not aligned to 16 bytes")

#define T3R_WEIGHTS_FAULT_(NAME, text) T3R_FAULT_##NAME,
typedef enum t3r_weights_fault { T3R_FAULT_NONE, T3R_WEIGHTS_FAULTS(T3R_WEIGHTS_FAULT_) } t3r_weights_fault;

t3r_weights_fault t3r_weights_fault_of(const void *weights, size_t bytes);

/* Checks a weight file. T3R_ERR_ARGUMENT: null or not aligned to T3R_WEIGHTS_ALIGN; T3R_ERR_WEIGHTS:
 * t3r_weights_error() has the reason. */
t3r_status t3r_weights_check(const void *weights, size_t bytes);

/* Return the header, and layer `index` from 0, of checked weights. */
t3r_weights_header t3r_weights_header_of(const void *weights);
t3r_layer t3r_weights_layer(const void *weights, uint32_t index);

/* Returns the number of weights that a layer reads for one output of one pixel; contiguous except in a depthwise
 * layer. */
static inline uint32_t t3r_layer_taps(const t3r_layer *layer)
{
    return (uint32_t)layer->kernel * layer->kernel * (layer->kind == T3R_LAYER_DEPTHWISE ? 1u : layer->inputs);
}

#endif
