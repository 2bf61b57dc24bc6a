/* SPDX-License-Identifier: Apache-2.0 */
/* A head in floats, the output of training: a .safetensors file (README.md, "Float heads"). */
#ifndef T3R_QUANT_FLOAT_HEAD_H
#define T3R_QUANT_FLOAT_HEAD_H

#include "head_graph.h"

#define FLOAT_FEATURE_SCALE (1.0 / 64) /* value of an int8 feature's step in the float head */

typedef struct float_layer {
    float *weight; /* in the order of the weight file (head_weight_index()) */
    float *bias;   /* [phases][outputs] */
    float *range;  /* [outputs]: value of an output's positive full scale, > 0; NULL = not known yet */
} float_layer;

typedef struct float_head {
    head_graph graph;
    float_layer layers[T3R_MAX_LAYERS];
} float_head;

/* Returns 0, after which float_head_free() is due; or -1 with "what, where" in error[]. */
int float_head_parse(float_head *head, const void *bytes, size_t count, char *error, size_t error_bytes);
void float_head_free(float_head *head);

#endif
