/* SPDX-License-Identifier: Apache-2.0 */
#include "weights_maker.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define CONV T3R_LAYER_CONV
#define POINT T3R_LAYER_POINT
#define NONE T3R_SOURCE_NONE

/* An encoder of three levels, a decoder back to the first, two point layers. */
#define SHAPE(A, B, C)                                                                                                 \
    {                                                                                                                  \
        {CONV, 1, {0, NONE}, 6, 2, 1, A}, {CONV, 1, {1, NONE}, 3, 1, 1, A}, {CONV, 2, {2, NONE}, 3, 2, 1, B},          \
            {CONV, 2, {3, NONE}, 3, 1, 1, B}, {CONV, 3, {4, NONE}, 3, 2, 1, C}, {CONV, 3, {5, NONE}, 3, 1, 1, C},      \
            {CONV, 2, {4, 6}, 3, 1, 1, B}, {CONV, 1, {2, 7}, 3, 1, 1, A}, {POINT, 0, {8, 0}, 1, 1, 4, 32},             \
            {POINT, 0, {9, NONE}, 1, 1, 1, T3R_HEAD_OUTPUTS},                                                          \
    }
const made_layer small_shape[] = SHAPE(16, 32, 48);
const made_layer wide_shape[] = SHAPE(28, 56, 72);
const uint32_t small_layers = sizeof small_shape / sizeof *small_shape;
const uint32_t wide_layers = sizeof wide_shape / sizeof *wide_shape;

