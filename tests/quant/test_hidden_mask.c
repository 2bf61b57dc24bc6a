/* SPDX-License-Identifier: Apache-2.0 */
/* A head that does not see the mask, against the head itself on features that say all is retained. */
#include <stdlib.h>
#include <string.h>

#include "core/fixed.h"
#include "head/network.h"
#include "hidden_mask.h"
#include "test.h"
#include "trim3r_heads.h"
#include "weights_maker.h"

enum { W = 118, H = 110, PIXELS = W * H, MARGIN = 46 }; /* the widest head has a radius of 45 pixels */

static int8_t seen[PIXELS][T3R_FEATURES];
static int16_t expected[PIXELS][T3R_HEAD_OUTPUTS], made[PIXELS][T3R_HEAD_OUTPUTS];

static uint8_t *aligned_copy(const uint8_t *bytes, size_t count)
{
    void *copy = NULL;
    assert_int_equal(posix_memalign(&copy, T3R_WEIGHTS_ALIGN, count), 0);
    memcpy(copy, bytes, count);
    return copy;
}

static uint8_t *hidden_of(const uint8_t *file, size_t *count)
{
    uint8_t *bytes = hidden_mask_make(file, count);
    assert_non_null(bytes);
    uint8_t *copy = aligned_copy(bytes, *count);
    free(bytes);
    assert_null(t3r_weights_error(copy, *count));
    return copy;
}

static void fill_features(uint32_t seed)
{
    for (uint32_t i = 0; i < PIXELS; i++) {
        for (uint32_t c = 0; c < T3R_FEATURES; c++) {
            seen[i][c] = (int8_t)(t3r_mix32(seed + i * T3R_FEATURES + c) >> 24);
        }
    }
}

static void nothing_pruned(void)
{
    for (uint32_t i = 0; i < PIXELS; i++) {
        seen[i][3] = 127;
        seen[i][5] = 64;
    }
}

/* Computes the outputs at every pixel. */
static void run(const uint8_t *file, int16_t (*out)[T3R_HEAD_OUTPUTS])
{
    const size_t work_bytes = t3r_network_work_bytes(file, W);
    void *work = malloc(work_bytes);
    assert_non_null(work);
    t3r_network net;
    t3r_network_begin(&net, &t3r_kernels_c, file, W, H, 0, work, work_bytes);
    for (int32_t y = t3r_network_first(&net); y < H; y++) {
        while (t3r_network_wants_features(&net, y)) {
            uint32_t row;
            int8_t *to = t3r_network_feature_row(&net, &row);
            memcpy(to, seen[row * W], sizeof seen[0] * W);
        }
        t3r_network_step(&net, y);
        for (uint32_t x = 0; y >= 0 && x < W; x++) {
            size_t pixel = (size_t)y * W + x;
            t3r_network_points(&net, (uint32_t)y, 1, &x, (const int8_t(*)[T3R_FEATURES])seen[pixel], &out[pixel]);
        }
    }
    free(work);
}

/* Returns the number of pixels in the middle, of (W - 2 MARGIN) (H - 2 MARGIN), at which the two differ. */
static uint32_t differing(void)
{
    uint32_t count = 0;
    for (uint32_t y = MARGIN; y < H - MARGIN; y++) {
        for (uint32_t x = MARGIN; x < W - MARGIN; x++) {
            count += memcmp(expected[y * W + x], made[y * W + x], sizeof made[0]) != 0;
        }
    }
    return count;
}

