/* SPDX-License-Identifier: Apache-2.0 */
/* Fixed-point arithmetic; all rounding is defined here (SPEC.md, "Rounding").
 *
 * Every rounding in the runtime is round-half-up: add half, shift arithmetically. Right shifts of negative numbers are
 * arithmetic with all compilers that build trim3r; the assertion below refuses others. */
#ifndef T3R_FIXED_H
#define T3R_FIXED_H

#include <stdint.h>

#include "assertion.h"

_Static_assert((-3 >> 1) == -2, "right shift of negative numbers must be arithmetic");

/* For functions that are too long to be inlined everywhere in builds for size. */
#ifdef __OPTIMIZE_SIZE__
#define T3R_SHARED static __attribute__((noinline, unused))
#else
#define T3R_SHARED static inline
#endif

#define T3R_MIN(a, b) ((a) < (b) ? (a) : (b))
#define T3R_MAX(a, b) ((a) > (b) ? (a) : (b))

/* Returns x / 2^shift, round-half-up; shift 0..62, x + 2^(shift - 1) < 2^63. */
static inline int64_t t3r_round_shift64(int64_t x, uint32_t shift)
{
    T3R_BOUND(shift <= 62 && (shift == 0 || x <= INT64_MAX - ((int64_t)1 << (shift - 1))));
    return shift == 0 ? x : (x + ((int64_t)1 << (shift - 1))) >> shift;
}

/* Returns x / 2^shift, round-half-up; shift 0..30, x + 2^(shift - 1) < 2^31. */
static inline int32_t t3r_round_shift32(int32_t x, uint32_t shift)
{
    T3R_BOUND(shift <= 30 && (shift == 0 || x <= INT32_MAX - ((int32_t)1 << (shift - 1))));
    return shift == 0 ? x : (x + ((int32_t)1 << (shift - 1))) >> shift;
}

/* Returns x 2^shift for a shift of either sign, round-half-up; the result is below 2^63. A right shift of 63 or more
 * gives 0. */
static inline int64_t t3r_scale64(int64_t x, int32_t shift)
{
    if (shift >= 0) {
        T3R_BOUND(shift <= 62 && x >= INT64_MIN >> shift && x <= INT64_MAX >> shift);
        return (int64_t)((uint64_t)x << shift);
    }
    return shift <= -63 ? 0 : t3r_round_shift64(x, (uint32_t)-shift);
}

/* Returns t3r_scale64() in 32 bits, modulo 2^32. The last bit shifted out is added after the shift, so nothing
 * overflows. */
static inline int32_t t3r_scale32(int32_t x, int32_t shift)
{
    if (shift >= 0) {
        return shift >= 32 ? 0 : (int32_t)((uint32_t)x << shift);
    }
    const int32_t twice = x >> T3R_MIN(-shift - 1, 31);
    return (twice >> 1) + (twice & 1);
}

/* Returns (a b) / 2^15, round-half-up: (a b + 2^14) >> 15, in 16-bit steps that compilers turn into 16-bit lanes (as
 * SSSE3 pmulhrsw and NEON/MVE sqrdmulh do). With a b = 65536 high + low this is 2 high plus the rounded low / 2^15,
 * which is (low / 2^14 + 1) / 2 rounded down. -32768 x -32768 wraps to -32768; only sqrdmulh differs there. */
static inline int16_t t3r_mulr_q15(int16_t a, int16_t b)
{
    int16_t high = (int16_t)(((int32_t)a * b) >> 16);
    uint16_t low = (uint16_t)((int32_t)a * b);
    uint16_t carry = (uint16_t)((uint16_t)((low >> 14) + 1) >> 1);
    return (int16_t)(uint16_t)((uint16_t)high + (uint16_t)high + carry);
}

