/* SPDX-License-Identifier: Apache-2.0 */
/* Describes a weight file. t3r_weights_check() decides whether it is valid; if its layers are not, the reason names
 * the layer and the field. */
#ifndef T3R_QUANT_WEIGHT_INFO_H
#define T3R_QUANT_WEIGHT_INFO_H

#include "head_graph.h"
#include "weight_file.h"

typedef struct weight_info {
    head_graph graph;
    uint32_t bits_epoch, weight_bits, activation_bits, crc, bytes;
    uint32_t macs_q8, parameters;
} weight_info;

/* Reads a weight file; 0, or -1 with a reason in error[]. */
int weight_info_read(weight_info *info, const uint8_t *bytes, size_t count, char *error, size_t error_bytes);

/* Describes a float head as a file of these bits would be, without CRC. */
void weight_info_of_graph(weight_info *info, const head_graph *graph, uint32_t weight_bits, uint32_t activation_bits);

/* Returns the bytes of layer n's blocks (counted from 1) without padding. */
size_t weight_info_layer_bytes(const weight_info *info, uint32_t n);

#endif
