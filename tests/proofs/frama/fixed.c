/* SPDX-License-Identifier: Apache-2.0 */
/* runtime/core/fixed.h and fixed.c, each function over its domain; one power of two at a time where the size of a
 * number decides a shift. Where a bound involves two arguments, the boxes below lie within it; docs/study/proofs.md
 * says what they leave out. */
#include "core/fixed.h"

static void round_shifts(void)
{
    for (uint32_t shift = 0; shift <= 62; shift++) {
        const int64_t half = shift == 0 ? 0 : (int64_t)1 << (shift - 1);
        t3r_round_shift64(t3r_any(INT64_MIN, INT64_MAX - half), shift);
    }
    for (uint32_t shift = 0; shift <= 30; shift++) {
        const int32_t half = shift == 0 ? 0 : (int32_t)1 << (shift - 1);
        t3r_round_shift32((int32_t)t3r_any(INT32_MIN, INT32_MAX - half), shift);
    }
}

static void scales(void)
{
    for (int32_t shift = -62; shift < 0; shift++) {
        t3r_scale64(t3r_any(INT64_MIN, INT64_MAX - ((int64_t)1 << (-shift - 1))), shift);
    }
    t3r_scale64(t3r_any(INT64_MIN, INT64_MAX), (int32_t)t3r_any(INT32_MIN, -63));
    for (int32_t shift = 0; shift <= 62; shift++) {
        t3r_scale64(t3r_any(INT64_MIN >> shift, INT64_MAX >> shift), shift);
    }
    for (int32_t shift = -70; shift <= 70; shift++) {
        t3r_scale32((int32_t)t3r_any(INT32_MIN, INT32_MAX), shift);
    }
    t3r_scale32((int32_t)t3r_any(INT32_MIN, INT32_MAX), (int32_t)t3r_any(INT32_MIN + 1, INT32_MAX));
}

static void products(void)
{
    t3r_mulr_q15((int16_t)t3r_any(INT16_MIN, INT16_MAX), (int16_t)t3r_any(INT16_MIN, INT16_MAX));
    t3r_mulr_q16((uint16_t)t3r_any(0, UINT16_MAX), (uint16_t)t3r_any(0, UINT16_MAX));
    t3r_mul_q16((uint16_t)t3r_any(0, UINT16_MAX), (uint16_t)t3r_any(0, UINT16_MAX));
}

static void quotients(void)
{
    for (uint32_t bits = 0; bits < 62; bits++) {
        const int64_t most = (INT64_C(2) << bits) - 1, size = (INT64_MAX - most) / 2;
        t3r_round_div64(t3r_any(-size, size), t3r_any(INT64_C(1) << bits, most));
    }
    t3r_round_div32((int32_t)t3r_any(1 - (1 << 29), (1 << 29) - 1), (int32_t)t3r_any(1, (1 << 29) - 1));
}

static void sizes(void)
{
    t3r_clamp32((int32_t)t3r_any(INT32_MIN, INT32_MAX), (int32_t)t3r_any(INT32_MIN, 0), (int32_t)t3r_any(0, INT32_MAX));
    t3r_clamp64(t3r_any(INT64_MIN, INT64_MAX), t3r_any(INT64_MIN, 0), t3r_any(0, INT64_MAX));
    t3r_abs32((int32_t)t3r_any(INT32_MIN + 1, INT32_MAX));
    t3r_abs64(t3r_any(INT64_MIN + 1, INT64_MAX));
}

static void logarithms(void)
{
    t3r_msb32((uint32_t)t3r_any(1, UINT32_MAX));
    t3r_log2_q16((uint32_t)t3r_any(1, UINT32_MAX));
    t3r_isqrt64(0);
    for (uint32_t bits = 0; bits < 64; bits++) {
        const uint64_t low = UINT64_C(1) << bits, x = t3r_any_unsigned(low, low + (low - 1));
        t3r_msb64(x);
        t3r_log2_wide_q16(x);
        t3r_isqrt64(x);
    }
    for (int32_t exponent = -16; exponent < 15; exponent++) {
        t3r_exp2_q16((int32_t)t3r_any(exponent * 65536, exponent * 65536 + 65535));
    }
    t3r_exp2_q16(15 << 16);
    t3r_mix32((uint32_t)t3r_any(0, UINT32_MAX));
}

int main(void)
{
    round_shifts();
    scales();
    products();
    quotients();
    sizes();
    logarithms();
    return 0;
}
