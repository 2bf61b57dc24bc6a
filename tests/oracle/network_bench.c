/* SPDX-License-Identifier: Apache-2.0 */
/* network_bench: multiply-accumulates per second on one core of heads of the shipped sizes, for every width of weights
 * and activations, at all points and at one in ten; and their work memory per column. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "head/network.h"
#include "weights_maker.h"

enum { SIDE = 256, ROUNDS = 5 };

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int8_t features[SIDE][SIDE * T3R_FEATURES];

static void run(const void *weights, void *work, size_t work_bytes, uint32_t every)
{
    t3r_network net;
    t3r_network_begin(&net, &t3r_kernels_c, weights, SIDE, SIDE, 0, work, work_bytes);
    for (int32_t y = t3r_network_first(&net); y < SIDE; y++) {
        while (t3r_network_wants_features(&net, y)) {
            uint32_t row;
            int8_t *to = t3r_network_feature_row(&net, &row);
            for (int i = 0; i < SIDE * T3R_FEATURES; i++) {
                to[i] = features[row][i];
            }
        }
        t3r_network_step(&net, y);
        for (uint32_t x = 0; y >= 0 && x < SIDE; x += T3R_NETWORK_POINTS * every) {
            uint32_t block[T3R_NETWORK_POINTS];
            int8_t own[T3R_NETWORK_POINTS][T3R_FEATURES] = {0};
            int16_t out[T3R_NETWORK_POINTS][T3R_HEAD_OUTPUTS];
            for (uint32_t i = 0; i < T3R_NETWORK_POINTS; i++) {
                block[i] = (x + 2 * i) % SIDE / 2 * 2;
            }
            t3r_network_points(&net, (uint32_t)y, T3R_NETWORK_POINTS, block, (const int8_t(*)[T3R_FEATURES])own, out);
        }
    }
}

static void measure(const char *name, const made_layer *shape, uint32_t layers, uint32_t weight_bits,
                    uint32_t activation_bits)
{
    size_t bytes;
    uint8_t *weights = make_weights(shape, layers, weight_bits, activation_bits, 1, &bytes);
    const char *error = t3r_weights_error(weights, bytes);
    if (error != NULL) {
        fprintf(stderr, "%s: %s\n", name, error);
        exit(1);
    }
    size_t work_bytes = t3r_network_work_bytes(weights, SIDE);
    void *work = aligned_alloc(64, (work_bytes + 63) / 64 * 64);
    double best[2] = {1e9, 1e9};
    for (int round = 0; round < ROUNDS; round++) {
        for (int k = 0; k < 2; k++) {
            double start = seconds();
            run(weights, work, work_bytes, k == 0 ? 1 : 10);
            double took = seconds() - start;
            best[k] = took < best[k] ? took : best[k];
        }
    }
    double macs = t3r_weights_header_of(weights).macs_q8 / 256.0;
    printf("%-5s w%-2u a%-2u %6.0f MAC/px %6zu bytes; %6.2f ms, %5.1f GMAC/s; at 10 %% kept %6.2f ms; work %zu = %zu + "
           "%zu a column\n",
           name, weight_bits, activation_bits, macs, bytes, best[0] * 1e3, macs * SIDE * SIDE / best[0] * 1e-9,
           best[1] * 1e3, work_bytes, 2 * work_bytes - t3r_network_work_bytes(weights, 2 * SIDE),
           (t3r_network_work_bytes(weights, 2 * SIDE) - work_bytes) / SIDE);
    free(work);
    free(weights);
}

int main(void)
{
    for (size_t i = 0; i < sizeof features; i++) {
        features[i / sizeof *features][i % sizeof *features] = (int8_t)((uint32_t)i * 2654435761u >> 24);
    }
    for (uint32_t bits = 0; bits < 4; bits++) {
        measure("small", small_shape, small_layers, bits & 1 ? 16 : 8, bits & 2 ? 16 : 8);
    }
    for (uint32_t bits = 0; bits < 4; bits++) {
        measure("wide", wide_shape, wide_layers, bits & 1 ? 16 : 8, bits & 2 ? 16 : 8);
    }
    return 0;
}
