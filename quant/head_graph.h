/* The layers of a head: their sources and sizes (runtime/head/weights.h has their meaning). Shared by the float head,
 * the quantized head and the weight file. */
#ifndef T3R_QUANT_HEAD_GRAPH_H
#define T3R_QUANT_HEAD_GRAPH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "head/weights.h"

#define HEAD_NAME_BYTES 16 /* with the terminating zero: 1..15 of a-z 0-9 _ */

typedef struct head_layer {
    t3r_layer_kind kind;
    uint32_t level;
    uint32_t sources[2]; /* 0 = features, n = layer n, T3R_SOURCE_NONE */
    uint32_t inputs, outputs, kernel, stride, phases;
    bool relu;
} head_layer;

typedef struct head_graph {
    char name[HEAD_NAME_BYTES];
    uint32_t count;
    head_layer layers[T3R_MAX_LAYERS]; /* layer n is layers[n - 1] */
} head_graph;

/* Returns 0 when every rule of weights.h holds; otherwise -1 with "layer N: what" in error[]. */
int head_graph_check(const head_graph *graph, char *error, size_t error_bytes);
int head_name_check(const char *name, char *error, size_t error_bytes);

/* Returns "conv", "depthwise", "point"; NULL when out of range. */
const char *head_kind_name(t3r_layer_kind kind);

/* Returns the count of numbers in the blocks of a layer that passed head_graph_check(). */
size_t head_weight_count(const head_layer *layer);
size_t head_bias_count(const head_layer *layer);
/* Returns the index of the weight of (output o, input i, tap t = ky k + kx, or phase t of a point layer). */
size_t head_weight_index(const head_layer *layer, uint32_t o, uint32_t i, uint32_t t);
/* Returns the number of inputs that an output sums over: all, or 1 in a depthwise layer. */
uint32_t head_fan_in(const head_layer *layer);
/* Returns the taps of a kernel, or phases of a point layer: the range of t. */
uint32_t head_taps(const head_layer *layer);
/* Returns the multiply-accumulates per pixel with 100 % of the points kept, Q8, exact. */
uint32_t head_macs_q8(const head_layer *layer);

/* Return the channels of a source, and the source and channel of a layer's input. */
uint32_t head_source_channels(const head_graph *graph, uint32_t source);
uint32_t head_input_source(const head_graph *graph, const head_layer *layer, uint32_t input, uint32_t *channel);

/* Returns the factor from the last layer's outputs to t3r_head_output's formats. The natural units are: offsets and L21
 * in spacings, log2, opacity 0..1 and colour in 64 8-bit levels. */
double head_output_scale(t3r_head_output output);

#endif
