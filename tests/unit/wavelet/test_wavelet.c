/* SPDX-License-Identifier: Apache-2.0 */
/* Wavelets: exact inversion, the 16-bit proof recomputed and attained, db2 against its filters, texture. */
#include "unit/unit.h"

#include "wavelet/wavelet.h"
#include "wavelet_planes.h"

enum { KINDS = T3R_WAVELET_COUNT, LEVELS = T3R_MAX_LEVELS };

typedef struct bench {
    uint32_t width, height;
    int16_t *plane, *copy, *work;
} bench;

static bench bench_new(uint32_t width, uint32_t height)
{
    bench b = {width, height, unit_array((size_t)width * height, 2), unit_array((size_t)width * height, 2),
               unit_array(T3R_WAVELET_ROW_BYTES(width), 1)};
    return b;
}

static void bench_free(bench b)
{
    free(b.plane);
    free(b.copy);
    free(b.work);
}

static void round_trip(bench b, uint32_t levels, t3r_wavelet kind)
{
    size_t bytes = (size_t)b.width * b.height * sizeof(int16_t);
    memcpy(b.plane, b.copy, bytes);
    wavelet_forward(b.plane, b.width, b.height, levels, kind);
    wavelet_inverse(b.plane, b.width, b.height, levels, kind);
    assert_memory_equal(b.plane, b.copy, bytes);
}

/* 0: luma noise, 1: black and white noise, 2: any 16 bits, 3: checkerboard, 4: white */
static void fill(bench b, uint64_t *seed, int pattern)
{
    for (size_t i = 0; i < (size_t)b.width * b.height; i++) {
        int64_t bit = pattern == 3 ? (int64_t)((i % b.width + i / b.width) & 1) : (int64_t)(unit_random(seed) & 1);
        b.copy[i] = (int16_t)(pattern == 0   ? unit_between(seed, -128, 127) * 16
                              : pattern == 2 ? unit_between(seed, INT16_MIN, INT16_MAX)
                              : pattern == 4 ? 127 * 16
                                             : bit * 255 * 16 - 2048);
    }
}

TEST(inverts_every_size)
{
    uint64_t seed = 1;
    for (uint32_t height = 1; height <= 70; height++) {
        for (uint32_t width = 1; width <= 70; width++) {
            bench b = bench_new(width, height);
            for (int kind = 0; kind < KINDS; kind++) {
                for (int pattern = 0; pattern < 3; pattern++) {
                    fill(b, &seed, pattern);
                    round_trip(b, 1 + (width + height + (uint32_t)pattern) % LEVELS, (t3r_wavelet)kind);
                }
            }
            bench_free(b);
        }
    }
}

TEST(inverts_large)
{
    uint64_t seed = 2;
    bench b = bench_new(1280, 720);
    for (int pattern = 0; pattern < 5; pattern++) {
        fill(b, &seed, pattern);
        for (int kind = 0; kind < KINDS; kind++) {
            for (uint32_t levels = 0; levels <= LEVELS; levels++) {
                round_trip(b, levels, (t3r_wavelet)kind);
            }
        }
    }
    bench_free(b);
}

/* ---- the lifting in real numbers, written for one line of samples -------------------------------------- */

