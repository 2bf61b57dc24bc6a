/* SPDX-License-Identifier: Apache-2.0 */
/* Gathers activations from the rings for the kernels: in columns, or in strips of the rows under a kernel. */
#include "network_parts.h"

#include "core/fixed.h"

/* --- activations in the kernel's format --------------------------------------------------------------------------- */

/* Loads `count` activations from place `first` of a node's row. */
static void load_wide(const t3r_node *node, const uint8_t *row, size_t first, uint32_t count, int16_t *to)
{
    if (node->bytes == 1) {
        const int8_t *from = (const int8_t *)row + first;
        for (uint32_t i = 0; i < count; i++) {
            to[i] = (int16_t)(from[i] * node->factor);
        }
    } else {
        const int16_t *from = (const int16_t *)(const void *)row + first;
        for (uint32_t i = 0; i < count; i++) {
            to[i] = from[i];
        }
    }
}

static void fill_wide(int16_t *to, uint32_t count, int16_t value)
{
    for (uint32_t i = 0; i < count; i++) {
        to[i] = value;
    }
}

/* --- windows ------------------------------------------------------------------------------------------------------ */

t3r_window t3r_window_at(const t3r_network *net, const t3r_layer *layer, uint32_t y)
{
    t3r_window w = {.layer = layer, .grid_width = t3r_level_size(net->width, t3r_grid_level(layer))};
    int64_t height = t3r_level_size(net->height, t3r_grid_level(layer));
    int64_t top = (int64_t)layer->stride * y - t3r_padding(layer);
    for (uint32_t i = 0; i < t3r_sources_of(layer); i++) {
        const t3r_node *node = &net->nodes[layer->source[i]];
        w.source[i].node = node;
        w.source[i].coarser = node->level - t3r_grid_level(layer);
        for (int32_t ky = 0; ky < layer->kernel; ky++) {
            bool inside = top + ky >= 0 && top + ky < height;
            w.source[i].row[ky] = inside ? t3r_node_row(node, (uint32_t)(top + ky) >> w.source[i].coarser) : NULL;
        }
    }
    return w;
}

/* Whether the activations under a row of the kernel are contiguous. */
static bool is_plain(const t3r_window *w)
{
    return t3r_sources_of(w->layer) == 1 && w->source[0].coarser == 0;
}

/* --- columns ------------------------------------------------------------------------------------------------------ */

/* Gathers one source's channels under kernel column x of kernel row ky. */
static void gather_tap(const t3r_window *w, uint32_t source, int64_t x, int32_t ky, int16_t *to)
{
    const t3r_node *node = w->source[source].node;
    const uint8_t *row = w->source[source].row[ky];
    if (row == NULL || x < 0 || x >= w->grid_width) {
        fill_wide(to, node->channels, node->zero);
    } else {
        load_wide(node, row, (size_t)(x >> w->source[source].coarser) * node->channels, node->channels, to);
    }
}

/* Writes zeros after `count` taps. */
static void pad_column(int16_t *column, uint32_t count)
{
    fill_wide(column + count, (T3R_COLUMN_TAPS - count % T3R_COLUMN_TAPS) % T3R_COLUMN_TAPS, 0);
}

/* Gathers the activations under the kernel of output column x: [kernel][kernel][inputs]. */
static void gather_column(const t3r_window *w, uint32_t x, int16_t *column)
{
    const t3r_layer *layer = w->layer;
    const uint32_t inputs = layer->inputs, run = layer->kernel * inputs;
    const int64_t left = (int64_t)layer->stride * x - t3r_padding(layer);
    const bool whole = is_plain(w) && left >= 0 && left + layer->kernel <= w->grid_width;
    uint32_t at = 0;
    for (int32_t ky = 0; ky < layer->kernel; ky++, at += run) {
        if (whole && w->source[0].row[ky] != NULL) {
            load_wide(w->source[0].node, w->source[0].row[ky], (size_t)left * inputs, run, column + at);
            continue;
        }
        uint32_t channel = at;
        for (uint32_t i = 0; i < t3r_sources_of(layer); i++) {
            for (int32_t kx = 0; kx < layer->kernel; kx++) {
                gather_tap(w, i, left + kx, ky, column + channel + (uint32_t)kx * inputs);
            }
            channel += w->source[i].node->channels;
        }
    }
    pad_column(column, at);
}

/* Returns `pixels` columns of `taps` activations. */
static t3r_block columns_of(const t3r_network *net, uint32_t taps, uint32_t pixels)
{
    return (t3r_block){.x = net->columns, .rows = 1, .run = taps, .step = net->column_pitch, .pixels = pixels};
}

static int16_t *column_of(const t3r_network *net, uint32_t i)
{
    return (int16_t *)(void *)net->columns + (size_t)i * net->column_pitch;
}

t3r_block t3r_gather_columns(const t3r_network *net, const t3r_window *w, uint32_t x, uint32_t width)
{
    const uint32_t pixels = T3R_MIN(width - x, T3R_BLOCK_PIXELS);
    for (uint32_t i = 0; i < pixels; i++) {
        gather_column(w, x + i, column_of(net, i));
    }
    return columns_of(net, (uint32_t)w->layer->kernel * w->layer->kernel * w->layer->inputs, pixels);
}

/* --- strips ------------------------------------------------------------------------------------------------------- */

