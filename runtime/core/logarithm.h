/* Inline log2 and 2^x for hot loops; other code calls the functions of fixed.h. */
#ifndef T3R_LOGARITHM_H
#define T3R_LOGARITHM_H

#include "fixed.h"

#define T3R_LOG_STEPS 128u
extern const uint32_t t3r_log2_table_q20[T3R_LOG_STEPS + 1]; /* log2(1 + i / 128), nearest */
extern const uint32_t t3r_exp2_table_q20[T3R_LOG_STEPS + 1]; /* 2^(i / 128), nearest */

/* Returns entry + (next - entry) fraction, Q20; fraction Q16 below 1. A step is below 2^13.5, so the product fits. */
static inline uint32_t t3r_interpolate(const uint32_t *table, uint32_t index, uint32_t fraction_q16)
{
    return table[index] + (((table[index + 1] - table[index]) * fraction_q16 + 0x8000) >> 16);
}

/* Returns log2(x) in Q16, error below 2^-14; x > 0. */
static inline int32_t t3r_log2_inline_q16(uint32_t x)
{
    const uint32_t exponent = t3r_msb32(x), mantissa = x << (31 - exponent); /* 1.31 */
    const uint32_t log_q20 = t3r_interpolate(t3r_log2_table_q20, (mantissa >> 24) & 127, (mantissa >> 8) & 0xffff);
    return (int32_t)((exponent << 16) + ((log_q20 + 8) >> 4));
}

/* Returns 2^(x / 1024) in Q16, x in -16 x 1024..0. */
static inline uint32_t t3r_exp2_of_q10(int32_t x_q10)
{
    T3R_BOUND(x_q10 >= -16 * 1024 && x_q10 <= 0);
    const uint32_t part = (uint32_t)x_q10 & 1023;
    const uint32_t mantissa_q20 = t3r_interpolate(t3r_exp2_table_q20, part >> 3, (part & 7) << 13);
    const uint32_t shift = (uint32_t)(4 - (x_q10 >> 10));
    return (mantissa_q20 + (1u << (shift - 1))) >> shift;
}

#endif