/* In: n samples; out: the low half, then the high half. middle (may be NULL) gets db2's d1, padded with zeros. */
static void real_line(double *x, uint32_t n, t3r_wavelet kind, double *middle)
{
    double low[80] = {0}, high[80] = {0};
    uint32_t lows = (n + 1) / 2, highs = n / 2;
    const double root = sqrt(3);
    if (n < 2) {
        return;
    }
    for (uint32_t i = 0; i < n; i++) {
        (i % 2 == 0 ? low : high)[i / 2] = x[i];
    }
    if (kind == T3R_WAVELET_HAAR) {
        for (uint32_t i = 0; i < highs; i++) {
            high[i] -= low[i];
            low[i] += high[i] / 2;
        }
    } else if (kind == T3R_WAVELET_CDF53) {
        for (uint32_t i = 0; i < highs; i++) {
            high[i] -= (low[i] + low[i + 1 < lows ? i + 1 : i]) / 2;
        }
        for (uint32_t i = 0; i < lows; i++) {
            low[i] += (high[i > 0 ? i - 1 : 0] + high[i < highs ? i : highs - 1]) / 4;
        }
    } else if (n == 2) {
        double d1 = x[1] - root * x[0];
        low[0] = x[0] + (root - 1) / 2 * d1;
        high[0] = d1 + low[0];
        if (middle != NULL) {
            middle[0] = d1;
        }
    } else {
        uint32_t pairs = (n - 1) / 2;
        low[0] = x[0] - (2 - root) * x[1];
        for (uint32_t i = 1; i <= pairs; i++) {
            uint32_t next = i < pairs ? i + 1 : i;
            double d1 = x[2 * i] - root * x[2 * i - 1], d1_next = x[2 * next] - root * x[2 * next - 1];
            low[i] = x[2 * i - 1] + root / 4 * d1 - (2 - root) / 4 * d1_next;
            high[i - 1] = d1 + low[i - 1];
            if (middle != NULL) {
                middle[i] = d1;
            }
        }
        if (n % 2 == 0) {
            high[pairs] = x[n - 1] - 2 * x[n - 2] + x[n - 3];
        }
    }
    memcpy(x, low, lows * sizeof *x);
    memcpy(x + lows, high, highs * sizeof *x);
}

/* Computes weights[i][k]: contribution of sample k of a line of n to coefficient i after all levels (Mallat order);
 * likewise middle for the last level's d1. */
static void line_weights(double weights[80][80], double middle[80][80], uint32_t n, uint32_t levels, t3r_wavelet kind)
{
    for (uint32_t k = 0; k < n; k++) {
        double line[80] = {0}, d1[80] = {0};
        line[k] = 1;
        uint32_t length = n;
        for (uint32_t l = 0; l < levels; l++) {
            memset(d1, 0, sizeof d1);
            real_line(line, length, kind, d1);
            length = (length + 1) / 2;
        }
        for (uint32_t i = 0; i < n; i++) {
            weights[i][k] = line[i];
            if (middle != NULL) {
                middle[i][k] = d1[i];
            }
        }
    }
}

/* Finds the largest sums of absolute weights after exactly `level` levels, for any length: low, high, d1. */
static void worst_sums(uint32_t level, t3r_wavelet kind, double worst[3])
{
    static double weights[80][80], middle[80][80];
    memset(worst, 0, 3 * sizeof *worst);
    for (uint32_t n = 2; n < 80; n++) {
        uint32_t lows = n, before = n;
        for (uint32_t l = 0; l < level; l++) {
            before = lows;
            lows = (lows + 1) / 2;
        }
        if (before < 2) {
            continue;
        }
        line_weights(weights, middle, n, level, kind);
        for (uint32_t i = 0; i < before; i++) {
            double sum = 0, sum_middle = 0;
            for (uint32_t k = 0; k < n; k++) {
                sum += fabs(weights[i][k]);
                sum_middle += fabs(middle[i][k]);
            }
            worst[i >= lows] = fmax(worst[i >= lows], sum);
            worst[2] = fmax(worst[2], sum_middle);
        }
    }
}

