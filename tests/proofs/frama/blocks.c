/* SPDX-License-Identifier: Apache-2.0 */
/* t3r_weights_check() of files with a network of a known shape; block offsets and all bytes outside the header and the
 * shapes are arbitrary. */
#include "head/weights.h"

enum { ROOM = 1600, LAYERS = 3, SHAPE_BYTES = 12, NETWORKS = 2 };

static uint8_t file[ROOM];

/* kind, level, two sources, inputs, outputs, kernel, stride, phases, in the file's order */
static const uint8_t shapes[NETWORKS][LAYERS][SHAPE_BYTES] = {
    {{T3R_LAYER_CONV, 1, T3R_SOURCE_FEATURES, T3R_SOURCE_NONE, T3R_FEATURES, 0, 2, 0, 3, 2, 1, 0},
     {T3R_LAYER_DEPTHWISE, 1, 1, T3R_SOURCE_NONE, 2, 0, 2, 0, 3, 1, 1, 0},
     {T3R_LAYER_POINT, 0, T3R_SOURCE_FEATURES, 2, T3R_FEATURES + 2, 0, T3R_HEAD_OUTPUTS, 0, 1, 1, 4, 0}},
    {{T3R_LAYER_CONV, 0, T3R_SOURCE_FEATURES, T3R_SOURCE_NONE, T3R_FEATURES, 0, 3, 0, 1, 1, 1, 0},
     {T3R_LAYER_POINT, 0, T3R_SOURCE_FEATURES, 1, T3R_FEATURES + 3, 0, 2, 0, 1, 1, 1, 0},
     {T3R_LAYER_POINT, 0, 2, T3R_SOURCE_NONE, 2, 0, T3R_HEAD_OUTPUTS, 0, 1, 1, 1, 0}},
};

static void check(uint32_t network, uint32_t weight_bits, uint32_t activation_bits)
{
    t3r_any_bytes(file, ROOM);
    const uint8_t head[12] = {'T',        '3',       'R', 'W', T3R_WEIGHTS_FORMAT, 0, T3R_BITS_EPOCH, 0,
                              ROOM & 255, ROOM >> 8, 0,   0};
    for (uint32_t i = 0; i < 12; i++) {
        file[i] = head[i];
    }
    file[16] = (uint8_t)weight_bits;
    file[17] = (uint8_t)activation_bits;
    file[18] = LAYERS;
    for (uint32_t n = 0; n < LAYERS; n++) {
        for (uint32_t i = 0; i < SHAPE_BYTES; i++) {
            file[T3R_WEIGHTS_HEADER_BYTES + n * T3R_WEIGHTS_LAYER_BYTES + i] = shapes[network][n][i];
        }
    }
    t3r_weights_check(file, ROOM);
}

int main(void)
{
    for (uint32_t network = 0; network < NETWORKS; network++) {
        check(network, 8, 8);
        check(network, 16, 8);
        check(network, 8, 16);
        check(network, 16, 16);
    }
    return 0;
}
