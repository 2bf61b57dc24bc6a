/* SPDX-License-Identifier: Apache-2.0 */
/* The weight file's checker: valid files pass, and every field beyond its range is refused with its reason, for any
 * CRC. */
#include "unit/unit.h"

#include <stdbool.h>

#include "head/weights.h"
#include "weights_maker.h"

enum { HEADER = T3R_WEIGHTS_HEADER_BYTES, ROW = T3R_WEIGHTS_LAYER_BYTES };

/* conv to level 1, conv to level 2, depthwise there, a join back on level 1, two point layers */
static const made_layer shape[] = {
    {T3R_LAYER_CONV, 1, {0, T3R_SOURCE_NONE}, 6, 2, 1, 4},
    {T3R_LAYER_CONV, 2, {1, T3R_SOURCE_NONE}, 3, 2, 1, 5},
    {T3R_LAYER_DEPTHWISE, 2, {2, T3R_SOURCE_NONE}, 5, 1, 1, 5},
    {T3R_LAYER_CONV, 1, {1, 3}, 3, 1, 1, 6},
    {T3R_LAYER_POINT, 0, {4, 0}, 1, 1, 4, 7},
    {T3R_LAYER_POINT, 0, {5, T3R_SOURCE_NONE}, 1, 1, 1, 9},
};
enum { LAYERS = sizeof shape / sizeof *shape };

TEST(sound_ones_pass)
{
    for (uint32_t bits = 0; bits < 4; bits++) {
        size_t bytes;
        uint8_t *file = make_weights(shape, LAYERS, bits & 1 ? 16 : 8, bits & 2 ? 16 : 8, bits, &bytes);
        const char *error = t3r_weights_error(file, bytes);
        if (error != NULL) {
            fail_msg("%s", error);
        }
        assert_int_equal(t3r_weights_check(file, bytes), T3R_OK);
        t3r_weights_header header = t3r_weights_header_of(file);
        assert_int_equal(header.layers, LAYERS);
        assert_int_equal(header.bytes, bytes);
        t3r_layer join = t3r_weights_layer(file, 3);
        assert_int_equal(join.inputs, 9);
        assert_int_equal(join.source[1], 3);
        assert_int_equal(t3r_layer_taps(&join), 81);
        free(file);
    }
}

/* Up to 15 letters, digits and underscores. */
TEST(names)
{
    static const struct {
        const char *name; /* 16 characters leave no room for the end */
        t3r_status status;
    } cases[] = {{"a", T3R_OK},
                 {"z_9", T3R_OK},
                 {"_abcdefghijklm0", T3R_OK},
                 {"abcdefghijklmnop", T3R_ERR_WEIGHTS},
                 {"", T3R_ERR_WEIGHTS}};
    size_t bytes;
    uint8_t *file = make_weights(shape, LAYERS, 8, 8, 3, &bytes);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        memset(file + 32, 0, 16);
        memcpy(file + 32, cases[i].name, strlen(cases[i].name));
        seal_weights(file, bytes);
        assert_int_equal(t3r_weights_check(file, bytes), cases[i].status);
    }
    free(file);
}

typedef struct damage {
    size_t at;
    uint32_t value, bytes;
    const char *reason; /* part of the text */
} damage;

static void put(uint8_t *to, uint32_t value, uint32_t bytes)
{
    for (uint32_t i = 0; i < bytes; i++) {
        to[i] = (uint8_t)(value >> (8 * i));
    }
}

#define LAYER(n, field) (HEADER + ROW * ((n)-1) + (field))

