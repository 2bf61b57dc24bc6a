/* SPDX-License-Identifier: Apache-2.0 */
/* Fixed-point functions over their domain, against double. */
#include "unit/unit.h"

#include "core/divisor.h"
#include "core/fixed.h"
#include "kernels/wavelet_rows.h"

TEST(square_root)
{
    uint64_t seed = 1;
    for (uint64_t x = 0; x < 70000; x++) {
        uint64_t root = t3r_isqrt64(x);
        assert_true(root * root <= x && (root + 1) * (root + 1) > x);
    }
    for (int i = 0; i < 200000; i++) {
        uint64_t root = unit_random(&seed) >> (32 + i % 31);
        assert_int_equal(t3r_isqrt64(root * root), root);
        if (root > 0) {
            assert_int_equal(t3r_isqrt64(root * root - 1), root - 1);
            assert_int_equal(t3r_isqrt64(root * root + 2 * root), root);
        }
    }
    assert_int_equal(t3r_isqrt64(UINT64_MAX), UINT32_MAX);
}

TEST(logarithm)
{
    const double bound = 4.0; /* 2^-14 in Q16 */
    double worst = 0;
    int32_t before = -1;
    for (uint32_t x = 1; x != 0;) {
        int32_t got = t3r_log2_q16(x);
        worst = fmax(worst, fabs(got - log2(x) * 65536));
        assert_true(got >= before);
        before = got;
        uint32_t next = x + (x < (1u << 20) ? 1 : 4099);
        x = next > x ? next : 0;
    }
    worst = fmax(worst, fabs(t3r_log2_q16(UINT32_MAX) - log2(UINT32_MAX) * 65536));
    assert_true(worst < bound);
    for (uint32_t i = 0; i < 32; i++) {
        assert_int_equal(t3r_log2_q16(1u << i), i << 16);
    }
}

TEST(power)
{
    double worst = 0;
    uint32_t before = 0;
    for (int32_t x = -16 * 65536; x < 15 * 65536; x++) {
        uint32_t got = t3r_exp2_q16(x);
        double exact = exp2(x / 65536.0) * 65536;
        worst = fmax(worst, (fabs(got - exact) - 0.5) / exact);
        assert_true(got >= before);
        before = got;
    }
    assert_true(worst < 1.0 / 16384);
    assert_int_equal(t3r_exp2_q16(0), 65536);
    assert_int_equal(t3r_exp2_q16(-16 * 65536), 1);
    assert_int_equal(t3r_exp2_q16(14 * 65536), 1u << 30);
}

TEST(division)
{
    for (int64_t d = 1; d < 40; d++) {
        for (int64_t n = -300; n <= 300; n++) {
            const int64_t exact = (int64_t)floor((2.0 * (double)n + (double)d) / (2.0 * (double)d));
            assert_int_equal(t3r_round_div64(n, d), exact);
            assert_int_equal(t3r_round_div32((int32_t)n, (int32_t)d), exact);
        }
    }
    const int64_t most = (INT64_C(1) << 61) - 1;
    assert_int_equal(t3r_round_div64(most, 1), most);
    assert_int_equal(t3r_round_div64(-most, 1), -most);
    assert_int_equal(t3r_round_div64(most, most), 1);
    assert_int_equal(t3r_round_div64(-most, most), -1);
    const int32_t most_32 = (1 << 29) - 1;
    for (int32_t d = 1; d <= 2; d++) {
        assert_int_equal(t3r_round_div32(most_32, d), d == 1 ? most_32 : 1 << 28);
        assert_int_equal(t3r_round_div32(-most_32, d), d == 1 ? -most_32 : 1 - (1 << 28));
    }
    assert_int_equal(t3r_round_div32(most_32, most_32), 1);
    assert_int_equal(t3r_round_div32(-most_32, most_32), -1);
}

TEST(shifts)
{
    for (int32_t x = -4100; x <= 4100; x++) {
        for (uint32_t shift = 0; shift < 12; shift++) {
            int64_t exact = (int64_t)floor(ldexp(x, -(int)shift) + 0.5);
            assert_int_equal(t3r_round_shift64(x, shift), exact);
            assert_int_equal(t3r_round_shift32(x, shift), exact);
            assert_int_equal(t3r_scale64(x, -(int32_t)shift), exact);
            assert_int_equal(t3r_scale32(x, -(int32_t)shift), exact);
        }
    }
    assert_int_equal(t3r_scale64(-5, 3), -40);
    assert_int_equal(t3r_scale64(INT64_C(1) << 61, -63), 0);
    for (uint32_t i = 0; i < 64; i++) {
        assert_int_equal(t3r_msb64(UINT64_C(1) << i), i);
        assert_int_equal(t3r_msb64(UINT64_MAX >> (63 - i)), i);
    }
}

