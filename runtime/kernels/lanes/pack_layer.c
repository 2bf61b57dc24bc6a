/* SPDX-License-Identifier: Apache-2.0 */
/* Packs layers for the packed kernels. */
#include "core/little_endian.h"
#include "packed_scaling.h"

/* Padding outputs have zero scaling except for the shift, and zero sums. */
static void pack_scaling(const t3r_convolution *layer, int32_t offset, bool factors, int32_t *scaling)
{
    const uint32_t whole = t3r_packed_outputs(layer->outputs);
    for (uint32_t o = 0; o < whole; o++) {
        const bool is_output = o < layer->outputs;
        const int32_t shift = is_output ? (int8_t)layer->shift[o] : 0;
        const int32_t left = T3R_MAX(shift + 2, 0), right = T3R_MAX(-1 - shift, 1);
        int32_t weights = 0;
        for (uint32_t t = 0; is_output && t < layer->taps; t++) {
            weights += (int8_t)layer->weights[(size_t)o * layer->taps + t];
        }
        const uint32_t bias = is_output ? t3r_load_le32(layer->bias + (size_t)o * 4) : 0;
        scaling[T3R_SCALING_BIAS * whole + o] = (int32_t)(bias - (uint32_t)(offset * weights));
        scaling[T3R_SCALING_MULTIPLIER * whole + o] =
            is_output ? (int32_t)t3r_load_le32(layer->multiplier + (size_t)o * 4) : 0;
        scaling[T3R_SCALING_LIMIT * whole + o] = left > 0 ? 1 << (18 - shift) : INT32_MAX;
        scaling[T3R_SCALING_LEFT * whole + o] = factors ? 1 << left : left;
        scaling[T3R_SCALING_HALF * whole + o] = 1 << (right - 1);
        scaling[T3R_SCALING_RIGHT * whole + o] = factors ? 1 << (31 - right) : right;
    }
}

void t3r_pack_layer_with(const t3r_convolution *layer, uint32_t rows, uint32_t taps_a_group, int32_t offset,
                         bool factors, void *packed)
{
    const uint32_t whole = t3r_packed_outputs(layer->outputs), run = layer->taps / rows;
    const uint32_t whole_run = (run + T3R_PACKED_TAPS - 1) / T3R_PACKED_TAPS * T3R_PACKED_TAPS;
    uint8_t *to = (uint8_t *)packed + (size_t)whole * T3R_PACKED_SCALING_BYTES;
    pack_scaling(layer, offset, factors, packed);
    for (uint32_t row = 0; row < rows; row++) {
        for (uint32_t tap = 0; tap < whole_run; tap += taps_a_group) {
            for (uint32_t o = 0; o < whole; o++) {
                const uint8_t *from = layer->weights + (size_t)o * layer->taps + (size_t)row * run + tap;
                for (uint32_t i = 0; i < taps_a_group; i++) {
                    *to++ = o < layer->outputs && tap + i < run ? from[i] : 0;
                }
            }
        }
    }
}
