/* SPDX-License-Identifier: Apache-2.0 */
/* Palettes: different rows stay separate while there is room; shared rows are the means of their members. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/fixed.h"
#include "scene/formats/sog/palette.h"
#include "test.h"

enum { COUNT = 3000, STRIDE = 48, WIDTH = PALETTE_WIDTH_MOST };

/* Makes rows of `sets` kinds with numbers in -most..most. */
static int16_t *make_rows(uint32_t sets, int most)
{
    int16_t *numbers = malloc(COUNT * STRIDE * sizeof *numbers);
    assert_non_null(numbers);
    for (uint32_t i = 0; i < COUNT * STRIDE; i++) {
        const uint32_t row = i / STRIDE % sets, column = i % STRIDE;
        const uint32_t noise = t3r_mix32(column < WIDTH ? row * STRIDE + column : i);
        numbers[i] = (int16_t)((int)(noise % (2 * (uint32_t)most + 1)) - most);
    }
    return numbers;
}

/* Returns the largest difference between a number and its palette's. */
static double farthest(const int16_t *numbers, const palette *made)
{
    double most = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        assert_true(made->labels[i] < made->rows);
        for (uint32_t k = 0; k < made->width; k++) {
            const double mean = made->means[(size_t)made->labels[i] * made->width + k];
            most = fmax(most, fabs(mean - numbers[i * STRIDE + k]));
        }
    }
    return most;
}

TEST(keeps_what_there_is_room_for)
{
    static const uint32_t sets[] = {1, 2, 100, 512};
    for (size_t i = 0; i < sizeof sets / sizeof sets[0]; i++) {
        static const int mosts[] = {1, 4000, 32767};
        for (size_t k = 0; k < sizeof mosts / sizeof mosts[0]; k++) {
            int16_t *numbers = make_rows(sets[i], mosts[k]);
            palette made;
            assert_int_equal(palette_make(numbers, COUNT, STRIDE, WIDTH, 512, &made), 0);
            assert_int_equal(made.rows, sets[i]);
            assert_true(farthest(numbers, &made) < 1e-9);
            palette_free(&made);
            free(numbers);
        }
    }
}

/* Returns the mean squared difference between numbers and their palette's. */
static double mean_square(const int16_t *numbers, const palette *made)
{
    double sum = 0;
    for (uint32_t i = 0; i < COUNT * made->width; i++) {
        const uint32_t row = i / made->width, column = i % made->width;
        const double lost =
            made->means[(size_t)made->labels[row] * made->width + column] - numbers[row * STRIDE + column];
        sum += lost * lost / COUNT / made->width;
    }
    return sum;
}

/* Without room for all rows: the palette is full, each entry is its members' mean, and errors are far smaller than
 * with one mean for all. */
TEST(shares_what_is_alike)
{
    int16_t *numbers = make_rows(40, 5000), *near = make_rows(COUNT, 100); /* forty crowds */
    for (uint32_t i = 0; i < COUNT * STRIDE; i++) {
        numbers[i] = (int16_t)(numbers[i] + near[i]);
    }
    free(near);
    palette made;
    assert_int_equal(palette_make(numbers, COUNT, STRIDE, WIDTH, 1, &made), 0);
    const double alone = mean_square(numbers, &made);
    palette_free(&made);
    assert_int_equal(palette_make(numbers, COUNT, STRIDE, WIDTH, 64, &made), 0);
    assert_int_equal(made.rows, 64);
    assert_true(alone > 5e6 && mean_square(numbers, &made) < 100 * 100);
    for (uint32_t row = 0; row < made.rows; row++) {
        double sum = 0, members = 0;
        for (uint32_t i = 0; i < COUNT; i++) {
            sum += made.labels[i] == row ? numbers[i * STRIDE] : 0;
            members += made.labels[i] == row;
        }
        assert_true(members > 0 && fabs(sum / members - made.means[(size_t)row * WIDTH]) < 1e-9);
    }
    palette_free(&made);
    free(numbers);
}

TEST(holds_its_ends)
{
    const int16_t ends[] = {INT16_MIN, INT16_MAX, INT16_MIN, 7};
    palette made;
    assert_int_equal(palette_make(ends, 4, 1, 1, 3, &made), 0);
    assert_true(made.rows == 3 && made.labels[0] == made.labels[2]);
    palette_free(&made);
    assert_int_equal(palette_make(ends, 4, 1, 1, 1, &made), 0);
    assert_true(made.rows == 1 && made.means[0] == (7 - 1 - 32768) / 4.0);
    palette_free(&made);
    assert_int_equal(palette_make(ends, 1, 1, 1, PALETTE_ROWS_MOST, &made), 0);
    assert_true(made.rows == 1 && made.means[0] == INT16_MIN && made.labels[0] == 0);
    palette_free(&made);
}