TEST(every_field_is_checked)
{
    const damage damages[] = {
        {0, 0x57523355, 4, "not a weight file"},
        {4, 2, 2, "format"},
        {6, T3R_BITS_EPOCH + 1, 2, "epoch"},
        {16, 7, 1, "8 or 16 bits"},
        {16, 16, 1, ""}, /* blocks of twice the size, or other sums */
        {17, 9, 1, "8 or 16 bits"},
        {17, 16, 1, ""},
        {18, 0, 1, "1..24"},
        {18, 25, 1, "1..24"},
        {18, LAYERS - 1, 1, ""},
        {19, 2, 1, "features"},
        {20, 1, 4, "counts"},
        {24, 1, 4, "counts"},
        {28, 1, 4, "reserved"},
        {32, 0, 1, "name"},
        {32, 'A', 1, "name"},
        {33, 0, 1, "name"},
        {33, 'z' + 1, 1, "name"},
        {33, '9' + 1, 1, "name"},
        {33, '0' - 1, 1, "name"},
        {47, 'x', 1, "name"},
        {48, 1, 1, "reserved"},
        {63, 1, 1, "reserved"},
        {LAYER(1, 0), T3R_LAYER_KINDS, 1, "kind"},
        {LAYER(1, 0), T3R_LAYER_DEPTHWISE, 1, "kernel"},
        {LAYER(4, 0), T3R_LAYER_DEPTHWISE, 1, "depthwise"},
        {LAYER(2, 0), T3R_LAYER_POINT, 1, "point layer's level"},
        {LAYER(1, 1), 0, 1, "level"},
        {LAYER(1, 1), 2, 1, "source"},
        {LAYER(2, 1), 5, 1, "level"},
        {LAYER(2, 1), 3, 1, "source"},
        {LAYER(5, 1), 1, 1, "point layer's level"},
        {LAYER(1, 2), 1, 1, "source"},
        {LAYER(1, 2), 255, 1, "source"},
        {LAYER(2, 2), 0, 1, "source"},
        {LAYER(3, 3), 1, 1, "source"},
        {LAYER(4, 2), 3, 1, "inputs"},
        {LAYER(4, 3), 4, 1, "source"},
        {LAYER(4, 3), 255, 1, "inputs"},
        {LAYER(6, 2), 4, 1, "inputs"},
        {LAYER(1, 4), 8, 2, "inputs"},
        {LAYER(1, 4), 0, 2, "channels"},
        {LAYER(1, 4), 129, 2, "channels"},
        {LAYER(1, 6), 0, 2, "channels"},
        {LAYER(1, 6), 129, 2, "channels"},
        {LAYER(1, 6), 3, 2, "inputs"},
        {LAYER(3, 6), 4, 2, "depthwise"},
        {LAYER(6, 6), 8, 2, "9 outputs"},
        {LAYER(1, 8), 0, 1, "kernel"},
        {LAYER(1, 8), 7, 1, "kernel"},
        {LAYER(3, 8), 6, 1, "kernel"},
        {LAYER(3, 8), 4, 1, "counts"},
        {LAYER(5, 8), 2, 1, "point layer's level"},
        {LAYER(1, 9), 0, 1, "stride"},
        {LAYER(1, 9), 3, 1, "stride"},
        {LAYER(1, 9), 1, 1, "source"},
        {LAYER(5, 9), 2, 1, "point layer's level"},
        {LAYER(1, 10), 4, 1, "phases"},
        {LAYER(1, 10), 0, 1, "phases"},
        {LAYER(5, 10), 2, 1, "point layer's level"},
        {LAYER(5, 10), 1, 1, "counts"},
        {LAYER(1, 11), 1, 1, "reserved"},
        {LAYER(1, 12), 128, 2, "int8"},
        {LAYER(1, 12), (uint16_t)-129, 2, "int8"},
        {LAYER(6, 12), 1, 2, "linear"},
        {LAYER(1, 14), 1, 1, "reserved"},
        {LAYER(1, 15), 1, 1, "reserved"},
    };
    size_t bytes;
    uint8_t *good = make_weights(shape, LAYERS, 8, 8, 7, &bytes), *file = aligned_alloc(16, (bytes + 15) / 16 * 16);
    for (size_t i = 0; i < sizeof damages / sizeof *damages; i++) {
        memcpy(file, good, bytes);
        put(file + damages[i].at, damages[i].value, damages[i].bytes);
        seal_weights(file, bytes);
        const char *error = t3r_weights_error(file, bytes);
        if (error == NULL || strstr(error, damages[i].reason) == NULL) {
            fail_msg("damage %zu at byte %zu: '%s', not '%s'", i, damages[i].at, error == NULL ? "sound" : error,
                     damages[i].reason);
        }
        assert_int_equal(t3r_weights_check(file, bytes), T3R_ERR_WEIGHTS);
    }
    free(file);
    free(good);
}

