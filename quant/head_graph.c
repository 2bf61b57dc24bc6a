/* SPDX-License-Identifier: Apache-2.0 */
#include "head_graph.h"

#include <string.h>

#include "quant_reason.h"

typedef struct checker {
    const head_graph *graph;
    uint32_t n; /* the layer's number */
    char *error;
    size_t error_bytes;
} checker;

static int fail(const checker *c, const char *what)
{
    return quant_reason(c->error, c->error_bytes, "layer %u: %s", (unsigned)c->n, what);
}

const char *head_kind_name(t3r_layer_kind kind)
{
    static const char *const names[] = {"conv", "depthwise", "point"};
    return kind < T3R_LAYER_KINDS ? names[kind] : NULL;
}

int head_name_check(const char *name, char *error, size_t error_bytes)
{
    size_t length = strlen(name);
    if (length == 0 || length >= HEAD_NAME_BYTES || strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789_") != length) {
        return quant_reason(error, error_bytes, "the name '%.32s' is not 1 to 15 of a-z 0-9 _", name);
    }
    return 0;
}

uint32_t head_source_channels(const head_graph *graph, uint32_t source)
{
    return source == T3R_SOURCE_FEATURES ? T3R_FEATURES : graph->layers[source - 1].outputs;
}

static int check_source(const checker *c, uint32_t source)
{
    const head_layer *layer = &c->graph->layers[c->n - 1];
    if (source >= c->n) {
        return fail(c, "a source does not come before it");
    }
    const head_layer *from = source == T3R_SOURCE_FEATURES ? NULL : &c->graph->layers[source - 1];
    bool from_point = from != NULL && from->kind == T3R_LAYER_POINT;
    if (layer->kind == T3R_LAYER_POINT) {
        return from_point && source != c->n - 1 ? fail(c, "reads a point layer that is not the one before it") : 0;
    }
    if (from_point) {
        return fail(c, "a layer of another kind follows a point layer");
    }
    if ((from == NULL ? 0 : from->level) + layer->stride - 1 < layer->level) {
        return fail(c, "a source is finer than its stride allows");
    }
    return 0;
}

static int check_sources(const checker *c)
{
    const head_layer *layer = &c->graph->layers[c->n - 1];
    uint32_t channels = 0;
    if (layer->sources[0] == T3R_SOURCE_NONE) {
        return fail(c, "has no source");
    }
    if (layer->kind == T3R_LAYER_DEPTHWISE && layer->sources[1] != T3R_SOURCE_NONE) {
        return fail(c, "a depthwise layer has one source");
    }
    for (int i = 0; i < 2; i++) {
        if (layer->sources[i] != T3R_SOURCE_NONE) {
            if (check_source(c, layer->sources[i]) != 0) {
                return -1;
            }
            channels += head_source_channels(c->graph, layer->sources[i]);
        }
    }
    return channels == layer->inputs ? 0 : fail(c, "inputs are not its sources' channels");
}

static int check_layer(const checker *c)
{
    const head_layer *layer = &c->graph->layers[c->n - 1];
    if (layer->kind >= T3R_LAYER_KINDS) {
        return fail(c, "unknown kind");
    }
    if (layer->inputs < 1 || layer->inputs > T3R_MAX_CHANNELS) {
        return fail(c, "inputs not in 1..128");
    }
    if (layer->outputs < 1 || layer->outputs > T3R_MAX_CHANNELS) {
        return fail(c, "outputs not in 1..128");
    }
    if (layer->kind == T3R_LAYER_POINT) {
        if (layer->level != 0 || layer->kernel != 1 || layer->stride != 1) {
            return fail(c, "level, kernel and stride of a point layer are 0, 1 and 1");
        }
        return layer->phases == 1 || layer->phases == 4 ? check_sources(c) : fail(c, "phases are neither 1 nor 4");
    }
    if (layer->level > T3R_MAX_LEVEL) {
        return fail(c, "level not in 0..4");
    }
    if (layer->kernel < 1 || layer->kernel > (layer->kind == T3R_LAYER_DEPTHWISE ? 5u : 6u)) {
        return fail(c, "kernel not in 1..6 (depthwise: 1..5)");
    }
    if (layer->stride != 1 && layer->stride != 2) {
        return fail(c, "stride neither 1 nor 2");
    }
    if (layer->level + 1 < layer->stride) {
        return fail(c, "stride 2 does not lead to level 0");
    }
    if (layer->phases != 1) {
        return fail(c, "phases of other than point layers are 1");
    }
    if (layer->kind == T3R_LAYER_DEPTHWISE && layer->outputs != layer->inputs) {
        return fail(c, "outputs of a depthwise layer are its inputs");
    }
    return check_sources(c);
}

