/* SPDX-License-Identifier: Apache-2.0 */
/* Prepares layers for the kernels: as in the file, or packed. */
#include "network_parts.h"

#include "core/fixed.h"

#define STRIP_BYTES_MOST 2u /* most bytes of an activation in a strip, for any kernel */

t3r_convolution t3r_convolution_of(const t3r_network *net, uint32_t n, uint32_t phase)
{
    const t3r_layer *layer = &net->layers[n];
    const uint32_t taps = t3r_layer_taps(layer), first = phase * layer->outputs;
    const uint32_t weights = layer->weights + first * taps * (net->header.weight_bits / 8);
    return (t3r_convolution){
        .weights = net->file + weights,
        .readable = net->header.bytes - weights,
        .bias = net->file + layer->bias + (size_t)first * (net->header.activation_bits == 16 ? 8 : 4),
        .multiplier = net->file + layer->multiplier,
        .shift = net->file + layer->shift,
        .taps = taps,
        .outputs = layer->outputs,
        .zero = layer->zero,
        .weight_bits = (uint8_t)net->header.weight_bits,
        .activation_bits = (uint8_t)net->header.activation_bits,
        .output_bits = (uint8_t)(n + 1 == net->header.layers ? 16 : net->header.activation_bits),
    };
}

static size_t packed_bytes(const t3r_layer *layer)
{
    return t3r_packed_bytes(layer->kernel, layer->kernel * layer->inputs, layer->outputs);
}

/* Returns the number of activations of the largest gathered strip. */
static size_t strip_places(const t3r_network *net)
{
    size_t most = 0;
    for (uint32_t n = 0; n < net->header.layers; n++) {
        const t3r_layer *layer = &net->layers[n];
        const size_t columns = n < net->planes ? T3R_STRIP_PIXELS + layer->kernel : T3R_NETWORK_POINTS;
        most = T3R_MAX(most, layer->kernel * columns * layer->inputs);
    }
    return most + T3R_STRIP_BEHIND;
}

/* Whether all layers have 8 bits and none is depthwise. */
static bool is_packable(const t3r_network *net)
{
    bool fits = net->header.weight_bits == 8 && net->header.activation_bits == 8;
    for (uint32_t n = 0; n < net->planes; n++) {
        fits = fits && net->layers[n].kind == T3R_LAYER_CONV;
    }
    return fits;
}

size_t t3r_network_packed_work_bytes(const void *weights, uint32_t width)
{
    t3r_network net;
    const uint64_t plain = t3r_network_lay_out(&net, weights, width, 1, NULL);
    if (!is_packable(&net)) {
        return SIZE_MAX;
    }
    size_t packed = T3R_PACKED_ALIGN + strip_places(&net) * STRIP_BYTES_MOST;
    for (uint32_t n = 0; n < net.header.layers; n++) {
        packed += packed_bytes(&net.layers[n]) * net.layers[n].phases;
    }
    return plain > SIZE_MAX - packed ? SIZE_MAX : (size_t)plain + packed;
}

void t3r_pack_layers(t3r_network *net, uint8_t *work, size_t bytes)
{
    size_t at = (0 - (uintptr_t)work) % T3R_PACKED_ALIGN;
    if (T3R_VARIANTS_COUNT == 0 || net->kernels->pack_layer == NULL || !is_packable(net)) {
        return;
    }
    for (uint32_t n = 0; n < net->header.layers; n++) {
        net->packed[n] = work + at;
        at += packed_bytes(&net->layers[n]) * net->layers[n].phases;
    }
    if (at + strip_places(net) * net->kernels->strip_bytes > bytes) {
        return;
    }
    net->strips = work + at;
    for (uint32_t n = 0; n < net->header.layers; n++) {
        for (uint32_t phase = 0; phase < net->layers[n].phases; phase++) {
            const t3r_convolution layer = t3r_convolution_of(net, n, phase);
            net->kernels->pack_layer(&layer, net->layers[n].kernel,
                                     net->packed[n] + packed_bytes(&net->layers[n]) * phase);
        }
    }
}

void t3r_run_layer(const t3r_network *net, uint32_t n, uint32_t phase, const t3r_block *block, void *out,
                   uint32_t out_pitch)
{
    const t3r_layer *layer = &net->layers[n];
    const t3r_convolution kernel = t3r_convolution_of(net, n, phase);
    if (t3r_is_packed(net)) {
        net->kernels->convolve_packed(&kernel, net->packed[n] + packed_bytes(layer) * phase, block, out, out_pitch);
    } else if (layer->kind == T3R_LAYER_DEPTHWISE) {
        net->kernels->depthwise(&kernel, block, out, out_pitch);
    } else {
        net->kernels->convolve(&kernel, block, out, out_pitch);
    }
}
