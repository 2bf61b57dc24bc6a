/* SPDX-License-Identifier: Apache-2.0 */
/* A learned head's layers, run row by row over an image or a band of its rows (SPEC.md, "Learned head: order").
 *
 * A plane layer keeps a ring of the rows that its readers still need, so activations take a few rows per layer, never a
 * plane. Point layers are evaluated at single pixels of the row just completed. The weights must have passed
 * t3r_weights_check().
 *
 *    t3r_network_begin(net, kernels, weights, width, height, first row of the band, work, work_bytes);
 *    for (y = t3r_network_first(net); y < end of the band; y++) {
 *        while (t3r_network_wants_features(net, y)) { fill t3r_network_feature_row(net, &row) }
 *        t3r_network_step(net, y);
 *        if (y >= first row of the band) { t3r_network_points(net, y, ...) any number of times }
 *    } */
#ifndef T3R_NETWORK_H
#define T3R_NETWORK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "kernels/kernels.h"
#include "weights.h"

#define T3R_NETWORK_POINTS 8 /* most points in a call, which share the loads of weights */

/* A source of layers: the features (node 0), or the output of plane layer n (node n). */
typedef struct t3r_node {
    uint32_t level, channels;
    uint32_t bytes; /* of an activation: 1 or 2 */
    int16_t factor; /* multiplier of one-byte activations: 256 for features beside int16 ones, else 1 */
    int16_t zero;
    uint32_t width, height; /* of its level */
    uint32_t ring;          /* rows kept; row y lies at y mod ring; 0: no plane layer reads it */
    uint32_t made;          /* the next row to make; starts at the first row that the band reads */
    size_t pitch;           /* bytes a row */
    uint8_t *rows;
} t3r_node;

typedef struct t3r_network {
    const t3r_kernels *kernels;
    const uint8_t *file;
    t3r_weights_header header;
    uint32_t width, height;
    uint32_t begin;  /* first row of the band */
    uint32_t planes; /* layers before the first point layer */
    t3r_layer layers[T3R_MAX_LAYERS];
    t3r_node nodes[T3R_MAX_LAYERS + 1];
    uint8_t *columns;      /* of a block, column_pitch int16 activations each: the activations under a kernel */
    uint32_t column_pitch; /* a multiple of 16 */
    uint8_t *strips;       /* the rows under a kernel if layers are packed, else NULL */
    uint8_t *packed[T3R_MAX_LAYERS];
} t3r_network;

/* Returns the work bytes for images of this width and any height; SIZE_MAX if they exceed size_t. */
size_t t3r_network_work_bytes(const void *weights, uint32_t width);

/* Returns the work bytes with which all kernels that take packed layers can pack these. SIZE_MAX: these layers cannot
 * be packed, because weights or activations have 16 bits, or one is depthwise. */
size_t t3r_network_packed_work_bytes(const void *weights, uint32_t width);

/* Prepares a pass over the rows of an image from row `begin` (below the height) on. Rows above it that its kernels
 * read are made, too, so that a band has the bits of the whole image. work: at least t3r_network_work_bytes() bytes,
 * aligned to 16. With more bytes the layers are packed, if the kernels take packed layers. */
void t3r_network_begin(t3r_network *net, const t3r_kernels *kernels, const void *weights, uint32_t width,
                       uint32_t height, uint32_t begin, void *work, size_t work_bytes);

/* Returns the first step, at most `begin`: earlier steps make the rows above the band at the same pace as those below.
 */
int32_t t3r_network_first(const t3r_network *net);

/* Whether step y needs another row of features; t3r_network_feature_row() returns its place, width x T3R_FEATURES, and
 * its number. */
bool t3r_network_wants_features(const t3r_network *net, int32_t y);
int8_t *t3r_network_feature_row(t3r_network *net, uint32_t *row);

/* Makes the rows of all plane layers that the points of image row y need. */
void t3r_network_step(t3r_network *net, int32_t y);

/* Computes the head's outputs at `count` (1..T3R_NETWORK_POINTS) pixels of row y, given their features. Their columns
 * x must be all even or all odd. */
void t3r_network_points(const t3r_network *net, uint32_t y, uint32_t count, const uint32_t *x,
                        const int8_t (*features)[T3R_FEATURES], int16_t (*out)[T3R_HEAD_OUTPUTS]);

#endif
