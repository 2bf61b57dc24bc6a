/* SPDX-License-Identifier: Apache-2.0 */
/* Lanes of 16 unsigned bits in plain C: eight where the target has vectors, otherwise one.
 *
 * Each step is a separate loop over all lanes with 16-bit inputs and outputs, which compilers turn into one vector
 * instruction. In one loop over all steps GCC widens products of products to 32 bits. */
#ifndef T3R_KERNEL_LANES_H
#define T3R_KERNEL_LANES_H

#include <stdint.h>

#include "core/fixed.h"

#if defined(__SSE2__) || defined(__ARM_NEON) || defined(__ALTIVEC__) || defined(__wasm_simd128__) || defined(__VX__)
#define T3R_C_LANES 8
#else
#define T3R_C_LANES 1
#endif

/* GCC vectorizes a loop over an array if it does not unroll it first. Clang vectorizes loops over a vector type if it
 * unrolls them; for WebAssembly it does so only when asked, and else keeps each lane in memory. */
#if defined(__clang__) && T3R_C_LANES > 1
#define T3R_LANES_ARE_VECTOR
typedef uint16_t t3r_lanes_row __attribute__((vector_size(2 * T3R_C_LANES)));
typedef uint32_t t3r_lanes_wide __attribute__((vector_size(4 * T3R_C_LANES)));
#define T3R_EACH_LANE _Pragma("clang loop unroll(full)") for (int32_t i = 0; i < T3R_C_LANES; i++)
#else
typedef uint16_t t3r_lanes_row[T3R_C_LANES];
#define T3R_EACH_LANE _Pragma("GCC unroll 1") for (int32_t i = 0; i < T3R_C_LANES; i++)
#endif

typedef struct t3r_lanes {
    t3r_lanes_row x;
} t3r_lanes;

static inline t3r_lanes t3r_lanes_load(const uint16_t *from)
{
    t3r_lanes to;
    T3R_EACH_LANE
    {
        to.x[i] = from[i];
    }
    return to;
}

static inline void t3r_lanes_store(t3r_lanes from, uint16_t *to)
{
    T3R_EACH_LANE
    {
        to[i] = from.x[i];
    }
}

static inline t3r_lanes t3r_lanes_of(uint16_t x)
{
    t3r_lanes to;
    T3R_EACH_LANE
    {
        to.x[i] = x;
    }
    return to;
}

static inline t3r_lanes t3r_lanes_mul_q16(t3r_lanes a, t3r_lanes b)
{
#ifdef T3R_LANES_ARE_VECTOR /* t3r_mul_q16() of each lane: in a loop clang multiplies in 32 bits */
    const t3r_lanes_wide product =
        __builtin_convertvector(a.x, t3r_lanes_wide) * __builtin_convertvector(b.x, t3r_lanes_wide);
    a.x = __builtin_convertvector(product >> 16, t3r_lanes_row);
#else
    T3R_EACH_LANE
    {
        a.x[i] = t3r_mul_q16(a.x[i], b.x[i]);
    }
#endif
    return a;
}

static inline t3r_lanes t3r_lanes_mulr_q16(t3r_lanes a, t3r_lanes b)
{
#ifdef T3R_LANES_ARE_VECTOR
    a.x = t3r_lanes_mul_q16(a, b).x + (a.x * b.x >> 15);
#else
    T3R_EACH_LANE
    {
        a.x[i] = t3r_mulr_q16(a.x[i], b.x[i]);
    }
#endif
    return a;
}

static inline t3r_lanes t3r_lanes_add(t3r_lanes a, t3r_lanes b)
{
    T3R_EACH_LANE
    {
        a.x[i] = (uint16_t)(a.x[i] + b.x[i]);
    }
    return a;
}

static inline t3r_lanes t3r_lanes_subtract(t3r_lanes a, t3r_lanes b)
{
    T3R_EACH_LANE
    {
        a.x[i] = (uint16_t)(a.x[i] - b.x[i]);
    }
    return a;
}

static inline t3r_lanes t3r_lanes_or(t3r_lanes a, t3r_lanes b)
{
    T3R_EACH_LANE
    {
        a.x[i] |= b.x[i];
    }
    return a;
}

/* Returns x, or 0 where `of` is below `least`. */
static inline t3r_lanes t3r_lanes_where_at_least(t3r_lanes x, t3r_lanes of, uint16_t least)
{
    T3R_EACH_LANE
    {
        x.x[i] = of.x[i] < least ? 0 : x.x[i];
    }
    return x;
}

#endif
