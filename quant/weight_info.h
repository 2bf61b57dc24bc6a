/* Reads a weight file back, checks every field and says what is wrong: the host's counterpart of t3r_weights_check(),
 * which refuses the same files with the device's short messages. The two readers were written independently: each is
 * the other's oracle under the fuzzer. */
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

/* Returns 0, or -1 with "what, where" in error[]. */
int weight_info_read(weight_info *info, const uint8_t *bytes, size_t count, char *error, size_t error_bytes);

/* Fills in what the file of a float head with these bits would contain: offsets, zero points and CRC are missing. */
void weight_info_of_graph(weight_info *info, const head_graph *graph, uint32_t weight_bits, uint32_t activation_bits);

/* Returns the bytes of layer n's blocks (counted from 1) without padding. */
size_t weight_info_layer_bytes(const weight_info *info, uint32_t n);

#endif
