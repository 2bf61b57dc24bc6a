/* SPDX-License-Identifier: Apache-2.0 */
/* network_driver WEIGHTS WIDTH HEIGHT: features (int8, [height][width][9]) and a mask (a byte a pixel) on stdin. Runs
 * the network row by row in exactly the work memory it asks for and writes, in host order, a record for every row of a
 * plane layer as it is made (uint32 layer, row, bytes; the row), then the outputs at the masked pixels in raster order
 * (layer 0xffffffff). For network_numpy.py. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "head/network.h"

static void *read_file(const char *path, size_t *bytes)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL || fseek(file, 0, SEEK_END) != 0) {
        return NULL;
    }
    *bytes = (size_t)ftell(file);
    void *all =
        aligned_alloc(T3R_WEIGHTS_ALIGN, (*bytes + T3R_WEIGHTS_ALIGN - 1) / T3R_WEIGHTS_ALIGN * T3R_WEIGHTS_ALIGN);
    rewind(file);
    size_t count = all == NULL ? 0 : fread(all, 1, *bytes, file);
    fclose(file);
    return count == *bytes ? all : NULL;
}

static void put(uint32_t layer, uint32_t row, const void *data, size_t bytes)
{
    const uint32_t head[3] = {layer, row, (uint32_t)bytes};
    fwrite(head, sizeof head, 1, stdout);
    fwrite(data, 1, bytes, stdout);
}

static void put_new_rows(const t3r_network *net, const uint32_t *before)
{
    for (uint32_t n = 1; n <= net->planes; n++) {
        const t3r_node *node = &net->nodes[n];
        for (uint32_t y = before[n]; y < node->made; y++) {
            if (node->made - y <= node->ring) {
                put(n, y, node->rows + y % node->ring * node->pitch,
                    (size_t)node->width * node->channels * node->bytes);
            }
        }
    }
}

static void put_points(const t3r_network *net, uint32_t y, const int8_t *features, const uint8_t *mask)
{
    int16_t(*out)[T3R_HEAD_OUTPUTS] = calloc(net->width, sizeof *out);
    uint32_t points = 0;
    for (uint32_t parity = 0; parity < 2; parity++) {
        for (uint32_t x = parity; x < net->width; x += 2) { /* blocks of one to four, in the order of the mask */
            uint32_t block[T3R_NETWORK_POINTS], count = 0;
            int8_t own[T3R_NETWORK_POINTS][T3R_FEATURES];
            int16_t made[T3R_NETWORK_POINTS][T3R_HEAD_OUTPUTS];
            for (; x < net->width && count < 1 + (y + x) % T3R_NETWORK_POINTS; x += 2) {
                memcpy(own[count], features + (size_t)x * T3R_FEATURES, T3R_FEATURES);
                block[count++] = x;
            }
            x -= 2;
            if (count == 0) {
                break;
            }
            t3r_network_points(net, y, count, block, (const int8_t(*)[T3R_FEATURES])own, made);
            for (uint32_t i = 0; i < count; i++) {
                memcpy(out[block[i]], made[i], sizeof made[i]);
            }
        }
    }
    for (uint32_t x = 0; x < net->width; x++) {
        if (mask[x]) {
            memcpy(out[points++], out[x], sizeof *out);
        }
    }
    put(UINT32_MAX, y, out, points * sizeof *out);
    free(out);
}

int main(int argc, char **argv)
{
    if (argc != 4) {
        return 2;
    }
    size_t bytes = 0;
    const void *weights = read_file(argv[1], &bytes);
    uint32_t width = (uint32_t)atoi(argv[2]), height = (uint32_t)atoi(argv[3]);
    const char *error = weights == NULL ? "cannot be read" : t3r_weights_error(weights, bytes);
    if (error != NULL) {
        fprintf(stderr, "%s: %s\n", argv[1], error);
        return 3;
    }
    size_t row = (size_t)width * T3R_FEATURES, pixels = (size_t)width * height;
    int8_t *features = malloc(row * height);
    uint8_t *mask = malloc(pixels);
    size_t work_bytes = t3r_network_work_bytes(weights, width);
    uint8_t *work = malloc(work_bytes);
    if (features == NULL || mask == NULL || work == NULL || fread(features, 1, row * height, stdin) != row * height ||
        fread(mask, 1, pixels, stdin) != pixels) {
        return 1;
    }
    memset(work, 0xa5, work_bytes);
    t3r_network net;
    t3r_network_begin(&net, &t3r_kernels_c, weights, width, height, 0, work, work_bytes);
    for (int32_t y = t3r_network_first(&net); y < (int32_t)height; y++) {
        uint32_t before[T3R_MAX_LAYERS + 1], feature_row;
        for (uint32_t n = 0; n <= net.planes; n++) {
            before[n] = net.nodes[n].made;
        }
        while (t3r_network_wants_features(&net, y)) {
            int8_t *to = t3r_network_feature_row(&net, &feature_row);
            memcpy(to, features + feature_row * row, row);
        }
        t3r_network_step(&net, y);
        put_new_rows(&net, before);
        if (y >= 0) {
            put_points(&net, (uint32_t)y, features + (size_t)y * row, mask + (size_t)y * width);
        }
    }
    free(work);
    free(mask);
    free(features);
    free((void *)(uintptr_t)weights);
    return 0;
}