/* 64 bits: halves and their neighbours, up to the largest value that a shift allows. */
TEST(wide_shifts)
{
    for (uint32_t shift = 1; shift <= 62; shift++) {
        const int64_t half = INT64_C(1) << (shift - 1), most = (INT64_MAX - half) >> shift;
        for (int64_t whole = most; whole >= -most; whole = whole > 0 ? whole / 3 - 1 : whole * 3 - 1) {
            const int64_t x = whole * 2 * half;
            assert_int_equal(t3r_round_shift64(x, shift), whole);
            assert_int_equal(t3r_round_shift64(x + half - 1, shift), whole);
            assert_int_equal(t3r_round_shift64(x - half, shift), whole);
            assert_int_equal(t3r_round_shift64(x - half - 1, shift), whole - 1);
            assert_int_equal(t3r_scale64(x - half - 1, -(int32_t)shift), whole - 1);
            assert_int_equal(t3r_scale64(whole, (int32_t)shift), x);
        }
    }
    assert_int_equal(t3r_scale64(7, 0), 7);
    for (int32_t shift = 63; shift <= 66; shift++) {
        assert_int_equal(t3r_scale64(INT64_C(1) << 62, -shift), 0);
        assert_int_equal(t3r_scale64(INT64_MIN, -shift), 0);
    }
    assert_int_equal(t3r_scale64(INT64_C(1) << 61, -62), 1);
}

/* 32 bits: at the limits of numbers and shifts. */
TEST(shifts_of_extremes)
{
    const int32_t edges[] = {INT32_MIN, INT32_MIN + 1, -1, 0, 1, INT32_MAX - 1, INT32_MAX};
    for (size_t i = 0; i < sizeof edges / sizeof edges[0]; i++) {
        for (int32_t shift = 1; shift <= 62; shift++) {
            assert_int_equal(t3r_scale32(edges[i], -shift), t3r_round_shift64(edges[i], (uint32_t)shift));
        }
        for (int32_t shift = 0; shift <= 62; shift++) {
            const uint64_t exact = (uint64_t)(int64_t)edges[i] << shift;
            assert_int_equal(t3r_scale32(edges[i], shift), (int32_t)(uint32_t)exact);
        }
    }
}

TEST(sizes_and_clamps)
{
    for (int32_t x = -20; x <= 20; x++) {
        assert_int_equal(t3r_abs32(x), abs(x));
        assert_int_equal(t3r_abs64(x), abs(x));
        for (int32_t low = -3; low <= 3; low++) {
            for (int32_t high = low; high <= 3; high++) {
                const int32_t held = T3R_MAX(low, T3R_MIN(x, high));
                assert_int_equal(t3r_clamp32(x, low, high), held);
                assert_int_equal(t3r_clamp64(x, low, high), held);
            }
        }
    }
    assert_int_equal(t3r_abs32(-INT32_MAX), INT32_MAX);
    assert_int_equal(t3r_abs64(-INT64_MAX), INT64_MAX);
    assert_int_equal(t3r_clamp64(INT64_MIN, INT32_MIN, INT32_MAX), INT32_MIN);
    assert_int_equal(t3r_clamp64(INT64_MAX, INT32_MIN, INT32_MAX), INT32_MAX);
}

/* Compares with another implementation of the mixing. */
TEST(mixing)
{
    static const uint32_t mixed[][2] = {{0, 0},
                                        {1, 0x688990c0},
                                        {2, 0xd1132181},
                                        {3, 0x53f1e9dd},
                                        {1u << 16, 0xdcafae10},
                                        {1u << 31, 0xcc4b4124},
                                        {UINT32_MAX, 0x6768824a},
                                        {0x12345678, 0xf5e71c96}};
    for (size_t i = 0; i < sizeof mixed / sizeof *mixed; i++) {
        assert_int_equal(t3r_mix32(mixed[i][0]), mixed[i][1]);
    }
}

/* The 16-bit form of the product equals the rounded product, bit for bit, for each constant and every sample. */
TEST(small_product)
{
    const int16_t constants[] = {0, 1, T3R_DB2_PREDICT_Q15, T3R_DB2_UPDATE_Q15, T3R_DB2_UPDATE_NEXT_Q15, 16383};
    for (size_t c = 0; c < sizeof constants / sizeof constants[0]; c++) {
        for (int32_t a = INT16_MIN; a <= INT16_MAX; a++) {
            assert_int_equal(t3r_mulr_q15_small((int16_t)a, constants[c]), t3r_mulr_q15((int16_t)a, constants[c]));
        }
    }
}

/* Compares with division, for every sign and size, around all boundaries. */
TEST(divisor)
{
    uint64_t seed = 5;
    for (int turn = 0; turn < 200000; turn++) {
        const uint32_t most = UINT32_C(1) << unit_between(&seed, 0, 30);
        const uint32_t d = turn % 4 == 0 ? most : (uint32_t)unit_between(&seed, 1, most);
        const uint32_t limit = turn % 2 == 0 ? 4 : 16;
        const t3r_divisor by = t3r_divisor_of(d);
        assert_true(by.reciprocal >> 31 == 1); /* the most accurate one */
        const int64_t largest = T3R_MIN((int64_t)limit * d + 2, UINT32_MAX);
        const int64_t k = unit_between(&seed, 0, (int64_t)limit << 25); /* half steps */
        const int64_t x = turn % 3 == 0 ? unit_between(&seed, -largest, largest)
                                        : T3R_MIN(largest, ((k * d) >> 25) + unit_between(&seed, 0, 1));
        for (int sign = -1; sign <= 1; sign += 2) {
            const int64_t held = (int64_t)limit << 24;
            const int64_t want = t3r_clamp64(t3r_round_div64(sign * x * (1 << 24), d), -held, held);
            assert_int_equal(t3r_divide_q24(&by, sign * x, limit), want);
        }
    }
}
