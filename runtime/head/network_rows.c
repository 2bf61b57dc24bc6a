/* SPDX-License-Identifier: Apache-2.0 */
/* Schedules the rows of each layer, and computes how many of them are kept. */
#include "network_parts.h"

#include "core/fixed.h"

#define ROW_ALIGN 16u

void t3r_rows_needed(const t3r_network *net, int32_t y, int32_t need[T3R_MAX_LAYERS + 1])
{
    for (uint32_t n = 0; n <= net->planes; n++) {
        need[n] = T3R_NOT_READ;
    }
    for (uint32_t n = net->planes; n < net->header.layers; n++) {
        for (uint32_t i = 0; i < t3r_sources_of(&net->layers[n]); i++) {
            uint32_t source = net->layers[n].source[i];
            if (source != T3R_SOURCE_FEATURES && source <= net->planes) {
                need[source] = T3R_MAX(need[source], (y >> net->nodes[source].level) + 1);
            }
        }
    }
    for (uint32_t n = net->planes; n > 0; n--) { /* every plane layer has readers, all of them later layers */
        const t3r_layer *layer = &net->layers[n - 1];
        int32_t bottom = layer->stride * (need[n] - 1) - t3r_padding(layer) + layer->kernel - 1;
        for (uint32_t i = 0; i < t3r_sources_of(layer); i++) {
            uint32_t source = layer->source[i];
            uint32_t coarser = net->nodes[source].level - t3r_grid_level(layer);
            need[source] = T3R_MAX(need[source], (bottom >> coarser) + 1);
        }
    }
}

uint32_t t3r_rows_due(const t3r_node *node, int32_t need)
{
    return need <= 0 ? 0 : T3R_MIN((uint32_t)need, node->height);
}

/* Sets the rows that a ring must keep: in each step, from the first row that a reader's next row reads to the last one
 * made. All nodes move by 16 >> level rows in 16 image rows, so one period shows every case. */
static void choose_rings(t3r_network *net)
{
    int32_t before[T3R_MAX_LAYERS + 1], now[T3R_MAX_LAYERS + 1];
    t3r_rows_needed(net, -1, before);
    for (int32_t y = 0; y < T3R_NETWORK_PERIOD; y++) {
        t3r_rows_needed(net, y, now);
        for (uint32_t n = 0; n < net->header.layers; n++) {
            const t3r_layer *layer = &net->layers[n];
            bool point = n >= net->planes;
            for (uint32_t i = 0; i < t3r_sources_of(layer); i++) {
                uint32_t source = layer->source[i];
                if (point && (source == T3R_SOURCE_FEATURES || source > net->planes)) {
                    continue; /* points bring their features; a point layer has no plane */
                }
                t3r_node *node = &net->nodes[source];
                int32_t first = point ? y >> node->level
                                      : (layer->stride * before[n + 1] - t3r_padding(layer)) >>
                                            (node->level - t3r_grid_level(layer));
                int32_t rows = T3R_MAX(now[source] - first, 1);
                node->ring = T3R_MAX(node->ring, (uint32_t)rows);
            }
        }
        for (uint32_t n = 0; n <= net->planes; n++) {
            before[n] = now[n];
        }
    }
}

/* 64 bits suffice: 25 nodes of 2^12 x 2^8 bytes a row, and fewer than 2^12 rows, since a layer looks at most 6 x 16
 * rows ahead. */
uint64_t t3r_network_lay_out(t3r_network *net, const void *weights, uint32_t width, uint32_t height, uint8_t *work)
{
    net->file = weights;
    net->header = t3r_weights_header_of(weights);
    net->width = width;
    net->height = height;
    net->planes = 0;
    net->nodes[0] = (t3r_node){.channels = T3R_FEATURES,
                               .bytes = 1,
                               .factor = net->header.activation_bits == 16 ? 256 : 1,
                               .width = width,
                               .height = height};
    uint32_t column = 0;
    for (uint32_t n = 0; n < net->header.layers; n++) {
        t3r_layer *layer = &net->layers[n];
        *layer = t3r_weights_layer(weights, n);
        column = T3R_MAX(column, (uint32_t)layer->kernel * layer->kernel * layer->inputs);
        if (layer->kind != T3R_LAYER_POINT) {
            net->planes = n + 1;
            net->nodes[n + 1] = (t3r_node){
                .level = layer->level,
                .channels = layer->outputs,
                .bytes = net->header.activation_bits / 8,
                .factor = 1,
                .zero = layer->zero,
                .width = t3r_level_size(width, layer->level),
                .height = t3r_level_size(height, layer->level),
            };
        }
    }
    choose_rings(net);
    net->column_pitch = (column + T3R_COLUMN_TAPS - 1) / T3R_COLUMN_TAPS * T3R_COLUMN_TAPS;
    net->columns = work;
    uint64_t at = (uint64_t)net->column_pitch * T3R_BLOCK_PIXELS * sizeof(int16_t);
    for (uint32_t n = 0; n <= net->planes; n++) {
        t3r_node *node = &net->nodes[n];
        node->pitch = ((size_t)node->width * node->channels * node->bytes + ROW_ALIGN - 1) / ROW_ALIGN * ROW_ALIGN;
        node->rows = work == NULL ? NULL : work + at;
        at += (uint64_t)node->pitch * node->ring;
    }
    return at;
}

/* Each node starts at the first row that the band's points read through all layers between, or one row above it. No
 * row of the band reads anything further up. */
void t3r_skip_rows(t3r_network *net)
{
    for (uint32_t n = 0; n <= net->planes; n++) {
        net->nodes[n].made = net->begin >> net->nodes[n].level;
    }
    for (uint32_t n = net->planes; n > 0; n--) { /* every plane layer's readers are later layers */
        const t3r_layer *layer = &net->layers[n - 1];
        int32_t top = T3R_MAX((int32_t)(layer->stride * net->nodes[n].made) - t3r_padding(layer), 0);
        for (uint32_t i = 0; i < t3r_sources_of(layer); i++) {
            t3r_node *source = &net->nodes[layer->source[i]];
            source->made = T3R_MIN(source->made, (uint32_t)top >> (source->level - t3r_grid_level(layer)));
        }
    }
}
