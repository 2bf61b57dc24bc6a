/* SPDX-License-Identifier: Apache-2.0 */
/* Functions by table or polynomial over their whole domain: their errors, and a checksum that is equal for every
 * compiler and processor. A domain of 2^32 and more is sampled densely where its shape changes, and at all its edges.
 */
#include "unit/unit.h"

#include "core/alpha.h"
#include "core/divisor.h"
#include "core/hash.h"
#include "core/logarithm.h"
#include "kernels/blend.h"
#include "kernels/project_parts.h"

#define STRIDE UINT32_C(65521) /* a prime */
#define LOGARITHM_WORST 4.0    /* 2^-14, in Q16 */
#define ALPHA_WORST 23.0       /* in Q16: 18 from the polynomial, 4 from q rounded to 16 steps, 1 from the product */
#define LOGARITHM_HASH UINT64_C(0x0b1f1873045bf8e9)
#define POWER_HASH UINT64_C(0xcd115a77e95a1086)
#define POWER_IN_THOUSANDS_HASH UINT64_C(0xbac39740316426c5)
#define RECIPROCAL_HASH UINT64_C(0x761bfbd285ab9e7a)
#define ALPHA_HASH UINT64_C(0x6ac1186f92b20089)
#define QUOTIENT_HASH UINT64_C(0x5fa4a3c85b29bd1e)
#define PRODUCTS_HASH UINT64_C(0xd7300b7710acd701)

/* Every mantissa, and for some every exponent: the table uses 23 bits of the mantissa, and the exponent is added. */
TEST(logarithm)
{
    double worst = 0;
    uint64_t hash = T3R_HASH_START;
    for (uint32_t mantissa = UINT32_C(1) << 23; mantissa < UINT32_C(1) << 24; mantissa++) {
        const int32_t got = t3r_log2_q16(mantissa);
        worst = fmax(worst, fabs(got - log2(mantissa) * 65536));
        hash = t3r_hash_u8(hash, (uint8_t)got);
    }
    for (uint32_t x = UINT32_C(1) << 23; x < UINT32_C(1) << 24; x += STRIDE) {
        for (uint32_t shift = 0; shift < 8; shift++) {
            const uint32_t unseen = (UINT32_C(1) << shift) - 1;
            const int32_t want = t3r_log2_q16(x) + ((int32_t)shift << 16);
            assert_int_equal(t3r_log2_q16(x << shift), want);
            assert_int_equal(t3r_log2_q16((x << shift) + unseen), want);
        }
    }
    for (uint32_t x = 1; x < UINT32_C(1) << 16; x++) {
        const int32_t got = t3r_log2_q16(x);
        worst = fmax(worst, fabs(got - log2(x) * 65536));
        assert_int_equal(t3r_log2_wide_q16(x), got);
        for (uint32_t shift = 32; shift + 16 < 64; shift++) {
            assert_int_equal(t3r_log2_wide_q16((uint64_t)x << shift), got + ((int32_t)shift << 16));
        }
    }
    assert_int_equal(t3r_log2_wide_q16(UINT64_MAX), 64 << 16);
    assert_true(worst < LOGARITHM_WORST);
    assert_int_equal(hash, LOGARITHM_HASH);
}

TEST(power)
{
    double worst = 0;
    uint64_t hash = T3R_HASH_START;
    for (int32_t x = -16 * 65536; x <= 15 * 65536; x++) {
        const uint32_t got = t3r_exp2_q16(x);
        const double exact = exp2(x / 65536.0) * 65536;
        worst = fmax(worst, (fabs(got - exact) - 0.5) / exact);
        hash = t3r_hash_u16(hash, (uint16_t)got);
    }
    assert_true(worst < 1.0 / 16384);
    assert_int_equal(hash, POWER_HASH);
}

TEST(power_in_thousands)
{
    double worst = 0;
    uint64_t hash = T3R_HASH_START;
    for (int32_t x = -16 * 1024; x <= 0; x++) {
        const uint32_t got = t3r_exp2_of_q10(x);
        const double exact = exp2(x / 1024.0) * 65536;
        worst = fmax(worst, (fabs(got - exact) - 0.5) / exact);
        hash = t3r_hash_u32(hash, got);
        assert_int_equal(got, t3r_exp2_q16(x * 64));
    }
    assert_true(worst < 1.0 / 16384);
    assert_int_equal(hash, POWER_IN_THOUSANDS_HASH);
}

static void holds_about(uint64_t root)
{
    assert_int_equal(t3r_isqrt64(root * root), root);
    assert_int_equal(t3r_isqrt64(root * root + 2 * root), root); /* the last before (root + 1)^2 */
}

/* Every square of a root below 2^21, which one step of Newton's method finds, and its neighbours; and some of the
 * others. */
