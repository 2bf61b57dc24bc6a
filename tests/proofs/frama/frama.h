/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by the drivers of Eva; included before every source by -include. */
#ifndef T3R_FRAMA_H
#define T3R_FRAMA_H

#include <stdint.h>

/* Frama-C lacks them; no subject depends on an alignment. */
#define _Alignas(bytes)
#define _Alignof(type) 1

/* Any number in the range: without a body, Eva uses the contract. */
extern int Frama_C_entropy_source;
/*@ assigns \result \from low, high, Frama_C_entropy_source;
    assigns Frama_C_entropy_source \from Frama_C_entropy_source;
    ensures low <= \result <= high; */
long long t3r_any(long long low, long long high);
/*@ assigns \result \from low, high, Frama_C_entropy_source;
    assigns Frama_C_entropy_source \from Frama_C_entropy_source;
    ensures low <= \result <= high; */
unsigned long long t3r_any_unsigned(unsigned long long low, unsigned long long high);

/* Any bytes. */
/*@ requires room: count == 0 || \valid(bytes + (0 .. count - 1));
    assigns bytes[0 .. count - 1] \from Frama_C_entropy_source;
    ensures filled: \initialized(bytes + (0 .. count - 1)); */
void t3r_any_bytes(unsigned char *bytes, unsigned long count);

/* T3R_BOUND calls this where its bound fails: Eva has to show that it is never called. */
/*@ requires bound: \false;
    assigns \nothing; */
void t3r_bound_broken(void);
#define T3R_BOUND(condition) ((condition) ? (void)0 : t3r_bound_broken())

/* Replace builtins, of which Eva knows only the result's range. */
static inline unsigned t3r_swapped32(unsigned x)
{
    return x >> 24 | (x >> 8 & 0xff00u) | (x << 8 & 0xff0000u) | x << 24;
}
#define __builtin_bswap32(x) t3r_swapped32(x)

static inline unsigned long long t3r_swapped64(unsigned long long x)
{
    return (unsigned long long)t3r_swapped32((unsigned)x) << 32 | t3r_swapped32((unsigned)(x >> 32));
}
#define __builtin_bswap64(x) t3r_swapped64(x)

static inline int t3r_leading_zeros(unsigned x)
{
    int zeros = 0;
    while (zeros < 31 && x < 1u << (31 - zeros)) {
        zeros++;
    }
    return zeros;
}
#define __builtin_clz(x) t3r_leading_zeros(x)

#endif