/* Offsets: into the table, unaligned, up to and beyond the end. */
TEST(blocks_lie_in_the_file)
{
    size_t bytes;
    uint8_t *good = make_weights(shape, LAYERS, 16, 16, 3, &bytes), *file = aligned_alloc(16, (bytes + 15) / 16 * 16);
    for (uint32_t n = 1; n <= LAYERS; n++) {
        for (uint32_t field = 16; field < 32; field += 4) {
            const uint32_t wrong[] = {0,
                                      HEADER + ROW * LAYERS - 16,
                                      HEADER + ROW * LAYERS + 8,
                                      (uint32_t)(bytes + 15) / 16 * 16,
                                      (uint32_t)(bytes + 31) / 16 * 16,
                                      UINT32_MAX - 15,
                                      0x80000000u};
            for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
                memcpy(file, good, bytes);
                put(file + LAYER(n, field), wrong[i], 4);
                seal_weights(file, bytes);
                assert_non_null(strstr(t3r_weights_error(file, bytes), "block"));
            }
        }
    }
    free(file);
    free(good);
}

/* A multiplier, a shift, a bias or a weight one beyond the bound on the sums. */
TEST(numbers_are_bounded)
{
    size_t bytes;
    uint8_t *good = make_weights(shape, LAYERS, 8, 8, 5, &bytes), *file = aligned_alloc(16, (bytes + 15) / 16 * 16);
    for (uint32_t n = 1; n <= LAYERS; n++) {
        t3r_layer layer = t3r_weights_layer(good, n - 1);
        uint32_t taps = t3r_layer_taps(&layer), last = (uint32_t)layer.phases * layer.outputs - 1;
        size_t multiplier = layer.multiplier + 4u * (layer.outputs - 1u), shift = layer.shift + layer.outputs - 1u;
        const damage damages[] = {
            {multiplier, (1u << 30) - 1, 4, "multiplier"},
            {multiplier, 0x80000000u, 4, "multiplier"},
            {shift, 16, 1, "shift"},
            {shift, (uint8_t)-31, 1, "shift"},
            {layer.bias + 4u * last, INT32_MAX, 4, "sums"},
            {layer.bias + 4u * last, 0x80000000u, 4, "sums"},
        };
        for (size_t i = 0; i < sizeof damages / sizeof *damages; i++) {
            memcpy(file, good, bytes);
            put(file + damages[i].at, damages[i].value, damages[i].bytes);
            seal_weights(file, bytes);
            const char *error = t3r_weights_error(file, bytes);
            if (error == NULL || strstr(error, damages[i].reason) == NULL) {
                fail_msg("layer %u, damage %zu: %s", n, i, error == NULL ? "sound" : error);
            }
        }
        /* exactly at the bound: 2^31 - 1 passes; one more step of a weight, 128, does not */
        memcpy(file, good, bytes);
        bool depthwise = layer.kind == T3R_LAYER_DEPTHWISE;
        size_t row = layer.weights + (depthwise ? last : (size_t)last * taps), step = depthwise ? layer.outputs : 1;
        for (uint32_t t = 0; t < taps; t++) {
            file[row + t * step] = t == 0 ? 1 : 0;
        }
        put(file + layer.bias + 4u * last, INT32_MAX - 128u, 4);
        seal_weights(file, bytes);
        assert_null(t3r_weights_error(file, bytes));
        put(file + layer.bias + 4u * last, 0u - (INT32_MAX - 128u), 4);
        seal_weights(file, bytes);
        assert_null(t3r_weights_error(file, bytes));
        file[row] = (uint8_t)-2;
        seal_weights(file, bytes);
        assert_non_null(strstr(t3r_weights_error(file, bytes), "sums"));
    }
    free(file);
    free(good);
}

