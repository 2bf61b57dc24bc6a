/* SPDX-License-Identifier: Apache-2.0 */
#include "network.h"

#include "core/fixed.h"
#include "network_parts.h"

_Static_assert(T3R_MAX_CHANNELS == T3R_LAYER_OUTPUTS, "the kernels hold a layer's outputs");
_Static_assert(T3R_MAX_KERNEL == T3R_LAYER_RUNS, "the kernels hold a layer's runs");

size_t t3r_network_work_bytes(const void *weights, uint32_t width)
{
    t3r_network net;
    uint64_t bytes = t3r_network_lay_out(&net, weights, width, 1, NULL);
    return bytes > SIZE_MAX ? SIZE_MAX : (size_t)bytes;
}

void t3r_network_begin(t3r_network *net, const t3r_kernels *kernels, const void *weights, uint32_t width,
                       uint32_t height, uint32_t begin, void *work, size_t work_bytes)
{
    const size_t taken = (size_t)t3r_network_lay_out(net, weights, width, height, work);
    net->kernels = kernels;
    net->begin = begin;
    t3r_skip_rows(net);
    net->strips = NULL;
    if (work_bytes > taken) {
        t3r_pack_layers(net, (uint8_t *)work + taken, work_bytes - taken);
    }
}

int32_t t3r_network_first(const t3r_network *net)
{
    int32_t need[T3R_MAX_LAYERS + 1];
    int32_t first = (int32_t)(net->begin / T3R_NETWORK_PERIOD * T3R_NETWORK_PERIOD);
    bool ahead = true;
    while (ahead) { /* each layer reads at most 6 x 16 rows before or after its reader's: at most 24 x 12 turns */
        t3r_rows_needed(net, first - 1, need);
        ahead = false;
        for (uint32_t n = 0; n <= net->planes; n++) {
            ahead = ahead || need[n] > (int32_t)net->nodes[n].made;
        }
        first -= ahead ? T3R_NETWORK_PERIOD : 0;
    }
    return first;
}

bool t3r_network_wants_features(const t3r_network *net, int32_t y)
{
    int32_t need[T3R_MAX_LAYERS + 1];
    t3r_rows_needed(net, y, need);
    return net->nodes[0].made < t3r_rows_due(&net->nodes[0], need[0]);
}

int8_t *t3r_network_feature_row(t3r_network *net, uint32_t *y)
{
    *y = net->nodes[0].made++;
    return (int8_t *)t3r_node_row(&net->nodes[0], *y);
}

/* Makes the next row of plane layer n, counted from 1. */
static void make_row(t3r_network *net, uint32_t n)
{
    t3r_node *node = &net->nodes[n];
    const t3r_window w = t3r_window_at(net, &net->layers[n - 1], node->made);
    uint8_t *row = t3r_node_row(node, node->made);
    t3r_block block;
    for (uint32_t x = 0; x < node->width; x += block.pixels) {
        block = t3r_is_packed(net) ? t3r_gather_strips(net, &w, x, node->width)
                                   : t3r_gather_columns(net, &w, x, node->width);
        t3r_run_layer(net, n - 1, 0, &block, row + (size_t)x * node->channels * node->bytes, node->channels);
    }
    node->made++;
}

void t3r_network_step(t3r_network *net, int32_t y)
{
    int32_t need[T3R_MAX_LAYERS + 1];
    t3r_rows_needed(net, y, need);
    for (uint32_t n = 1; n <= net->planes; n++) {
        uint32_t due = t3r_rows_due(&net->nodes[n], need[n]);
        while (net->nodes[n].made < due) {
            make_row(net, n);
        }
    }
}

/* The outputs of a point layer at the pixels of a block. */
typedef union point_outputs {
    int8_t narrow[T3R_NETWORK_POINTS * T3R_MAX_CHANNELS];
    int16_t wide[T3R_BLOCK_PIXELS * T3R_MAX_CHANNELS];
} point_outputs;

/* Runs all point layers at `count` pixels, at most a block; `x`, `features` and `out` begin with the first of them. */
static void run_points(const t3r_network *net, uint32_t y, uint32_t count, const uint32_t *x,
                       const int8_t (*features)[T3R_FEATURES], int16_t (*out)[T3R_HEAD_OUTPUTS])
{
    point_outputs made; /* a layer's inputs are gathered before its outputs are written */
    const uint32_t made_pitch = T3R_MAX_CHANNELS * (net->header.activation_bits / 8);
    for (uint32_t n = net->planes; n < net->header.layers; n++) {
        const uint32_t phase = net->layers[n].phases == 1 ? 0 : 2 * (y & 1) + (x[0] & 1);
        const t3r_block block =
            t3r_gather_points(net, n, y, count, x, features, (const uint8_t *)made.narrow, made_pitch);
        if (n + 1 == net->header.layers) {
            t3r_run_layer(net, n, phase, &block, out[0], T3R_HEAD_OUTPUTS);
        } else {
            t3r_run_layer(net, n, phase, &block, made.narrow, T3R_MAX_CHANNELS);
        }
    }
}

void t3r_network_points(const t3r_network *net, uint32_t y, uint32_t count, const uint32_t *x,
                        const int8_t (*features)[T3R_FEATURES], int16_t (*out)[T3R_HEAD_OUTPUTS])
{
    const uint32_t most = t3r_is_packed(net) ? T3R_NETWORK_POINTS : T3R_BLOCK_PIXELS;
    for (uint32_t i = 0; i < count; i += most) {
        run_points(net, y, T3R_MIN(most, count - i), x + i, features + i, out + i);
    }
}
