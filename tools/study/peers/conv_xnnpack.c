/* SPDX-License-Identifier: Apache-2.0 */
/* conv_xnnpack [RUNS]: measures an int8 network of a head's shape with XNNPACK on one thread, in 10^9
 * multiply-accumulates a second. */
#include <xnnpack.h>

#include "shape.h"

static xnn_operator_t operators[LAYERS];

static int run(void)
{
    for (int l = 0; l < LAYERS; l++) {
        if (xnn_run_operator(operators[l], NULL) != xnn_status_success) {
            return -1;
        }
    }
    return 0;
}

int main(int argc, char **argv)
{
    static int32_t bias[CHANNELS_MOST];
    /* XNNPACK may read 16 bytes beyond a tensor */
    const size_t bytes = (size_t)VIEWS * SIDE * SIDE * CHANNELS_MOST + 16;
    int8_t *planes[LAYERS + 1];
    for (int l = 0; l <= LAYERS; l++) {
        planes[l] = filled(bytes, 100);
    }
    enum xnn_status status = xnn_initialize(NULL);
    for (int l = 0; l < LAYERS && status == xnn_status_success; l++) {
        const size_t inputs = layers[l].inputs, outputs = layers[l].outputs, side = layers[l].side;
        const uint32_t k = (uint32_t)side, border = k / 2;
        status = xnn_create_convolution2d_nhwc_qs8(
            border, border, border, border, k, k, 1, 1, 1, 1, 1, inputs, outputs, inputs, outputs, 0, 1.0f, 0.01f,
            filled(inputs * outputs * side * side, 100), bias, 0, 4.0f, 0, 127, 0, &operators[l]);
        if (status == xnn_status_success) {
            status = xnn_setup_convolution2d_nhwc_qs8(operators[l], VIEWS, SIDE, SIDE, planes[l], planes[l + 1], NULL);
        }
    }
    if (status != xnn_status_success) {
        fprintf(stderr, "conv_xnnpack: status %d\n", (int)status);
        return 1;
    }
    return print_rate(runs_of(argc, argv), run);
}