/* Checks the table of wavelet_level.h, and that everything stored fits 16 bits. */
TEST(proof)
{
    const double table[KINDS][LEVELS][3] = {
        {{1.268, 4.000, 2.733},
         {1.500, 3.402, 2.929},
         {1.634, 3.131, 3.121},
         {1.732, 2.821, 3.212},
         {1.804, 2.769, 3.281}},
        {{1, 2}, {1, 2}, {1, 2}, {1, 2}, {1, 2}},
        {{1.500, 2.000}, {1.625, 2.500}, {1.688, 2.750}, {1.698, 2.805}, {1.707, 2.827}}};
    for (int kind = 0; kind < KINDS; kind++) {
        for (uint32_t level = 1; level <= LEVELS; level++) {
            double worst[3];
            worst_sums(level, (t3r_wavelet)kind, worst);
            for (int i = 0; i < 3; i++) {
                double stated = table[kind][level - 1][i];
                assert_true(worst[i] <= stated + 1e-6 && worst[i] > stated - 0.001);
            }
            double low = worst[0], high = worst[1], middle = worst[2];
            assert_true(high * high * 2040 + (level == 1 ? 8 : 100) < (level == 1 ? 32767 : 24000));
            assert_true(low * low * 2048 + 100 < 24000 && middle * low * 2048 + 100 < 24000);
            assert_true(middle * high * 2040 + 100 < 24000);
            /* texture: the finest sum in 15 bits, the coarse one below 2^31 with its gains */
            double sum = 2 * high * low * 2040, corner = high * high * 2040;
            assert_true(level > 1 || sum + 0.268 * corner + 100 < 32767);
            assert_true(level == 1 || 49662 * (sum + 200) + 13307 * (corner + 100) < 2147483647.0);
        }
    }
}

/* For a coefficient (i, j), the black and white image that drives it furthest: the integer transform follows the real
 * one to its extreme, so nothing has overflowed. */
TEST(attained)
{
    static double across[80][80], down[80][80];
    const uint32_t sizes[][2] = {{8, 8}, {9, 9}, {17, 33}, {33, 34}, {64, 65}, {70, 41}, {66, 50}, {37, 24}};
    double worst_error = 0, largest = 0;
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        uint32_t width = sizes[s][0], height = sizes[s][1];
        bench b = bench_new(width, height);
        double *real = unit_array((size_t)width * height, sizeof(double));
        for (int kind = 0; kind < KINDS; kind++) {
            for (uint32_t levels = 1; levels <= LEVELS; levels++) {
                line_weights(across, NULL, width, levels, (t3r_wavelet)kind);
                line_weights(down, NULL, height, levels, (t3r_wavelet)kind);
                for (uint32_t at = 0; at < width * height; at += 1 + at % 7 * (width / 8)) {
                    uint32_t i = at % width, j = at / width;
                    for (uint32_t k = 0; k < width * height; k++) {
                        int positive = (across[i][k % width] >= 0) == (down[j][k / width] >= 0);
                        b.plane[k] = positive ? 2032 : -2048;
                        real[k] = b.plane[k];
                    }
                    wavelet_forward(b.plane, width, height, levels, (t3r_wavelet)kind);
                    uint32_t w = width, h = height;
                    for (uint32_t l = 0; l < levels; l++) {
                        double line[80];
                        for (uint32_t y = 0; y < h; y++) {
                            real_line(real + (size_t)y * width, w, (t3r_wavelet)kind, NULL);
                        }
                        for (uint32_t x = 0; x < w; x++) {
                            for (uint32_t y = 0; y < h; y++) {
                                line[y] = real[y * width + x];
                            }
                            real_line(line, h, (t3r_wavelet)kind, NULL);
                            for (uint32_t y = 0; y < h; y++) {
                                real[y * width + x] = line[y];
                            }
                        }
                        w = (w + 1) / 2;
                        h = (h + 1) / 2;
                    }
                    for (uint32_t k = 0; k < width * height; k++) {
                        worst_error = fmax(worst_error, fabs(b.plane[k] - real[k]));
                        assert_true(levels > 1 || fabs(b.plane[k] - real[k]) < 8);
                        largest = fmax(largest, fabs((double)b.plane[k]));
                    }
                }
            }
        }
        free(real);
        bench_free(b);
    }
    print_message("largest coefficient %.0f, furthest from the real one %.2f\n", largest, worst_error);
    assert_true(largest > 32600 && worst_error < 100);
}

/* The low and high halves are db2's published filters, coefficient n over samples 2 n - 1 .. 2 n + 2, up to the stated
 * gains and the sign of the high half. The first and last ones follow the border's rules. */
