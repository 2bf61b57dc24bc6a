/* SPDX-License-Identifier: Apache-2.0 */
/* Rows of device pixels against plain definitions in floating point: every value, order, parity and edge. */
#include <stdbool.h>

#include "trim3r.h"
#include "unit/unit.h"

enum { MOST_WIDTH = 9, MOST_HEIGHT = 5, ALPHA_ONE = 32767 };

/* Returns `level` of 0..from as the nearest level of 0..to. */
static int rescaled(int level, int from, int to)
{
    return (int)floor((double)level * to / from + 0.5);
}

static uint8_t *random_bytes(size_t count, uint64_t *seed)
{
    uint8_t *bytes = unit_array(count, 1);
    for (size_t i = 0; i < count; i++) {
        bytes[i] = (uint8_t)unit_random(seed);
    }
    return bytes;
}

TEST(all_values_of_rgb565)
{
    for (uint32_t pixel = 0; pixel < 65536; pixel++) {
        const uint8_t low_first[] = {(uint8_t)pixel, (uint8_t)(pixel >> 8)};
        const uint8_t high_first[] = {(uint8_t)(pixel >> 8), (uint8_t)pixel};
        const uint8_t want[] = {(uint8_t)rescaled((int)(pixel >> 11), 31, 255),
                                (uint8_t)rescaled((int)(pixel >> 5 & 63), 63, 255),
                                (uint8_t)rescaled((int)(pixel & 31), 31, 255)};
        uint8_t rgb[3], back[2];
        assert_int_equal(t3r_unpack_row(T3R_PACKED_RGB565, low_first, 1, rgb), T3R_OK);
        assert_memory_equal(rgb, want, 3);
        assert_int_equal(t3r_unpack_row(T3R_PACKED_RGB565_BE, high_first, 1, rgb), T3R_OK);
        assert_memory_equal(rgb, want, 3);
        assert_int_equal(t3r_pack_row(T3R_PACKED_RGB565, rgb, NULL, 1, back), T3R_OK);
        assert_memory_equal(back, low_first, 2);
        assert_int_equal(t3r_pack_row(T3R_PACKED_RGB565_BE, rgb, NULL, 1, back), T3R_OK);
        assert_memory_equal(back, high_first, 2);
    }
}

TEST(every_level_is_packed_to_the_nearest)
{
    for (int level = 0; level < 256; level++) {
        const uint8_t rgb[] = {(uint8_t)level, (uint8_t)level, (uint8_t)level};
        const int five = rescaled(level, 255, 31), six = rescaled(level, 255, 63);
        uint8_t packed[2];
        assert_int_equal(t3r_pack_row(T3R_PACKED_RGB565, rgb, NULL, 1, packed), T3R_OK);
        assert_int_equal(packed[0] | packed[1] << 8, five << 11 | six << 5 | five);
    }
}

TEST(four_bytes_there_and_back)
{
    uint64_t seed = 1;
    for (uint32_t width = 1; width <= MOST_WIDTH; width++) {
        uint8_t *packed = random_bytes(4 * (size_t)width, &seed), *back = random_bytes(4 * (size_t)width, &seed);
        uint8_t *rgb = unit_array(3 * (size_t)width, 1);
        uint16_t *alpha = unit_array(width, sizeof *alpha);
        for (t3r_packing packing = T3R_PACKED_RGBA; packing <= T3R_PACKED_BGRA; packing++) {
            assert_int_equal(t3r_unpack_row(packing, packed, width, rgb), T3R_OK);
            for (uint32_t x = 0; x < width; x++) {
                const uint8_t *pixel = packed + 4 * x;
                const bool is_blue_first = packing == T3R_PACKED_BGRA;
                assert_int_equal(rgb[3 * x], pixel[is_blue_first ? 2 : 0]);
                assert_int_equal(rgb[3 * x + 1], pixel[1]);
                assert_int_equal(rgb[3 * x + 2], pixel[is_blue_first ? 0 : 2]);
                alpha[x] = (uint16_t)rescaled(pixel[3], 255, ALPHA_ONE);
            }
            assert_int_equal(t3r_pack_row(packing, rgb, alpha, width, back), T3R_OK);
            assert_memory_equal(back, packed, 4 * (size_t)width);
            assert_int_equal(t3r_pack_row(packing, rgb, NULL, width, back), T3R_OK);
            for (uint32_t x = 0; x < width; x++) {
                assert_memory_equal(back + 4 * x, packed + 4 * x, 3);
                assert_int_equal(back[4 * x + 3], 255);
            }
        }
        free(packed);
        free(back);
        free(rgb);
        free(alpha);
    }
}

TEST(every_alpha)
{
    static const uint8_t rgb[] = {1, 2, 3};
    for (uint32_t alpha = 0; alpha <= ALPHA_ONE; alpha++) {
        const uint16_t row[] = {(uint16_t)alpha};
        uint8_t rgba[4];
        assert_int_equal(t3r_pack_row(T3R_PACKED_RGBA, rgb, row, 1, rgba), T3R_OK);
        assert_int_equal(rgba[3], rescaled((int)alpha, ALPHA_ONE, 255));
        for (int back = 0; back < 256; back += 51) {
            uint8_t drawn[] = {0, 7, 200};
            const uint8_t background[] = {(uint8_t)back, 255, (uint8_t)(255 - back)};
            assert_int_equal(t3r_composite_row(drawn, row, 1, background), T3R_OK);
            const double behind = (double)(ALPHA_ONE - alpha) / ALPHA_ONE;
            assert_int_equal(drawn[0], floor(background[0] * behind + 0.5));
            assert_int_equal(drawn[1], fmin(255, floor(7 + 255 * behind + 0.5)));
            assert_int_equal(drawn[2], fmin(255, floor(200 + background[2] * behind + 0.5)));
        }
    }
}

