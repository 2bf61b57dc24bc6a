/* SPDX-License-Identifier: Apache-2.0 */
/* conv_dnnl [RUNS]: measures an int8 network of a head's shape with oneDNN on one thread (OMP_NUM_THREADS=1), in 10^9
 * multiply-accumulates a second. */
#include <oneapi/dnnl/dnnl.h>

#include "shape.h"

typedef struct layer {
    dnnl_primitive_t convolution;
    dnnl_exec_arg_t arguments[4];
} layer;

static layer convolutions[LAYERS];
static dnnl_engine_t engine;
static dnnl_stream_t stream;

static void need(dnnl_status_t status, const char *what)
{
    if (status != dnnl_success) {
        fprintf(stderr, "conv_dnnl: %s: status %d\n", what, (int)status);
        exit(1);
    }
}

static dnnl_memory_desc_t described(int count, const dnnl_dims_t sides, dnnl_data_type_t type, dnnl_format_tag_t tag)
{
    dnnl_memory_desc_t description;
    need(dnnl_memory_desc_init_by_tag(&description, count, sides, type, tag), "a description");
    return description;
}

/* Allocates memory of that description, with any bytes. */
static dnnl_memory_t memory_of(const dnnl_memory_desc_t *description)
{
    dnnl_memory_t memory;
    need(dnnl_memory_create(&memory, description, engine, filled(dnnl_memory_desc_get_size(description), 100)),
         "memory");
    return memory;
}

/* Returns attributes that scale the sums to bytes and cut them off by relu. */
static dnnl_primitive_attr_t scaled(void)
{
    static const float scale = 0.0025f;
    dnnl_primitive_attr_t attributes;
    dnnl_post_ops_t behind;
    need(dnnl_primitive_attr_create(&attributes), "attributes");
    need(dnnl_primitive_attr_set_output_scales(attributes, 1, 0, &scale), "scales");
    need(dnnl_post_ops_create(&behind), "post-ops");
    need(dnnl_post_ops_append_eltwise(behind, 1.0f, dnnl_eltwise_relu, 0.0f, 0.0f), "relu");
    need(dnnl_primitive_attr_set_post_ops(attributes, behind), "post-ops");
    return attributes;
}

static dnnl_memory_t open_layer(int l, dnnl_memory_t source)
{
    const dnnl_dim_t inputs = (dnnl_dim_t)layers[l].inputs, outputs = (dnnl_dim_t)layers[l].outputs;
    const dnnl_dim_t side = (dnnl_dim_t)layers[l].side;
    const dnnl_dims_t sums = {outputs};
    const dnnl_dims_t from = {VIEWS, inputs, SIDE, SIDE}, to = {VIEWS, outputs, SIDE, SIDE};
    const dnnl_dims_t kernel = {outputs, inputs, side, side}, steps = {1, 1}, border = {side / 2, side / 2};
    const dnnl_memory_desc_t in = described(4, from, dnnl_u8, dnnl_nhwc), out = described(4, to, dnnl_u8, dnnl_nhwc);
    const dnnl_memory_desc_t weights = described(4, kernel, dnnl_s8, dnnl_format_tag_any);
    const dnnl_memory_desc_t bias = described(1, sums, dnnl_s32, dnnl_a);
    dnnl_convolution_desc_t description;
    dnnl_primitive_desc_t chosen;
    need(dnnl_convolution_forward_desc_init(&description, dnnl_forward_inference, dnnl_convolution_direct, &in,
                                            &weights, &bias, &out, steps, border, border),
         "a convolution");
    need(dnnl_primitive_desc_create(&chosen, &description, scaled(), engine, NULL), "an implementation");
    need(dnnl_primitive_create(&convolutions[l].convolution, chosen), "a primitive");
    const dnnl_memory_t result = memory_of(&out);
    const dnnl_exec_arg_t arguments[4] = {
        {DNNL_ARG_SRC, source},
        {DNNL_ARG_WEIGHTS, memory_of(dnnl_primitive_desc_query_md(chosen, dnnl_query_weights_md, 0))},
        {DNNL_ARG_BIAS, memory_of(&bias)},
        {DNNL_ARG_DST, result}};
    for (int i = 0; i < 4; i++) {
        convolutions[l].arguments[i] = arguments[i];
    }
    return result;
}

static int run(void)
{
    for (int l = 0; l < LAYERS; l++) {
        if (dnnl_primitive_execute(convolutions[l].convolution, stream, 4, convolutions[l].arguments) != dnnl_success) {
            return -1;
        }
    }
    return dnnl_stream_wait(stream) == dnnl_success ? 0 : -1;
}

int main(int argc, char **argv)
{
    need(dnnl_engine_create(&engine, dnnl_cpu, 0), "an engine");
    need(dnnl_stream_create(&stream, engine, dnnl_stream_default_flags), "a stream");
    const dnnl_dims_t first = {VIEWS, (dnnl_dim_t)layers[0].inputs, SIDE, SIDE};
    const dnnl_memory_desc_t in = described(4, first, dnnl_u8, dnnl_nhwc);
    dnnl_memory_t planes = memory_of(&in);
    for (int l = 0; l < LAYERS; l++) {
        planes = open_layer(l, planes);
    }
    return print_rate(runs_of(argc, argv), run);
}
