/* SPDX-License-Identifier: Apache-2.0 */
/* Upper halves of 32-bit products, which a Cortex-M with DSP instructions computes and rounds in one instruction. */
#ifndef T3R_KERNELS_ARM_PRODUCTS_H
#define T3R_KERNELS_ARM_PRODUCTS_H

#include <stdint.h>

/* Returns sum + (a b + 2^31) / 2^32, rounded down. */
static inline int32_t t3r_add_high_product(int32_t sum, int32_t a, int32_t b)
{
    int32_t to;
    __asm__("smmlar %0, %1, %2, %3" : "=r"(to) : "r"(a), "r"(b), "r"(sum));
    return to;
}

/* Returns the same without a sum. */
static inline int32_t t3r_high_product(int32_t a, int32_t b)
{
    int32_t to;
    __asm__("smmulr %0, %1, %2" : "=r"(to) : "r"(a), "r"(b));
    return to;
}

#endif