/* Returns n / d, round-half-up: floor(n / d + 1/2); d > 0 and below 2^62, 2 |n| + d below 2^63. */
T3R_SHARED int64_t t3r_round_div64(int64_t n, int64_t d)
{
    T3R_BOUND(d > 0 && d < INT64_C(1) << 62 && n >= -(INT64_MAX - d) / 2 && n <= (INT64_MAX - d) / 2);
    int64_t doubled = 2 * n + d;
    int64_t quotient = doubled / (2 * d);
    return quotient - (doubled % (2 * d) < 0);
}

/* Returns t3r_round_div64() in 32 bits; d > 0, |n| and d below 2^29. */
static inline int32_t t3r_round_div32(int32_t n, int32_t d)
{
    T3R_BOUND(d > 0 && d < 1 << 29 && n > -(1 << 29) && n < 1 << 29);
    int32_t doubled = 2 * n + d;
    int32_t quotient = doubled / (2 * d);
    return quotient - (doubled % (2 * d) < 0);
}

/* Returns (a b) / 2^16, round-half-up, of non-negative numbers: (a b + 2^15) >> 16, also in 16-bit steps (SSE2 pmulhuw
 * and pmullw, MVE vrmulh, NEON vmull and vrshrn). At most 65534. */
static inline uint16_t t3r_mulr_q16(uint16_t a, uint16_t b)
{
    uint16_t high = (uint16_t)(((uint32_t)a * b) >> 16);
    uint16_t low = (uint16_t)((uint32_t)a * b);
    return (uint16_t)(high + (low >> 15));
}

/* Returns (a b) / 2^16, rounded down, of non-negative numbers: one instruction on 16-bit lanes (SSE2 pmulhuw, MVE
 * vmulh). The result is less than either factor. */
static inline uint16_t t3r_mul_q16(uint16_t a, uint16_t b)
{
    return (uint16_t)(((uint32_t)a * b) >> 16);
}

static inline int32_t t3r_clamp32(int32_t x, int32_t low, int32_t high)
{
    T3R_BOUND(low <= high);
    return x < low ? low : x > high ? high : x;
}

static inline int64_t t3r_clamp64(int64_t x, int64_t low, int64_t high)
{
    T3R_BOUND(low <= high);
    return x < low ? low : x > high ? high : x;
}

static inline int32_t t3r_abs32(int32_t x)
{
    T3R_BOUND(x != INT32_MIN);
    return x < 0 ? -x : x;
}

static inline int64_t t3r_abs64(int64_t x)
{
    T3R_BOUND(x != INT64_MIN);
    return x < 0 ? -x : x;
}

/* Return the position of the highest set bit, floor(log2 x); x > 0. */
static inline uint32_t t3r_msb32(uint32_t x)
{
    T3R_BOUND(x > 0);
    return 31u - (uint32_t)__builtin_clz(x);
}

static inline uint32_t t3r_msb64(uint64_t x)
{
    uint32_t high = (uint32_t)(x >> 32);
    return high != 0 ? 32u + t3r_msb32(high) : t3r_msb32((uint32_t)x);
}

/* Returns floor(sqrt x). */
uint32_t t3r_isqrt64(uint64_t x);
/* Returns log2(x) in Q16, error below 2^-14; x > 0. */
int32_t t3r_log2_q16(uint32_t x);
/* Returns t3r_log2_q16() of a 64-bit number. */
static inline int32_t t3r_log2_wide_q16(uint64_t x)
{
    uint32_t msb = t3r_msb64(x), excess = msb > 31 ? msb - 31 : 0;
    return t3r_log2_q16((uint32_t)(x >> excess)) + (int32_t)(excess << 16);
}
/* Returns 2^(x / 65536) in Q16, relative error below 2^-14 and half a step; x in -16 x 65536..15 x 65536. */
uint32_t t3r_exp2_q16(int32_t x_q16);

/* Returns 32 mixed bits (Wellons' "lowbias32" constants): deterministic white noise by index. */
static inline uint32_t t3r_mix32(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

#endif
