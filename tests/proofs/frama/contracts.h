/* SPDX-License-Identifier: Apache-2.0 */
/* Contracts of functions of fixed.h: bounds of their results for all arguments that T3R_BOUND allows. These
 * declarations precede fixed.h, so that the runtime's own text needs none. Eva shows that intermediate results do not
 * overflow (fixed.c). */
#ifndef T3R_CONTRACTS_H
#define T3R_CONTRACTS_H

#include <stdint.h>

/*@ lemma division: \forall integer a, b; 0 < b ==> a == b * (a / b) + a % b && -b < a % b < b;
    lemma remainder_sign: \forall integer a, b; 0 < b ==> (a >= 0 ==> a % b >= 0) && (a <= 0 ==> a % b <= 0); */

/*@ requires shift <= 62;
    requires shift == 0 || x <= INT64_MAX - (1 << (shift - 1));
    assigns \nothing;
    ensures whole: shift == 0 ==> \result == x;
    ensures rounded: shift > 0 ==> \result == (x + (1 << (shift - 1))) >> shift; */
static inline int64_t t3r_round_shift64(int64_t x, uint32_t shift);

/*@ requires shift <= 30;
    requires shift == 0 || x <= INT32_MAX - (1 << (shift - 1));
    assigns \nothing;
    ensures whole: shift == 0 ==> \result == x;
    ensures rounded: shift > 0 ==> \result == (x + (1 << (shift - 1))) >> shift; */
static inline int32_t t3r_round_shift32(int32_t x, uint32_t shift);

/*@ requires 0 < d < 536870912 && -536870912 < n < 536870912;
    assigns \nothing;
    ensures nearest: 2 * d * \result <= 2 * n + d < 2 * d * \result + 2 * d; */
static inline int32_t t3r_round_div32(int32_t n, int32_t d);

/*@ requires low <= high;
    assigns \nothing;
    ensures held: low <= \result <= high;
    ensures same: low <= x <= high ==> \result == x;
    ensures ends: (x < low ==> \result == low) && (x > high ==> \result == high); */
static inline int32_t t3r_clamp32(int32_t x, int32_t low, int32_t high);

/*@ requires low <= high;
    assigns \nothing;
    ensures held: low <= \result <= high;
    ensures same: low <= x <= high ==> \result == x;
    ensures ends: (x < low ==> \result == low) && (x > high ==> \result == high); */
static inline int64_t t3r_clamp64(int64_t x, int64_t low, int64_t high);

/*@ requires x != INT32_MIN;
    assigns \nothing;
    ensures size: \result >= 0 && (\result == x || \result == -x); */
static inline int32_t t3r_abs32(int32_t x);

/*@ requires x != INT64_MIN;
    assigns \nothing;
    ensures size: \result >= 0 && (\result == x || \result == -x); */
static inline int64_t t3r_abs64(int64_t x);

#endif
