/* SPDX-License-Identifier: Apache-2.0 */
/* t3r_harmonics_colour() against float64, in all directions and at the ends of its ranges. */
#include <math.h>
#include <string.h>

#include "core/fixed.h"
#include "test.h"
#include "trim3r.h"

static uint32_t seed;

static int32_t noise(int32_t most)
{
    seed = t3r_mix32(seed + 0x9e3779b9u);
    return (int32_t)(seed % (2 * (uint32_t)most + 1)) - most;
}

/* Returns the associated Legendre function without the Condon-Shortley sign, by its recurrences. */
static double legendre(int l, int m, double x)
{
    double before = 0, now = 1;
    for (int i = 1; i <= m; i++) {
        now *= (2 * i - 1) * sqrt(1 - x * x);
    }
    for (int i = m + 1; i <= l; i++) {
        const double next = ((2 * i - 1) * x * now - (i + m - 1) * before) / (i - m);
        before = now;
        now = next;
    }
    return now;
}

/* Returns the real harmonic of degree l and order m, from its definition in angles. */
static double harmonic(int l, int m, const double d[3])
{
    const int order = m < 0 ? -m : m;
    const double angle = atan2(d[1], d[0]);
    double ratio = 1; /* (l - order)! / (l + order)! */
    for (int i = l - order + 1; i <= l + order; i++) {
        ratio /= i;
    }
    const double size = sqrt((2 * l + 1) / (4 * M_PI) * ratio) * legendre(l, order, d[2]);
    const double sign = order % 2 == 1 ? -1 : 1; /* the sign used by 3D Gaussian Splatting */
    return m == 0 ? size : sign * M_SQRT2 * size * (m > 0 ? cos(order * angle) : sin(order * angle));
}

static double expected(const int16_t *coefficients, uint32_t degree, const int32_t direction[3], int channel)
{
    const double length = sqrt((double)direction[0] * direction[0] + (double)direction[1] * direction[1] +
                               (double)direction[2] * direction[2]);
    const double d[3] = {direction[0] / length, direction[1] / length, direction[2] / length};
    double sum = 0.5;
    for (int l = 0, i = 0; l <= (int)degree; l++) {
        for (int m = -l; m <= l; m++, i++) {
            sum += coefficients[3 * i + channel] / 4096.0 * harmonic(l, m, d);
        }
    }
    return fmin(fmax(sum * 32640, 0), 32640);
}

static void check(const int16_t *coefficients, uint32_t degree, const int32_t direction[3])
{
    uint16_t colour[3];
    assert_int_equal(t3r_harmonics_colour(coefficients, degree, direction, colour), T3R_OK);
    for (int channel = 0; channel < 3; channel++) {
        const double want = expected(coefficients, degree, direction, channel);
        if (fabs(colour[channel] - want) > 1) {
            fail_msg("degree %u, direction %d %d %d: %d is not %f", degree, direction[0], direction[1], direction[2],
                     colour[channel], want);
        }
    }
}

TEST(agrees_with_float64)
{
    for (int round = 0; round < 20000; round++) {
        int16_t coefficients[3 * T3R_HARMONICS_MOST];
        const int32_t most = round % 2 == 0 ? 2000 : 300;
        for (int i = 0; i < 3 * (int)T3R_HARMONICS_MOST; i++) {
            coefficients[i] = (int16_t)noise(most);
        }
        /* every length from 1 to the longest */
        const int32_t reach = (int32_t)((INT64_C(1) << (1 + round % 31)) - 1);
        int32_t direction[3] = {noise(reach / 2) * 2, noise(reach / 2) * 2, noise(reach / 2) * 2 + 1};
        check(coefficients, (uint32_t)round % 4, direction);
    }
}

/* Sets one coefficient at a time, which shows that no two are swapped. */
TEST(has_the_order_of_the_files)
{
    static const int32_t directions[][3] = {{3, 5, 7}, {-2, 9, 4}, {1, -1, 1}, {6, 2, -8},
                                            {0, 0, 5}, {0, -4, 0}, {7, 0, 0}};
    for (uint32_t i = 0; i < T3R_HARMONICS_MOST; i++) {
        for (size_t k = 0; k < sizeof directions / sizeof directions[0]; k++) {
            int16_t coefficients[3 * T3R_HARMONICS_MOST] = {0};
            coefficients[3 * i] = 1400;
            coefficients[3 * i + 1] = -1400;
            check(coefficients, 3, directions[k]);
        }
    }
}

TEST(holds_its_ends)
{
    const int32_t ends[] = {INT32_MIN, INT32_MAX, 0};
    int16_t coefficients[3 * T3R_HARMONICS_MOST];
    for (int value = INT16_MIN; value <= INT16_MAX; value += INT16_MAX - INT16_MIN) {
        for (int i = 0; i < 3 * (int)T3R_HARMONICS_MOST; i++) {
            coefficients[i] = (int16_t)value;
        }
        for (int i = 0; i < 26; i++) {
            const int32_t direction[3] = {ends[i % 3], ends[i / 3 % 3], ends[i / 9]};
            check(coefficients, 3, direction);
        }
    }
    /* no length: degree 0 */
    uint16_t colour[3];
    memset(coefficients, 0, sizeof coefficients);
    coefficients[0] = 4096;
    coefficients[3] = coefficients[6] = 32767;
    assert_int_equal(t3r_harmonics_colour(coefficients, 3, (const int32_t[3]){0}, colour), T3R_OK);
    assert_int_equal(colour[0], lrint(32640 * (0.5 + 0.28209479177387814)));
    assert_int_equal(colour[1], 16320);
    assert_int_equal(t3r_harmonics_colour(coefficients, 4, (const int32_t[3]){1}, colour), T3R_ERR_ARGUMENT);
}