TEST(square_root)
{
    for (uint64_t root = 0; root < UINT64_C(1) << 21; root++) {
        holds_about(root);
    }
    for (uint64_t root = UINT64_C(1) << 21; root <= UINT32_MAX; root += 4099) {
        holds_about(root);
    }
    for (uint32_t bit = 0; bit < 32; bit++) {
        for (uint64_t below = 1; below <= 1000; below++) {
            const uint64_t most = UINT64_C(2) << bit;
            holds_about(most > below ? most - below : 0);
        }
    }
}

/* 2^62 divided by every leading 16 bits of a number and its neighbours, at every place. */
TEST(reciprocal)
{
    uint64_t hash = T3R_HASH_START;
    for (uint32_t leading = 1 << 15; leading < 1 << 16; leading++) {
        for (uint32_t place = 0; place <= 16; place++) {
            const uint32_t edges[] = {leading << place, (leading << place) | ((1u << place) - 1)};
            for (size_t i = 0; i < 2; i++) {
                const t3r_reciprocal by = t3r_invert(edges[i]);
                const uint64_t normal = (uint64_t)edges[i] << by.lz, most = UINT64_C(1) << 62;
                assert_true(normal >> 31 == 1);
                assert_true((uint64_t)by.rn * normal <= most && most - (uint64_t)by.rn * normal < normal);
                hash = place == 7 ? t3r_hash_u32(hash, (uint32_t)by.rn) : hash;
            }
        }
    }
    assert_int_equal(hash, RECIPROCAL_HASH);
}

/* Every alpha: q from below 0 to after the last visible one, at the largest opacity and at others. */
TEST(alpha)
{
    double worst = 0;
    uint64_t hash = T3R_HASH_START;
    const uint16_t opacities[] = {257, 1000, 32768, 65000, UINT16_MAX};
    for (size_t i = 0; i < sizeof opacities / sizeof opacities[0]; i++) {
        for (int32_t q = -64; q <= 17 * T3R_ALPHA_RANGE; q += 4) {
            const uint16_t got = t3r_alpha_q16(q, opacities[i]);
            const double exact = exp(-fmax(q, 0) / 131072.0) * opacities[i];
            hash = t3r_hash_u16(hash, got);
            if (got > 0) {
                worst = fmax(worst, fabs(got - fmin(exact, T3R_ALPHA_MOST_Q16)));
            } else {
                assert_true(exact < T3R_ALPHA_LEAST_Q16 + ALPHA_WORST);
            }
        }
    }
    assert_true(worst < ALPHA_WORST);
    assert_int_equal(hash, ALPHA_HASH);
}

/* x / d in Q24 for every small d, for those near powers of two, and for the largest. */
TEST(quotient)
{
    uint64_t hash = T3R_HASH_START;
    for (uint32_t bit = 0; bit <= 30; bit++) {
        const uint32_t power = UINT32_C(1) << bit;
        for (uint32_t d = power - T3R_MIN(power - 1, 40u); d <= T3R_MIN(power + 40, UINT32_C(1) << 30); d++) {
            const t3r_divisor by = t3r_divisor_of(d);
            const int64_t most = T3R_MIN((int64_t)16 * d + 3, UINT32_MAX), step = most / 61 + 1;
            for (int64_t x = -most; x <= most; x += step) {
                const int64_t held = INT64_C(16) << 24, got = t3r_divide_q24(&by, x, 16);
                assert_int_equal(got, t3r_clamp64(t3r_round_div64(x * (1 << 24), d), -held, held));
                hash = t3r_hash_u32(hash, (uint32_t)got);
            }
        }
    }
    assert_int_equal(hash, QUOTIENT_HASH);
}

/* Every a times 1,000 b: the first, the last, and those near powers of two. */
TEST(products)
{
    uint64_t hash = T3R_HASH_START;
    for (int32_t k = 0; k < 1000; k++) {
        const int32_t bit = k % 16, about = k / 16 - 31;
        const uint16_t b = (uint16_t)((1 << bit) + about);
        uint32_t sum = 0;
        for (int32_t a = INT16_MIN; a <= INT16_MAX; a++) {
            const int16_t signed_b = (int16_t)b;
            const int16_t signed_got = t3r_mulr_q15((int16_t)a, signed_b);
            const uint32_t whole = (uint32_t)(uint16_t)a * b;
            const uint16_t rounded = t3r_mulr_q16((uint16_t)a, b), down = t3r_mul_q16((uint16_t)a, b);
            if (signed_got != (int16_t)((a * signed_b + (1 << 14)) >> 15) || down != whole >> 16 ||
                rounded != (whole + (uint64_t)0x8000) >> 16) {
                fail_msg("%d x %d", (int)a, (int)b);
            }
            sum = 31 * sum + (uint16_t)signed_got + 7u * rounded;
        }
        hash = t3r_hash_u32(hash, sum);
    }
    assert_int_equal(hash, PRODUCTS_HASH);
}
