/* SPDX-License-Identifier: Apache-2.0 */
#include "weight_info.h"

#include <stdlib.h>
#include <string.h>

#include "core/little_endian.h"
#include "quant_reason.h"
#include "trim3r.h"

static head_layer layer_of(const t3r_layer *from, uint32_t activation_bits)
{
    return (head_layer){
        .kind = from->kind,
        .level = from->level,
        .sources = {from->source[0], from->source[1]},
        .inputs = from->inputs,
        .outputs = from->outputs,
        .kernel = from->kernel,
        .stride = from->stride,
        .phases = from->phases,
        .relu = from->zero == (activation_bits == 8 ? INT8_MIN : INT16_MIN),
    };
}

/* Reads header and table, which must lie in the file. */
static void read_shape(weight_info *info, const uint8_t *bytes)
{
    const t3r_weights_header header = t3r_weights_header_of(bytes);
    *info = (weight_info){
        .graph.count = header.layers,
        .bits_epoch = T3R_BITS_EPOCH,
        .weight_bits = header.weight_bits,
        .activation_bits = header.activation_bits,
        .crc = header.crc,
        .bytes = header.bytes,
        .macs_q8 = header.macs_q8,
        .parameters = header.parameters,
    };
    memcpy(info->graph.name, bytes + WEIGHT_AT_NAME, HEAD_NAME_BYTES);
    for (uint32_t i = 0; i < header.layers; i++) {
        const t3r_layer layer = t3r_weights_layer(bytes, i);
        info->graph.layers[i] = layer_of(&layer, header.activation_bits);
    }
}

/* Checks aligned bytes. Faults are found in the order of their numbers, the header's before the layers';
 * head_graph_check() names the layer and field. */
static int check(weight_info *info, const uint8_t *bytes, size_t count, char *error, size_t error_bytes)
{
    const t3r_weights_fault fault = t3r_weights_fault_of(bytes, count);
    if (fault == T3R_FAULT_EPOCH) {
        return quant_reason(error, error_bytes, "made for bits epoch %u, this is epoch %d: quantize it again",
                            (unsigned)t3r_load_le16(bytes + WEIGHT_AT_EPOCH), T3R_BITS_EPOCH);
    }
    if (fault == T3R_FAULT_NONE || fault >= T3R_FAULT_KIND) {
        read_shape(info, bytes);
        if (head_graph_check(&info->graph, error, error_bytes) != 0) {
            return -1;
        }
    }
    return fault == T3R_FAULT_NONE ? 0 : quant_reason(error, error_bytes, "%s", t3r_weights_error(bytes, count));
}

int weight_info_read(weight_info *info, const uint8_t *bytes, size_t count, char *error, size_t error_bytes)
{
    void *aligned;
    if (posix_memalign(&aligned, T3R_WEIGHTS_ALIGN, count + 1) != 0) {
        return quant_reason(error, error_bytes, "out of memory");
    }
    memcpy(aligned, bytes, count);
    *info = (weight_info){0};
    const int status = check(info, aligned, count, error, error_bytes);
    free(aligned);
    return status;
}

void weight_info_of_graph(weight_info *info, const head_graph *graph, uint32_t weight_bits, uint32_t activation_bits)
{
    *info = (weight_info){
        .graph = *graph,
        .bits_epoch = T3R_BITS_EPOCH,
        .weight_bits = weight_bits,
        .activation_bits = activation_bits,
        .bytes = (uint32_t)weight_file_bytes(graph, weight_bits, activation_bits),
        .macs_q8 = weight_macs_q8(graph),
        .parameters = weight_parameters(graph),
    };
}

size_t weight_info_layer_bytes(const weight_info *info, uint32_t n)
{
    size_t bytes = 0;
    for (int b = 0; b < WEIGHT_BLOCKS; b++) {
        bytes += weight_block_bytes(&info->graph.layers[n - 1], (enum weight_block)b, info->weight_bits,
                                    info->activation_bits);
    }
    return bytes;
}
