/* SPDX-License-Identifier: Apache-2.0 */
/* A weight file, random or damaged in a few places, with a valid checksum: refused with a reason, or it runs over a
 * small image in exactly the memory that it requests. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "head/network.h"
#include "weights_maker.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Small layers, so that much of a damaged file is table. */
static const made_layer shape[] = {
    {T3R_LAYER_CONV, 1, {0, T3R_SOURCE_NONE}, 6, 2, 1, 4},
    {T3R_LAYER_CONV, 2, {1, T3R_SOURCE_NONE}, 3, 2, 1, 5},
    {T3R_LAYER_DEPTHWISE, 2, {2, T3R_SOURCE_NONE}, 5, 1, 1, 5},
    {T3R_LAYER_CONV, 1, {1, 3}, 3, 1, 1, 6},
    {T3R_LAYER_POINT, 0, {4, 0}, 1, 1, 4, 7},
    {T3R_LAYER_POINT, 0, {5, T3R_SOURCE_NONE}, 1, 1, 1, 9},
};

static void run(const uint8_t *file, uint32_t width, uint32_t height)
{
    size_t bytes = t3r_network_work_bytes(file, width);
    if (bytes > 4 << 20) {
        return;
    }
    void *work = malloc(bytes);
    t3r_network net;
    t3r_network_begin(&net, &t3r_kernels_c, file, width, height, 0, work, bytes);
    for (int32_t y = t3r_network_first(&net); y < (int32_t)height; y++) {
        while (t3r_network_wants_features(&net, y)) {
            uint32_t row;
            int8_t *to = t3r_network_feature_row(&net, &row);
            memset(to, (int)(row * 77 & 255), (size_t)width * T3R_FEATURES);
        }
        t3r_network_step(&net, y);
        for (uint32_t x = 0; y >= 0 && x < width; x++) {
            int8_t features[1][T3R_FEATURES] = {{-128, 127, (int8_t)x}};
            int16_t out[1][T3R_HEAD_OUTPUTS];
            t3r_network_points(&net, (uint32_t)y, 1, &x, (const int8_t(*)[T3R_FEATURES])features, out);
        }
    }
    free(work);
}

/* data: bits and size of the image, then damages: two bytes with the place, one with the value. Above 255 the rest is
 * the file. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 3) {
        return 0;
    }
    size_t bytes;
    uint8_t *file;
    if (data[0] == 255) {
        bytes = size - 3;
        file = aligned_alloc(T3R_WEIGHTS_ALIGN, (bytes + T3R_WEIGHTS_ALIGN) / T3R_WEIGHTS_ALIGN * T3R_WEIGHTS_ALIGN);
        memcpy(file, data + 3, bytes);
    } else {
        uint32_t bits = data[0];
        file =
            make_weights(shape, sizeof shape / sizeof *shape, bits & 1 ? 16 : 8, bits & 2 ? 16 : 8, bits >> 2, &bytes);
        for (size_t i = 3; i + 3 <= size; i += 3) {
            size_t at = (size_t)(data[i] | data[i + 1] << 8);
            file[at < 0xc000 ? at % (64 + 32 * 6) : at % bytes] = data[i + 2];
        }
    }
    if (bytes >= T3R_WEIGHTS_HEADER_BYTES) {
        seal_weights(file, bytes);
    }
    const char *error = t3r_weights_error(file, bytes);
    if ((t3r_weights_check(file, bytes) == T3R_OK) != (error == NULL) || (error != NULL && error[0] == '\0')) {
        abort();
    }
    if (error == NULL) {
        run(file, 8 + data[1] % 24, 8 + data[2] % 24);
    }
    free(file);
    return 0;
}