static uint64_t next(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

static void put(uint8_t *to, uint64_t value, uint32_t bytes)
{
    for (uint32_t i = 0; i < bytes; i++) {
        to[i] = (uint8_t)(value >> (8 * i));
    }
}

void seal_weights(uint8_t *file, size_t bytes)
{
    put(file + 8, bytes, 4);
    uint32_t crc = UINT32_MAX;
    for (size_t i = 16; i < bytes; i++) {
        crc ^= file[i];
        for (int bit = 0; bit < 8; bit++) {
            crc = crc >> 1 ^ (UINT32_C(0xedb88320) & (0 - (crc & 1)));
        }
    }
    put(file + 12, ~crc, 4);
}

typedef struct maker {
    uint8_t *file;
    size_t at;
    uint64_t random;
} maker;

static size_t block(maker *m, size_t bytes)
{
    size_t start = (m->at + 15) / 16 * 16;
    m->at = start + bytes;
    return start;
}

static uint32_t channels_of(const made_layer *layers, uint32_t source)
{
    return source == T3R_SOURCE_FEATURES ? T3R_FEATURES : layers[source - 1].outputs;
}

static uint32_t inputs_of(const made_layer *layers, uint32_t n)
{
    const uint8_t *source = layers[n].source;
    return channels_of(layers, source[0]) + (source[1] == NONE ? 0 : channels_of(layers, source[1]));
}

static uint32_t taps_of(const made_layer *layers, uint32_t n)
{
    uint32_t inputs = layers[n].kind == T3R_LAYER_DEPTHWISE ? 1 : inputs_of(layers, n);
    return (uint32_t)layers[n].kernel * layers[n].kernel * inputs;
}

/* Computes floor(log2 sqrt n). */
static int32_t half_log(uint32_t n)
{
    int32_t log = 0;
    while (n >> (log + 1) != 0) {
        log++;
    }
    return log / 2;
}

uint8_t *make_weights(const made_layer *layers, uint32_t count, uint32_t weight_bits, uint32_t activation_bits,
                      uint64_t seed, size_t *bytes)
{
    size_t most = 64 + 32 * (size_t)count;
    for (uint32_t n = 0; n < count; n++) { /* most bytes of weights, biases, multipliers, shifts and alignment */
        size_t rows = (size_t)layers[n].phases * layers[n].outputs;
        most += rows * taps_of(layers, n) * 2 + rows * 16 + 64;
    }
    most = (most + T3R_WEIGHTS_ALIGN - 1) / T3R_WEIGHTS_ALIGN * T3R_WEIGHTS_ALIGN;
    maker m = {.file = aligned_alloc(T3R_WEIGHTS_ALIGN, most), .at = 64 + 32 * (size_t)count, .random = seed};
    if (m.file == NULL) {
        abort();
    }
    memset(m.file, 0, most);
    int64_t zero[T3R_MAX_LAYERS + 1] = {0};
    uint32_t macs_q8 = 0, parameters = 0, bias_bytes = activation_bits == 16 ? 8 : 4;
    for (uint32_t n = 0; n < count; n++) {
        const made_layer *l = &layers[n];
        uint32_t inputs = inputs_of(layers, n), taps = taps_of(layers, n);
        uint32_t rows = (uint32_t)l->phases * l->outputs;
        size_t weights = block(&m, (size_t)rows * taps * weight_bits / 8), bias = block(&m, (size_t)rows * bias_bytes);
        size_t multiplier = block(&m, (size_t)l->outputs * 4), shift = block(&m, l->outputs);
        int64_t folded[4 * T3R_MAX_CHANNELS] = {0}; /* sum of weight x zero point per row */
        for (size_t i = 0; i < (size_t)rows * taps; i++) {
            int64_t w = ((int64_t)(next(&m.random) % 129) - 64) * (weight_bits == 8 ? 1 : 100);
            bool second = l->source[1] != NONE && i % inputs >= channels_of(layers, l->source[0]);
            bool depthwise = l->kind == T3R_LAYER_DEPTHWISE;
            folded[depthwise ? i % rows : i / taps] += w * zero[l->source[second]];
            put(m.file + weights + i * weight_bits / 8, (uint64_t)w, weight_bits / 8);
        }
        for (uint32_t o = 0; o < rows; o++) {
            put(m.file + bias + o * bias_bytes, next(&m.random) % 4001 - 2000 - (uint64_t)folded[o], bias_bytes);
        }
        /* sums are about sqrt(taps) x 37 x 50; outputs about 2^5, with 16 bits 2^12 */
        bool last = n + 1 == count;
        zero[n + 1] = last || l->kind == POINT ? 0
                      : activation_bits == 8   ? -128
                                               : -32768; /* ReLU except for point layers */
        int32_t gain = (activation_bits == 8 && !last ? 6 : 13) - 11 - half_log(taps);
        gain -= (weight_bits == 16 ? 6 : 0) + (activation_bits == 16 && n > 0 ? 7 : 0);
        for (uint32_t o = 0; o < l->outputs; o++) {
            put(m.file + multiplier + o * (size_t)4, (UINT64_C(1) << 30) + next(&m.random) % (1u << 30), 4);
            put(m.file + shift + o, (uint64_t)(int64_t)gain, 1);
        }
        uint8_t *row = m.file + 64 + 32 * (size_t)n;
        const uint8_t head[] = {(uint8_t)l->kind, l->level, l->source[0], l->source[1]};
        memcpy(row, head, sizeof head);
        put(row + 4, inputs, 2);
        put(row + 6, l->outputs, 2);
        row[8] = l->kernel;
        row[9] = l->stride;
        row[10] = l->phases;
        put(row + 12, (uint64_t)zero[n + 1], 2);
        put(row + 16, weights, 4);
        put(row + 20, bias, 4);
        put(row + 24, multiplier, 4);
        put(row + 28, shift, 4);
        macs_q8 += l->outputs * taps << (8 - 2 * l->level);
        parameters += rows * (taps + 1);
    }
    memcpy(m.file, "T3RW", 4);
    put(m.file + 4, T3R_WEIGHTS_FORMAT, 2);
    put(m.file + 6, T3R_BITS_EPOCH, 2);
    m.file[16] = (uint8_t)weight_bits;
    m.file[17] = (uint8_t)activation_bits;
    m.file[18] = (uint8_t)count;
    m.file[19] = T3R_FEATURE_SET;
    put(m.file + 20, macs_q8, 4);
    put(m.file + 24, parameters, 4);
    memcpy(m.file + 32, "made_up", 7);
    *bytes = m.at;
    seal_weights(m.file, m.at);
    return m.file;
}
