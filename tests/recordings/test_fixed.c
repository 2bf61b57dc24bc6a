/* SPDX-License-Identifier: Apache-2.0 */
/* platform/messages/fixed_double.c and platform/host/fixed_text.c against exact cases. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/fixed_text.h"
#include "messages/fixed_double.h"
#include "test.h"

static uint32_t float_bits(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static void check(double value, uint32_t fraction_bits, int64_t expected)
{
    int64_t fixed = 77;
    assert_int_equal(t3r_fixed_from_double(t3r_double_bits(value), fraction_bits, &fixed), 0);
    assert_int_equal(fixed, expected);
}

static void refuse(double value, uint32_t fraction_bits)
{
    int64_t fixed = 77;
    assert_int_equal(t3r_fixed_from_double(t3r_double_bits(value), fraction_bits, &fixed), -1);
    assert_int_equal(fixed, 77);
}

TEST(rounds_halves_to_even)
{
    static const struct {
        double value;
        int64_t rounded;
    } cases[] = {{0.5, 0},  {1.5, 2},  {2.5, 2},    {3.5, 4}, {-0.5, 0}, {-1.5, -2}, {-2.5, -2},
                 {0.25, 0}, {0.75, 1}, {-0.75, -1}, {0.0, 0}, {-0.0, 0}, {1.0, 1},   {-1.0, -1}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        check(cases[i].value, 0, cases[i].rounded);
        check(cases[i].value / 65536, 16, cases[i].rounded);
    }
    check(nextafter(0.5, 1), 0, 1);
    check(nextafter(0.5, 0), 0, 0);
    check(nextafter(2.5, 3), 0, 3);
    check(0x1.8p-41, 40, 1); /* 0.75 steps */
    check(0x1p-41, 40, 0);   /* half a step, to even */
    check(0x1.8p-40, 40, 2); /* one and a half */
    check(0.001, 40, 1099511628);
    check(4503599627370496.5, 0, 4503599627370496);
    check(4503599627370497.5, 0, 4503599627370498);
}

TEST(holds_the_range)
{
    check(0x1p62, 0, INT64_C(1) << 62);
    check(0x1.fffffffffffffp62, 0, INT64_C(0x7ffffffffffffc00));
    check(-0x1.fffffffffffffp62, 0, -INT64_C(0x7ffffffffffffc00));
    refuse(0x1p63, 0);
    refuse(-0x1p63, 0);
    refuse(0x1p31, 32);
    check(0x1.fffffffffffffp30, 32, INT64_C(0x7ffffffffffffc00));
    refuse(1e300, 0);
    refuse(INFINITY, 16);
    refuse(-INFINITY, 16);
    refuse(NAN, 16);
    refuse(-NAN, 0);
    check(5e-324, 62, 0); /* the smallest subnormal */
    check(2.2250738585072009e-308, 40, 0);
    check(-5e-324, 40, 0);
    check(0x1p-62, 62, 1);
    check(-0x1p-62, 62, -1);
}

TEST(agrees_with_libm)
{
    uint64_t seed = 1;
    for (uint32_t i = 0; i < 200000; i++) {
        seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        uint32_t fraction_bits = (uint32_t)(seed >> 40) % 41;
        double value = ldexp((double)(int64_t)seed, -(int)(40 + (seed >> 20) % 40));
        double scaled = ldexp(value, (int)fraction_bits);
        if (fabs(scaled) < 0x1p63) {
            check(value, fraction_bits, (int64_t)nearbyint(scaled)); /* the default mode is half-even */
        }
    }
}

TEST(reads_floats)
{
    int64_t fixed = 0;
    static const float values[] = {0.0f, -0.0f, 1.5f, -2.25f, 1e-45f, 1.17549421e-38f, 65504.0f, 0.1f, 3.5e-13f};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        assert_int_equal(t3r_fixed_from_float(float_bits(values[i]), 40, &fixed), 0);
        assert_int_equal(fixed, (int64_t)nearbyint(ldexp((double)values[i], 40)));
    }
    assert_int_equal(t3r_fixed_from_float(float_bits(NAN), 40, &fixed), -1);
    assert_int_equal(t3r_fixed_from_float(float_bits(INFINITY), 40, &fixed), -1);
    assert_int_equal(t3r_fixed_from_float(float_bits(8388608.0f), 40, &fixed), -1);
}

TEST(writes_short_decimals)
{
    static const struct {
        const char *text;
        uint64_t value_q40;
    } cases[] = {{"0.001", 1099511628},
                 {"1", UINT64_C(1) << 40},
                 {"0", 0},
                 {"0.5", UINT64_C(1) << 39},
                 {"0.0002", 219902326},
                 {"65535", UINT64_C(65535) << 40},
                 {"0.000000000001", 1},
                 {"16777215", UINT64_C(16777215) << 40}};
    char text[T3R_Q40_TEXT_BYTES];
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        uint64_t value = 9;
        t3r_q40_to_text(cases[i].value_q40, text);
        assert_string_equal(text, cases[i].text);
        assert_int_equal(t3r_q40_from_text(t3r_text_of(cases[i].text), &value), 0);
        assert_int_equal(value, cases[i].value_q40);
    }
    uint64_t seed = 1;
    for (uint32_t i = 0; i < 20000; i++) {
        seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        uint64_t value = seed >> (seed >> 58), back = 0;
        t3r_q40_to_text(value, text);
        assert_int_equal(t3r_q40_from_text(t3r_text_of(text), &back), 0);
        assert_int_equal(back, value);
    }
    t3r_q40_to_text(UINT64_MAX, text);
    assert_string_equal(text, "16777215.999999999999");
}

TEST(refuses_other_text)
{
    static const char *const texts[] = {"",
                                        ".",
                                        "1.",
                                        ".5",
                                        "-1",
                                        "1e-3",
                                        "0x1",
                                        " 1",
                                        "1 ",
                                        "1.0.0",
                                        "nan",
                                        "1,5",
                                        "16777216",
                                        "99999999999999999999",
                                        "0.1234567890123456789"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        uint64_t value = 5;
        assert_int_equal(t3r_q40_from_text(t3r_text_of(texts[i]), &value), -1);
        assert_int_equal(value, 5);
    }
}