/* With any mask the copy gives the outputs of the original head with nothing pruned, bit for bit. */
static void check_head(const uint8_t *file, size_t bytes)
{
    const uint32_t middle = (W - 2 * MARGIN) * (H - 2 * MARGIN);
    size_t count;
    assert_null(t3r_weights_error(file, bytes));
    uint8_t *hidden = hidden_of(file, &count);
    assert_true(count > bytes);
    fill_features(1);
    nothing_pruned();
    run(file, expected);
    fill_features(1); /* equal except for those two */
    run(hidden, made);
    assert_int_equal(differing(), 0);
    run(file, made);
    assert_true(differing() > middle / 2); /* the original head sees them */
    fill_features(2);
    run(hidden, made);
    assert_true(differing() > middle / 2); /* and the copy sees the others */

    t3r_weights_header before = t3r_weights_header_of(file), after = t3r_weights_header_of(hidden);
    assert_int_equal(before.macs_q8, after.macs_q8);
    assert_int_equal(before.parameters, after.parameters);
    assert_int_not_equal(before.crc, after.crc);
    free(hidden);
}

TEST(made_heads)
{
    for (uint32_t bits = 0; bits < 4; bits++) {
        size_t bytes;
        uint32_t weight_bits = bits & 1 ? 16 : 8, activation_bits = bits & 2 ? 16 : 8;
        uint8_t *file = make_weights(small_shape, small_layers, weight_bits, activation_bits, 7 + bits, &bytes);
        check_head(file, bytes);
        free(file);
        file = make_weights(wide_shape, wide_layers, weight_bits, activation_bits, 70 + bits, &bytes);
        check_head(file, bytes);
        free(file);
    }
}

/* Features that a depthwise layer reads as first and second source, and a point layer of four phases. */
TEST(every_kind_of_layer)
{
    const made_layer layers[] = {
        {T3R_LAYER_DEPTHWISE, 0, {T3R_SOURCE_FEATURES, T3R_SOURCE_NONE}, 3, 1, 1, T3R_FEATURES},
        {T3R_LAYER_CONV, 0, {T3R_SOURCE_FEATURES, 1}, 3, 1, 1, 7},
        {T3R_LAYER_CONV, 1, {2, T3R_SOURCE_FEATURES}, 4, 2, 1, 10},
        {T3R_LAYER_POINT, 0, {3, T3R_SOURCE_FEATURES}, 1, 1, 4, 11},
        {T3R_LAYER_POINT, 0, {4, T3R_SOURCE_NONE}, 1, 1, 1, T3R_HEAD_OUTPUTS},
    };
    for (uint32_t bits = 0; bits < 4; bits++) {
        size_t bytes;
        uint8_t *file = make_weights(layers, 5, bits & 1 ? 16 : 8, bits & 2 ? 16 : 8, 3 + bits, &bytes);
        check_head(file, bytes);
        free(file);
    }
}

TEST(shipped_heads)
{
    const uint8_t *const heads[] = {t3r_head_tiny, t3r_head_small};
    const uint32_t bytes[] = {t3r_head_tiny_bytes, t3r_head_small_bytes};
    for (int h = 0; h < 2; h++) {
        check_head(heads[h], bytes[h]);
    }
}

/* Layers with shared bytes: one that does not read features keeps its own. */
TEST(shared_blocks)
{
    const made_layer layers[] = {
        {T3R_LAYER_CONV, 0, {T3R_SOURCE_FEATURES, T3R_SOURCE_NONE}, 1, 1, 1, T3R_FEATURES},
        {T3R_LAYER_CONV, 0, {1, T3R_SOURCE_NONE}, 1, 1, 1, T3R_FEATURES},
        {T3R_LAYER_POINT, 0, {2, T3R_SOURCE_NONE}, 1, 1, 1, T3R_HEAD_OUTPUTS},
    };
    size_t bytes;
    uint8_t *file = make_weights(layers, 3, 8, 8, 11, &bytes);
    memcpy(file + T3R_WEIGHTS_HEADER_BYTES + T3R_WEIGHTS_LAYER_BYTES + 16, file + T3R_WEIGHTS_HEADER_BYTES + 16, 8);
    seal_weights(file, bytes);
    assert_int_equal(t3r_weights_layer(file, 0).weights, t3r_weights_layer(file, 1).weights);
    check_head(file, bytes);
    free(file);
}