/* Checks rules that involve all layers. */
static int check_whole(checker *c)
{
    uint64_t macs_q8 = 0;
    for (c->n = 1; c->n <= c->graph->count; c->n++) {
        const head_layer *layer = &c->graph->layers[c->n - 1];
        if (c->n > 1 && layer->kind != T3R_LAYER_POINT && layer[-1].kind == T3R_LAYER_POINT) {
            return fail(c, "a layer of another kind follows a point layer");
        }
        bool is_read = c->n == c->graph->count;
        for (uint32_t m = c->n; m < c->graph->count && !is_read; m++) {
            is_read = c->graph->layers[m].sources[0] == c->n || c->graph->layers[m].sources[1] == c->n;
        }
        if (!is_read) {
            return fail(c, "no later layer reads it");
        }
        macs_q8 += head_macs_q8(layer);
    }
    return macs_q8 <= (uint64_t)T3R_MAX_HEAD_MACS << 8
               ? 0
               : quant_reason(c->error, c->error_bytes, "over 65536 multiply-accumulates a pixel");
}

int head_graph_check(const head_graph *graph, char *error, size_t error_bytes)
{
    if (head_name_check(graph->name, error, error_bytes) != 0) {
        return -1;
    }
    if (graph->count < 1 || graph->count > T3R_MAX_LAYERS) {
        return quant_reason(error, error_bytes, "%u layers, not 1..24", (unsigned)graph->count);
    }
    checker c = {.graph = graph, .error = error, .error_bytes = error_bytes};
    for (c.n = 1; c.n <= graph->count; c.n++) {
        if (check_layer(&c) != 0) {
            return -1;
        }
    }
    if (check_whole(&c) != 0) {
        return -1;
    }
    c.n = graph->count;
    const head_layer *last = &graph->layers[graph->count - 1];
    if (last->kind != T3R_LAYER_POINT || last->outputs != T3R_HEAD_OUTPUTS || last->relu) {
        return fail(&c, "the last one is not a linear point layer of 9 outputs");
    }
    return 0;
}

uint32_t head_fan_in(const head_layer *layer)
{
    return layer->kind == T3R_LAYER_DEPTHWISE ? 1 : layer->inputs;
}

uint32_t head_taps(const head_layer *layer)
{
    return layer->kind == T3R_LAYER_POINT ? layer->phases : layer->kernel * layer->kernel;
}

size_t head_weight_count(const head_layer *layer)
{
    return (size_t)layer->outputs * head_taps(layer) * head_fan_in(layer);
}

size_t head_bias_count(const head_layer *layer)
{
    return (size_t)layer->outputs * layer->phases;
}

size_t head_weight_index(const head_layer *layer, uint32_t o, uint32_t i, uint32_t t)
{
    switch (layer->kind) {
    case T3R_LAYER_DEPTHWISE:
        return (size_t)t * layer->outputs + o;
    case T3R_LAYER_POINT:
        return ((size_t)t * layer->outputs + o) * layer->inputs + i;
    default:
        return ((size_t)o * head_taps(layer) + t) * layer->inputs + i;
    }
}

uint32_t head_macs_q8(const head_layer *layer)
{
    /* at most 128 x 36 x 128 x 256 < 2^28; a pixel has one phase */
    uint32_t macs = layer->outputs * layer->kernel * layer->kernel * head_fan_in(layer);
    return macs * 256 >> (2 * layer->level);
}

uint32_t head_input_source(const head_graph *graph, const head_layer *layer, uint32_t input, uint32_t *channel)
{
    uint32_t first = head_source_channels(graph, layer->sources[0]);
    *channel = input < first ? input : input - first;
    return layer->sources[input < first ? 0 : 1];
}

double head_output_scale(t3r_head_output output)
{
    static const double scales[T3R_HEAD_OUTPUTS] = {
        [T3R_OUT_OFFSET_X] = 0x1p14, [T3R_OUT_OFFSET_Y] = 0x1p14, [T3R_OUT_LOG_L11] = 0x1p13,
        [T3R_OUT_LOG_L22] = 0x1p13,  [T3R_OUT_L21] = 0x1p14,      [T3R_OUT_OPACITY] = 0x1p15,
        [T3R_OUT_RED] = 0x1p13,      [T3R_OUT_GREEN] = 0x1p13,    [T3R_OUT_BLUE] = 0x1p13,
    };
    return scales[output];
}