TEST(daubechies)
{
    enum { N = 48, BORDER = 2 };
    const double root = sqrt(3), norm = 4 * sqrt(2);
    const double h[4] = {(1 + root) / norm, (3 + root) / norm, (3 - root) / norm, (1 - root) / norm};
    uint64_t seed = 9;
    int16_t line[N];
    double x[N];
    double worst = 0;
    for (int turn = 0; turn < 200; turn++) {
        for (int i = 0; i < N; i++) {
            line[i] = (int16_t)unit_between(&seed, -2048, 2032);
            x[i] = line[i];
        }
        wavelet_forward(line, turn % 2 == 0 ? N : 1, turn % 2 == 0 ? 1 : N, 1, T3R_WAVELET_DB2);
        for (int n = BORDER; n < N / 2 - BORDER; n++) {
            double low = 0, high = 0;
            for (int k = 0; k < 4; k++) {
                double sample = x[2 * n - 1 + k];
                low += h[k] * sample;
                high += (k % 2 == 0 ? 1 : -1) * h[3 - k] * sample;
            }
            worst = fmax(worst, fabs((root + 1) / sqrt(2) * line[n] - low));
            worst = fmax(worst, fabs((root - 1) / sqrt(2) * line[N / 2 + n] + high));
        }
    }
    assert_true(worst < 3);
}

/* ---- texture ------------------------------------------------------------------------------------------ */

typedef struct image {
    uint32_t width, height;
    uint8_t *colour[3];
    uint16_t *texture;
    bench b;
} image;

static image image_new(uint32_t width, uint32_t height)
{
    image x = {width, height, {0}, unit_array((size_t)width * height, 2), bench_new(width, height)};
    for (int c = 0; c < 3; c++) {
        x.colour[c] = unit_array(width, height);
    }
    return x;
}

static void image_free(image x)
{
    for (int c = 0; c < 3; c++) {
        free(x.colour[c]);
    }
    free(x.texture);
    bench_free(x.b);
}

static double magnitude(const int16_t *plane, uint32_t width, uint32_t x, uint32_t y, int there)
{
    return there ? fabs((double)plane[y * width + x]) : 0;
}

/* Computes each pixel's texture from the coefficients in Mallat's layout, with real gains. */
TEST(texture_by_definition)
{
    uint64_t seed = 17;
    const uint32_t sizes[][2] = {{64, 64}, {33, 47}, {70, 9}, {8, 8}, {1, 13}, {12, 1}, {31, 32}};
    const double root = sqrt(3);
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        uint32_t width = sizes[s][0], height = sizes[s][1];
        image x = image_new(width, height);
        for (int turn = 0; turn < 2; turn++) {
            for (uint32_t i = 0; i < width * height; i++) {
                for (int c = 0; c < 3; c++) {
                    x.colour[c][i] =
                        (uint8_t)(turn == 0 ? unit_random(&seed) : (uint32_t)c * 20 + i % width + i / width);
                }
                int luma = (77 * x.colour[0][i] + 150 * x.colour[1][i] + 29 * x.colour[2][i] + 128) / 256;
                x.b.copy[i] = (int16_t)((luma - 128) * 16);
            }
            for (int kind = 0; kind < KINDS; kind++) {
                for (uint32_t levels = 1; levels <= LEVELS; levels++) {
                    t3r_wavelet_texture(&t3r_kernels_c, (const uint8_t *const *)x.colour, width, height, levels,
                                        (t3r_wavelet)kind, x.texture, x.b.plane, x.b.work);
                    memcpy(x.b.plane, x.b.copy, (size_t)width * height * 2);
                    wavelet_forward(x.b.plane, width, height, levels, (t3r_wavelet)kind);
                    double up = kind == T3R_WAVELET_DB2 ? 2 + root : 2;
                    for (uint32_t at = 0; at < width * height; at++) {
                        double sum = 0;
                        uint32_t w = width, h = height;
                        for (uint32_t l = 1; l <= levels; l++) {
                            uint32_t lows_x = (w + 1) / 2, lows_y = (h + 1) / 2;
                            uint32_t px = (at % width) >> l, py = (at / width) >> l;
                            int in_x = px < w / 2, in_y = py < h / 2;
                            double one = magnitude(x.b.plane, width, lows_x + px, py, in_x) +
                                         magnitude(x.b.plane, width, px, lows_y + py, in_y) +
                                         magnitude(x.b.plane, width, lows_x + px, lows_y + py, in_x && in_y) / up;
                            sum += pow(up, l - 1) * one;
                            w = lows_x;
                            h = lows_y;
                        }
                        sum = fmin(sum, 65535);
                        assert_true(fabs(x.texture[at] - sum) <= 0.5 * levels + sum * 0.0006 + 1e-6);
                    }
                }
            }
        }
        image_free(x);
    }
}