/* Stores activations of 8 bits at place `at` of a strip: bytes + 128, or int16. */
static void load_strip(const t3r_network *net, const uint8_t *from, uint32_t count, size_t at)
{
    if (net->kernels->strip_bytes == 1) {
        uint8_t *to = net->strips + at;
        for (uint32_t i = 0; i < count; i++) {
            to[i] = from[i] ^ 128;
        }
    } else {
        int16_t *to = (int16_t *)(void *)net->strips + at;
        for (uint32_t i = 0; i < count; i++) {
            to[i] = (int8_t)from[i];
        }
    }
}

static void fill_strip(const t3r_network *net, uint32_t count, int16_t value, size_t at)
{
    if (net->kernels->strip_bytes == 1) {
        uint8_t *to = net->strips + at;
        for (uint32_t i = 0; i < count; i++) {
            to[i] = (uint8_t)(value + 128);
        }
    } else {
        fill_wide((int16_t *)(void *)net->strips + at, count, value);
    }
}

/* Gathers one source's channels at the grid's columns left..end - 1 under kernel row ky, to every `inputs`-th place
 * from `at` on. */
static void gather_source(const t3r_network *net, const t3r_window *w, uint32_t source, int32_t ky, int64_t left,
                          int64_t end, size_t at)
{
    const t3r_node *node = w->source[source].node;
    const uint8_t *row = w->source[source].row[ky];
    const uint32_t channels = node->channels, inputs = w->layer->inputs, coarser = w->source[source].coarser;
    const int64_t first = row == NULL ? end : T3R_MAX(left, 0), last = T3R_MIN(end, (int64_t)w->grid_width);
    for (int64_t x = left; x < end; x++, at += inputs) {
        if (x < first || x >= last) {
            fill_strip(net, channels, node->zero, at);
        } else if (is_plain(w)) {
            const uint32_t columns = (uint32_t)(last - x);
            load_strip(net, row + (size_t)x * channels, columns * channels, at);
            x += columns - 1;
            at += (size_t)(columns - 1) * inputs;
        } else {
            load_strip(net, row + (size_t)(x >> coarser) * channels, channels, at);
        }
    }
}

t3r_block t3r_gather_strips(const t3r_network *net, const t3r_window *w, uint32_t x, uint32_t width)
{
    const t3r_layer *layer = w->layer;
    const uint32_t pixels = T3R_MIN(width - x, T3R_STRIP_PIXELS / layer->stride);
    const uint32_t columns = layer->stride * (pixels - 1) + layer->kernel, pitch = columns * layer->inputs;
    const int64_t left = (int64_t)layer->stride * x - t3r_padding(layer);
    for (int32_t ky = 0; ky < layer->kernel; ky++) {
        size_t at = (size_t)ky * pitch;
        for (uint32_t i = 0; i < t3r_sources_of(layer); i++) {
            gather_source(net, w, i, ky, left, left + columns, at);
            at += w->source[i].node->channels;
        }
    }
    return (t3r_block){.x = net->strips,
                       .rows = layer->kernel,
                       .pitch = pitch,
                       .run = layer->kernel * layer->inputs,
                       .step = layer->stride * layer->inputs,
                       .pixels = pixels};
}

/* --- points ------------------------------------------------------------------------------------------------------- */

/* The place of a point layer's source channels at pixel i. */
typedef struct point_source {
    const t3r_node *node;
    const uint8_t *at;
} point_source;

static point_source point_source_of(const t3r_network *net, uint32_t source, uint32_t x, uint32_t y,
                                    const int8_t *features, const uint8_t *made)
{
    const t3r_node *node = &net->nodes[source <= net->planes ? source : 0];
    if (source == T3R_SOURCE_FEATURES) {
        return (point_source){node, (const uint8_t *)features};
    }
    if (source > net->planes) {
        return (point_source){NULL, made};
    }
    return (point_source){node, t3r_node_row(node, y >> node->level) +
                                    (size_t)(x >> node->level) * node->channels * node->bytes};
}

t3r_block t3r_gather_points(const t3r_network *net, uint32_t n, uint32_t y, uint32_t count, const uint32_t *x,
                            const int8_t (*features)[T3R_FEATURES], const uint8_t *made, uint32_t made_pitch)
{
    const t3r_layer *layer = &net->layers[n];
    const t3r_node before = {.bytes = net->header.activation_bits / 8, .factor = 1};
    for (uint32_t i = 0; i < count; i++) {
        uint32_t at = 0;
        for (uint32_t s = 0; s < t3r_sources_of(layer); s++) {
            const point_source from =
                point_source_of(net, layer->source[s], x[i], y, features[i], made + (size_t)i * made_pitch);
            const uint32_t channels =
                from.node == NULL ? net->layers[layer->source[s] - 1].outputs : from.node->channels;
            if (t3r_is_packed(net)) {
                load_strip(net, from.at, channels, (size_t)i * layer->inputs + at);
            } else {
                load_wide(from.node == NULL ? &before : from.node, from.at, 0, channels, column_of(net, i) + at);
            }
            at += channels;
        }
        if (!t3r_is_packed(net)) {
            pad_column(column_of(net, i), at);
        }
    }
    if (!t3r_is_packed(net)) {
        return columns_of(net, layer->inputs, count);
    }
    return (t3r_block){.x = net->strips, .rows = 1, .run = layer->inputs, .step = layer->inputs, .pixels = count};
}
