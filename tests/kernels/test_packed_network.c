/* SPDX-License-Identifier: Apache-2.0 */
/* A learned head with packed layers, for each variant that this processor has, against plain C: all outputs of
 * pictures of any width, in bands, with enough work memory for packing or slightly less. A variant in plain C reads
 * strips of bytes, so that every processor tests them. */
#include <stdlib.h>
#include <string.h>

#include "head/network.h"
#include "host/cpu.h"
#include "sanitized.h"
#include "test.h"
#include "unit/unit.h"
#include "weights_maker.h"

enum { MOST_WIDTH = 90, MOST_HEIGHT = 40, MORE = 1 << 19, ROUNDS = T3R_SANITIZED ? 18 : 60, MOST_TAPS = 9 * 256 };

typedef struct picture {
    uint32_t width, height;
    int8_t features[MOST_HEIGHT][MOST_WIDTH][T3R_FEATURES];
} picture;

typedef int16_t outputs[MOST_HEIGHT][MOST_WIDTH][T3R_HEAD_OUTPUTS];

static void run_points(const t3r_network *net, const picture *p, uint32_t y, uint64_t *seed, outputs out)
{
    for (uint32_t parity = 0; parity < 2; parity++) {
        for (uint32_t u = parity; u < p->width;) {
            uint32_t x[T3R_NETWORK_POINTS], count = 0;
            int8_t own[T3R_NETWORK_POINTS][T3R_FEATURES];
            int16_t made[T3R_NETWORK_POINTS][T3R_HEAD_OUTPUTS];
            const uint32_t most = (uint32_t)unit_between(seed, 1, T3R_NETWORK_POINTS);
            for (; u < p->width && count < most; u += 2) {
                memcpy(own[count], p->features[y][u], T3R_FEATURES);
                x[count++] = u;
            }
            t3r_network_points(net, y, count, x, (const int8_t(*)[T3R_FEATURES])own, made);
            for (uint32_t i = 0; i < count; i++) {
                memcpy(out[y][x[i]], made[i], sizeof made[i]);
            }
        }
    }
}

/* Runs rows begin..end - 1. Returns whether the layers were packed. */
static bool run(const t3r_kernels *kernels, const void *weights, const picture *p, uint32_t begin, uint32_t end,
                size_t more, uint64_t *seed, outputs out)
{
    const size_t bytes = t3r_network_work_bytes(weights, p->width) + more;
    void *work = aligned_alloc(16, (bytes + 15) / 16 * 16);
    assert_non_null(work);
    memset(work, (int)(begin + 85), bytes);
    t3r_network net;
    t3r_network_begin(&net, kernels, weights, p->width, p->height, begin, work, bytes);
    for (int32_t y = t3r_network_first(&net); y < (int32_t)end; y++) {
        while (t3r_network_wants_features(&net, y)) {
            uint32_t row;
            int8_t *to = t3r_network_feature_row(&net, &row);
            memcpy(to, p->features[row], (size_t)p->width * T3R_FEATURES);
        }
        t3r_network_step(&net, y);
        if (y >= (int32_t)begin) {
            run_points(&net, p, (uint32_t)y, seed, out);
        }
    }
    free(work);
    return net.strips != NULL;
}

/* Packs by keeping the layer itself. */
static void keep_layer(const t3r_convolution *layer, uint32_t rows, void *packed)
{
    assert_in_range(sizeof *layer, 1, t3r_packed_bytes(rows, layer->taps / rows, layer->outputs));
    assert_in_range(layer->taps, 1, MOST_TAPS);
    memcpy(packed, layer, sizeof *layer);
}

static void convolve_bytes(const t3r_convolution *layer, const void *packed, const t3r_block *block, void *out,
                           uint32_t out_pitch)
{
    const t3r_convolution *kept = packed;
    const size_t out_bytes = (size_t)out_pitch * layer->output_bits / 8;
    for (uint32_t i = 0; i < block->pixels; i++) {
        _Alignas(16) int16_t column[MOST_TAPS] = {0};
        for (uint32_t tap = 0; tap < kept->taps; tap++) {
            const uint32_t run = tap / block->run, at = tap % block->run;
            column[tap] = (int16_t)(((const uint8_t *)block->x)[run * block->pitch + i * block->step + at] - 128);
        }
        const t3r_block one = {.x = column, .rows = 1, .run = kept->taps, .step = MOST_TAPS, .pixels = 1};
        t3r_convolve_c(kept, &one, (uint8_t *)out + i * out_bytes, out_pitch);
    }
}

/* Returns a table: in turn with 16-bit strips, with this processor's best, and with byte strips in plain C. */
static t3r_kernels table_of(uint32_t round)
{
    t3r_kernels kernels = t3r_kernels_c;
    switch (round / 2 % 3) {
    case 0:
        t3r_kernels_choose(&kernels, T3R_CPU_AVX2 & t3r_cpu_features());
        break;
    case 1:
        t3r_kernels_choose(&kernels, t3r_cpu_features());
        break;
    default:
        kernels.pack_layer = keep_layer;
        kernels.convolve_packed = convolve_bytes;
        kernels.strip_bytes = 1;
    }
    return kernels;
}

TEST(packed_layers_give_the_same)
{
    static picture p;
    static outputs expected, made;
    uint64_t seed = 1;
    uint32_t packed[2] = {0}; /* by variants, and by plain C */
    for (uint32_t round = 0; round < ROUNDS; round++) {
        size_t bytes;
        uint8_t *weights = round % 2 == 0 ? make_weights(small_shape, small_layers, 8, 8, round, &bytes)
                                          : make_weights(wide_shape, wide_layers, 8, 8, round, &bytes);
        const t3r_kernels kernels = table_of(round);
        uint32_t *runs = &packed[kernels.convolve_packed == convolve_bytes];
        p.width = (uint32_t)unit_between(&seed, 1, MOST_WIDTH);
        p.height = (uint32_t)unit_between(&seed, 1, MOST_HEIGHT);
        for (size_t i = 0; i < sizeof p.features; i++) {
            ((int8_t *)p.features)[i] = (int8_t)unit_between(&seed, -128, 127);
        }
        assert_false(run(&t3r_kernels_c, weights, &p, 0, p.height, MORE, &seed, expected));
        const uint32_t middle = (uint32_t)unit_between(&seed, 0, p.height - 1);
        const size_t more = round % 4 == 3 ? (size_t)unit_between(&seed, 0, 1 << 17) : MORE;
        memset(made, 0, sizeof made);
        if (middle > 0) {
            *runs += run(&kernels, weights, &p, 0, middle, more, &seed, made);
        }
        *runs += run(&kernels, weights, &p, middle, p.height, more, &seed, made);
        for (uint32_t y = 0; y < p.height; y++) {
            assert_memory_equal(made[y], expected[y], p.width * sizeof made[y][0]);
        }
        free(weights);
    }
    t3r_kernels kernels;
    t3r_kernels_choose(&kernels, t3r_cpu_features());
    assert_true(kernels.pack_layer == NULL ? packed[0] == 0 : packed[0] > 2 * ROUNDS / 3);
    assert_true(packed[1] > ROUNDS / 3);
}