/* ---- Bayer ---------------------------------------------------------------------------------------------------------
 */

/* Returns the colour that a pattern measures at a pixel: 0, 1 or 2. */
static int colour_at(t3r_bayer order, int x, int y)
{
    static const char patterns[T3R_BAYER_COUNT][5] = {
        [T3R_BAYER_RGGB] = "rggb", [T3R_BAYER_GRBG] = "grbg", [T3R_BAYER_GBRG] = "gbrg", [T3R_BAYER_BGGR] = "bggr"};
    const char letter = patterns[order][(y & 1) * 2 + (x & 1)];
    return letter == 'r' ? 0 : letter == 'g' ? 1 : 2;
}

static int mirrored(int at, int size)
{
    return at < 0 ? -at : at >= size ? 2 * size - 2 - at : at;
}

/* Returns the mean of the samples of a colour nearest to a pixel, in the mirrored picture. */
static int interpolated(const uint8_t *picture, t3r_bayer order, int width, int height, int x, int y, int colour)
{
    int sum = 0, count = 0;
    for (int reach = 0; reach <= 2 && count == 0; reach++) { /* itself, beside, at a corner */
        for (int v = y - 1; v <= y + 1; v++) {
            for (int u = x - 1; u <= x + 1; u++) {
                if (abs(u - x) + abs(v - y) == reach && colour_at(order, u & 1, v & 1) == colour) {
                    sum += picture[mirrored(v, height) * width + mirrored(u, width)];
                    count++;
                }
            }
        }
    }
    return (int)floor((double)sum / count + 0.5);
}

static void check_demosaic(t3r_bayer order, int width, int height, uint64_t *seed)
{
    uint8_t *picture = random_bytes((size_t)(width * height), seed), *rgb = unit_array((size_t)width * 3, 1);
    for (int y = 0; y < height; y++) {
        const uint8_t *row = picture + y * width;
        assert_int_equal(t3r_demosaic_row(order, (uint32_t)y, picture + mirrored(y - 1, height) * width, row,
                                          picture + mirrored(y + 1, height) * width, (uint32_t)width, rgb),
                         T3R_OK);
        for (int x = 0; x < width; x++) {
            for (int c = 0; c < 3; c++) {
                assert_int_equal(rgb[3 * x + c], interpolated(picture, order, width, height, x, y, c));
            }
        }
    }
    free(picture);
    free(rgb);
}

TEST(all_orders_of_bayer_at_all_edges)
{
    uint64_t seed = 2;
    for (t3r_bayer order = 0; order < T3R_BAYER_COUNT; order++) {
        for (int width = 2; width <= MOST_WIDTH; width++) {
            for (int height = 2; height <= MOST_HEIGHT; height++) {
                check_demosaic(order, width, height, &seed);
            }
        }
    }
}

TEST(a_uniform_colour_stays)
{
    static const uint8_t colour[] = {200, 100, 50};
    for (t3r_bayer order = 0; order < T3R_BAYER_COUNT; order++) {
        uint8_t rows[2][MOST_WIDTH], rgb[3 * MOST_WIDTH];
        for (int i = 0; i < 2 * MOST_WIDTH; i++) {
            rows[i / MOST_WIDTH][i % MOST_WIDTH] = colour[colour_at(order, i % MOST_WIDTH, i / MOST_WIDTH)];
        }
        for (uint32_t y = 0; y < 2; y++) {
            assert_int_equal(t3r_demosaic_row(order, y, rows[1 - y], rows[y], rows[1 - y], MOST_WIDTH, rgb), T3R_OK);
            for (int x = 0; x < MOST_WIDTH; x++) {
                assert_memory_equal(rgb + 3 * x, colour, 3);
            }
        }
    }
}

TEST(refused_rows_write_nothing)
{
    static const uint8_t untouched[] = {9, 9, 9, 9, 9, 9, 9, 9}, in[8] = {0};
    static const uint16_t alpha[2] = {0};
    uint8_t out[8];
    memset(out, 9, sizeof out);
    assert_int_equal(t3r_unpack_row(T3R_PACKING_COUNT, in, 1, out), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_unpack_row(T3R_PACKED_RGBA, NULL, 1, out), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_unpack_row(T3R_PACKED_RGBA, in, 1, NULL), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_unpack_row(T3R_PACKED_RGBA, in, 0, out), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_pack_row(T3R_PACKING_COUNT, in, alpha, 1, out), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_pack_row(T3R_PACKED_RGB565, NULL, alpha, 1, out), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_pack_row(T3R_PACKED_RGB565, in, alpha, 1, NULL), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_pack_row(T3R_PACKED_RGB565, in, alpha, 0, out), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_demosaic_row(T3R_BAYER_COUNT, 0, in, in, in, 2, out), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_demosaic_row(T3R_BAYER_RGGB, 0, NULL, in, in, 2, out), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_demosaic_row(T3R_BAYER_RGGB, 0, in, NULL, in, 2, out), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_demosaic_row(T3R_BAYER_RGGB, 0, in, in, NULL, 2, out), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_demosaic_row(T3R_BAYER_RGGB, 0, in, in, in, 2, NULL), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_demosaic_row(T3R_BAYER_RGGB, 0, in, in, in, 1, out), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_composite_row(NULL, alpha, 1, in), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_composite_row(out, NULL, 1, in), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_composite_row(out, alpha, 1, NULL), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_composite_row(out, alpha, 0, in), T3R_ERR_ARGUMENT);
    assert_memory_equal(out, untouched, sizeof out);
}
