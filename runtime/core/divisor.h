/* SPDX-License-Identifier: Apache-2.0 */
/* Divides many numbers by one divisor through its reciprocal, with the exact quotient. */
#ifndef T3R_DIVISOR_H
#define T3R_DIVISOR_H

#include <stdint.h>

#include "fixed.h"

typedef struct t3r_divisor {
    uint32_t d, reciprocal, shift; /* reciprocal: 2^(shift + 24) / d, at least 2^31 */
} t3r_divisor;

/* Prepares a divisor d, 1..2^30. */
static inline t3r_divisor t3r_divisor_of(uint32_t d)
{
    T3R_BOUND(d > 0 && d <= 1u << 30);
    const uint32_t bits = t3r_msb32(d) + 1;
    const uint64_t reciprocal = (UINT64_C(1) << (31 + bits)) / d;
    return (t3r_divisor){d, (uint32_t)T3R_MIN(reciprocal, (uint64_t)UINT32_MAX), 7 + bits};
}

/* Returns x / d in Q24, round-half-up, clamped to +-limit; |x| below 2^32, limit at most 16. */
static inline int32_t t3r_divide_q24(const t3r_divisor *by, int64_t x, uint32_t limit)
{
    T3R_BOUND(x > -(INT64_C(1) << 32) && x < INT64_C(1) << 32 && limit <= 16);
    const uint64_t size = (uint64_t)t3r_abs64(x);
    if (size >= (uint64_t)limit * by->d) {
        return (x < 0 ? -1 : 1) * (int32_t)(limit << 24);
    }
    /* The quotient is at most 1 too small: by 2^-3 through the reciprocal, by less than 1 through rounding down; half
     * of d (of d - 1 where x is negative) is then added for rounding. The remainder is below 2 d. */
    uint32_t q = (uint32_t)((size * by->reciprocal) >> by->shift);
    const uint32_t rest = ((uint32_t)size << 24) + ((by->d - (x < 0)) >> 1) - q * by->d;
    q += rest >= by->d;
    return x < 0 ? -(int32_t)q : (int32_t)q;
}

#endif
