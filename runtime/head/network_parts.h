/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by the files of the network: the geometry of layers, and activations gathered for the kernels. */
#ifndef T3R_NETWORK_PARTS_H
#define T3R_NETWORK_PARTS_H

#include "kernels/variants.h"
#include "network.h"

#define T3R_STRIP_PIXELS 32u /* most columns of a layer, times its stride, made from one strip */
#define T3R_NOT_READ INT32_MIN
#define T3R_NETWORK_PERIOD (1 << T3R_MAX_LEVEL) /* image rows after which every layer's progress repeats */

static inline uint32_t t3r_level_size(uint32_t size, uint32_t level)
{
    return (size + (1u << level) - 1) >> level;
}

/* Returns the level of the grid that a layer slides over. */
static inline uint32_t t3r_grid_level(const t3r_layer *layer)
{
    return layer->level - (layer->stride - 1u);
}

/* Returns the columns (rows) before its own position at which a kernel begins. */
static inline int32_t t3r_padding(const t3r_layer *layer)
{
    return (layer->kernel - layer->stride + 1) / 2;
}

static inline uint32_t t3r_sources_of(const t3r_layer *layer)
{
    return layer->source[1] == T3R_SOURCE_NONE ? 1 : 2;
}

static inline uint8_t *t3r_node_row(const t3r_node *node, uint32_t y)
{
    return node->rows + (size_t)(y % node->ring) * node->pitch;
}

/* --- rows (network_rows.c) ---------------------------------------------------------------------------------------- */

/* Computes the number of rows of each node that the points of image row y need, as if the image had no top and no
 * bottom; y may be negative. T3R_NOT_READ: no layer reads the node. */
void t3r_rows_needed(const t3r_network *net, int32_t y, int32_t need[T3R_MAX_LAYERS + 1]);

/* Returns the same, clamped to the existing rows. */
uint32_t t3r_rows_due(const t3r_node *node, int32_t need);

/* Lays out shapes, rings and places of the network's indispensable work; used both for sizing and for running. Returns
 * the bytes. */
uint64_t t3r_network_lay_out(t3r_network *net, const void *weights, uint32_t width, uint32_t height, uint8_t *work);

/* Moves each node to the first row that the band's points read. */
void t3r_skip_rows(t3r_network *net);

/* --- activations for the kernels (network_gather.c) --------------------------------------------------------------- */

/* The rows under a layer's kernel at one of its own rows. */
typedef struct t3r_window {
    const t3r_layer *layer;
    uint32_t grid_width;
    struct {
        const t3r_node *node;
        uint32_t coarser;                   /* the source's level above the grid's */
        const uint8_t *row[T3R_MAX_KERNEL]; /* NULL = beyond the grid */
    } source[2];
} t3r_window;

t3r_window t3r_window_at(const t3r_network *net, const t3r_layer *layer, uint32_t y);

/* Gathers a layer's inputs at its columns x.. of that row: at most `width` columns, and no more than fit the work. */
t3r_block t3r_gather_columns(const t3r_network *net, const t3r_window *w, uint32_t x, uint32_t width);
t3r_block t3r_gather_strips(const t3r_network *net, const t3r_window *w, uint32_t x, uint32_t width);

/* Gathers point layer n's inputs at the first of `count` pixels of row y. made: the outputs of the previous point
 * layer, made_pitch bytes a pixel. */
t3r_block t3r_gather_points(const t3r_network *net, uint32_t n, uint32_t y, uint32_t count, const uint32_t *x,
                            const int8_t (*features)[T3R_FEATURES], const uint8_t *made, uint32_t made_pitch);

/* --- packed layers (network_pack.c) ------------------------------------------------------------------------------- */

/* Returns a layer for its kernel; phase: of a point layer with four. */
t3r_convolution t3r_convolution_of(const t3r_network *net, uint32_t n, uint32_t phase);

/* Whether layers are packed; a constant false for plain C, so that builds without variants omit the code for packed
 * layers. */
static inline bool t3r_is_packed(const t3r_network *net)
{
    return T3R_VARIANTS_COUNT > 0 && net->strips != NULL;
}

/* Packs the layers if the kernels take packed ones and `bytes` suffice. */
void t3r_pack_layers(t3r_network *net, uint8_t *work, size_t bytes);

/* Runs layer n on a gathered block. */
void t3r_run_layer(const t3r_network *net, uint32_t n, uint32_t phase, const t3r_block *block, void *out,
                   uint32_t out_pitch);

#endif
