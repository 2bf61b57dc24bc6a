/* Reads a weight file back, checks every field of it and says what is wrong: the host's sister of t3r_weights_check(),
 * which refuses the same files in the device's few words. Two readers, written apart: each is the other's oracle under
 * the fuzzer. */
#ifndef T3R_QUANT_WEIGHT_INFO_H
#define T3R_QUANT_WEIGHT_INFO_H

#include "head_graph.h"
#include "weight_file.h"

typedef struct weight_info {
    head_graph graph;
    uint32_t bits_epoch, weight_bits, activation_bits, crc, bytes;
    uint32_t macs_q8, parameters;
    int32_t zero[T3R_MAX_LAYERS];
    uint32_t offset[T3R_MAX_LAYERS][WEIGHT_BLOCKS];
} weight_info;

/* 0, or -1 with "what, where" in error[]. */
int weight_info_read(weight_info *info, const uint8_t *bytes, size_t count, char *error, size_t error_bytes);

/* What a float head would be as a file of these bits: no offsets, zeros, CRC. */
void weight_info_of_graph(weight_info *info, const head_graph *graph, uint32_t weight_bits, uint32_t activation_bits);

/* Bytes of layer n's blocks (counted from 1), padding left out. */
size_t weight_info_layer_bytes(const weight_info *info, uint32_t n);

#endif