/* Any flipped bit and any other length is detected, by the length or the CRC. */
TEST(damage_is_noticed)
{
    size_t bytes;
    uint8_t *file = make_weights(shape, LAYERS, 8, 8, 9, &bytes);
    for (size_t bit = 0; bit < bytes * 8; bit += bit < HEADER * 8 ? 1 : 37) {
        file[bit / 8] ^= (uint8_t)(1u << bit % 8);
        assert_non_null(t3r_weights_error(file, bytes));
        file[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
    for (size_t shorter = 0; shorter < bytes; shorter += shorter < 300 ? 1 : 101) {
        uint8_t *cut = aligned_alloc(16, (shorter + 31) / 16 * 16);
        memcpy(cut, file, shorter);
        assert_non_null(t3r_weights_error(cut, shorter));
        if (shorter >= HEADER) {
            seal_weights(cut, shorter);
            assert_non_null(t3r_weights_error(cut, shorter));
        }
        free(cut);
    }
    assert_int_equal(t3r_weights_check(file + 8, bytes - 8), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_weights_check(NULL, bytes), T3R_ERR_ARGUMENT);
    assert_null(t3r_weights_error(file, bytes));
    free(file);
}

/* Errors that only the whole graph reveals. */
TEST(graphs_are_checked)
{
    const made_layer unread[] = {
        {T3R_LAYER_CONV, 0, {0, T3R_SOURCE_NONE}, 3, 1, 1, 4},
        {T3R_LAYER_POINT, 0, {0, T3R_SOURCE_NONE}, 1, 1, 1, 9},
    };
    const made_layer behind[] = {
        {T3R_LAYER_POINT, 0, {0, T3R_SOURCE_NONE}, 1, 1, 1, 4},
        {T3R_LAYER_CONV, 0, {0, T3R_SOURCE_NONE}, 3, 1, 1, 4},
        {T3R_LAYER_POINT, 0, {2, T3R_SOURCE_NONE}, 1, 1, 1, 9},
    };
    const made_layer reading_points[] = {
        {T3R_LAYER_POINT, 0, {0, T3R_SOURCE_NONE}, 1, 1, 1, 4},
        {T3R_LAYER_CONV, 0, {1, T3R_SOURCE_NONE}, 3, 1, 1, 4},
        {T3R_LAYER_POINT, 0, {2, T3R_SOURCE_NONE}, 1, 1, 1, 9},
    };
    const made_layer skipping[] = {
        {T3R_LAYER_POINT, 0, {0, T3R_SOURCE_NONE}, 1, 1, 1, 4},
        {T3R_LAYER_POINT, 0, {1, T3R_SOURCE_NONE}, 1, 1, 1, 4},
        {T3R_LAYER_POINT, 0, {2, 1}, 1, 1, 1, 9},
    };
    const made_layer plane_last[] = {{T3R_LAYER_CONV, 0, {0, T3R_SOURCE_NONE}, 3, 1, 1, 9}};
    const made_layer heavy[] = {
        {T3R_LAYER_CONV, 0, {0, T3R_SOURCE_NONE}, 1, 1, 1, 64},
        {T3R_LAYER_CONV, 0, {1, T3R_SOURCE_NONE}, 4, 1, 1, 64},
        {T3R_LAYER_POINT, 0, {2, T3R_SOURCE_NONE}, 1, 1, 1, 9},
    };
    const struct {
        const made_layer *layers;
        uint32_t count;
        const char *reason;
    } graphs[] = {{unread, 2, "read by none"}, {behind, 3, "follows"},        {reading_points, 3, "source"},
                  {skipping, 3, "source"},     {plane_last, 1, "last layer"}, {heavy, 3, "multiply-accumulates"}};
    for (size_t i = 0; i < sizeof graphs / sizeof *graphs; i++) {
        size_t bytes;
        uint8_t *file = make_weights(graphs[i].layers, graphs[i].count, 8, 8, i, &bytes);
        const char *error = t3r_weights_error(file, bytes);
        if (error == NULL || strstr(error, graphs[i].reason) == NULL) {
            fail_msg("graph %zu: %s", i, error == NULL ? "sound" : error);
        }
        free(file);
    }
}

/* A file's length is limited, even if all else is valid. */
TEST(length_is_bounded)
{
    size_t bytes;
    uint8_t *file = make_weights(shape, LAYERS, 8, 8, 9, &bytes);
    uint8_t *long_file = aligned_alloc(16, T3R_MAX_WEIGHTS_BYTES + 16);
    memcpy(long_file, file, bytes);
    memset(long_file + bytes, 0, T3R_MAX_WEIGHTS_BYTES + 16 - bytes);
    seal_weights(long_file, T3R_MAX_WEIGHTS_BYTES);
    assert_null(t3r_weights_error(long_file, T3R_MAX_WEIGHTS_BYTES));
    seal_weights(long_file, T3R_MAX_WEIGHTS_BYTES + 1);
    assert_non_null(strstr(t3r_weights_error(long_file, T3R_MAX_WEIGHTS_BYTES + 1), "16 MiB"));
    free(long_file);
    free(file);
}