/* A blank wall has no texture, apart from rounding. */
TEST(texture_of_nothing)
{
    image x = image_new(67, 45);
    uint32_t worst = 0;
    for (int grey = 0; grey < 256; grey++) {
        for (int c = 0; c < 3; c++) {
            memset(x.colour[c], grey, 67 * 45);
        }
        for (int kind = 0; kind < KINDS; kind++) {
            t3r_wavelet_texture(&t3r_kernels_c, (const uint8_t *const *)x.colour, 67, 45, 2, (t3r_wavelet)kind,
                                x.texture, x.b.plane, x.b.work);
            for (int i = 0; i < 67 * 45; i++) {
                worst = x.texture[i] > worst ? (uint32_t)x.texture[i] : worst;
                assert_true(kind == T3R_WAVELET_DB2 || x.texture[i] == 0);
            }
        }
    }
    print_message("texture of a constant: at most %u / 16\n", worst);
    assert_true(worst <= 16);
    image_free(x);
}

/* The image that drives a coefficient of level 5 furthest exceeds Q4 in 16 bits: its pixels saturate. */
TEST(texture_saturates)
{
    static double weights[80][80];
    image x = image_new(64, 64);
    line_weights(weights, NULL, 64, 5, T3R_WAVELET_DB2);
    for (int at = 0; at < 64 * 64; at++) {
        /* of the two lows and two highs of level 5: high 0 in x, low 1 in y */
        int positive = (weights[2][at % 64] >= 0) == (weights[1][at / 64] >= 0);
        for (int c = 0; c < 3; c++) {
            x.colour[c][at] = positive ? 255 : 0;
        }
    }
    t3r_wavelet_texture(&t3r_kernels_c, (const uint8_t *const *)x.colour, 64, 64, 5, T3R_WAVELET_DB2, x.texture,
                        x.b.plane, x.b.work);
    uint32_t full = 0;
    for (int i = 0; i < 64 * 64; i++) {
        full += x.texture[i] == 65535 ? 1 : 0;
    }
    assert_true(full >= 32 * 32);
    assert_int_equal(x.texture[40 * 64 + 8], 65535);
    t3r_wavelet_texture(&t3r_kernels_c, (const uint8_t *const *)x.colour, 64, 64, 0, T3R_WAVELET_DB2, x.texture,
                        x.b.plane, x.b.work);
    assert_int_equal(x.texture[33 * 64 + 31], 0);
    image_free(x);
}

/* A coefficient of the coarsest level without a neighbour to the side is clamped to 16 bits, like all others. */
TEST(held_at_odd_sides)
{
    enum { WIDTH = 16, HEIGHT = 64, STRIPE = 16 }; /* one sample by four at level 5 */
    image x = image_new(WIDTH, HEIGHT);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        for (int c = 0; c < 3; c++) {
            x.colour[c][i] = i / WIDTH / STRIPE % 2 == 0 ? 0 : 255;
        }
    }
    const uint8_t *const colour[3] = {x.colour[0], x.colour[1], x.colour[2]};
    t3r_wavelet_texture(&t3r_kernels_c, colour, WIDTH, HEIGHT, LEVELS, T3R_WAVELET_DB2, x.texture, x.b.plane, x.b.work);
    for (int i = HEIGHT / 2 * WIDTH; i < HEIGHT * WIDTH; i++) { /* 72,165 from that level alone */
        assert_int_equal(x.texture[i], UINT16_MAX);
    }
    image_free(x);
}
