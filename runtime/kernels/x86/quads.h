/* SPDX-License-Identifier: Apache-2.0 */
/* 128 bits of a vector, in the form that shared code for all instruction sets uses. */
#ifndef T3R_KERNELS_X86_QUADS_H
#define T3R_KERNELS_X86_QUADS_H

#include "intrinsics.h"
#include "variants.h"

#define OF_QUAD(instruction) _mm_##instruction

typedef __m128i quad;

/* Load and store at any address. */
T3R_LANES_INLINE quad load_quad(const void *from)
{
    return _mm_loadu_si128((const __m128i_u *)from);
}

T3R_LANES_INLINE void store_quad(void *to, quad x)
{
    _mm_storeu_si128((__m128i_u *)to, x);
}

/* Load the first 64 bits, or 32; the others are 0. */
T3R_LANES_INLINE quad load_half_quad(const void *from)
{
    return _mm_loadl_epi64((const __m128i_u *)from);
}

T3R_LANES_INLINE void store_half_quad(void *to, quad x)
{
    _mm_storel_epi64((__m128i_u *)to, x);
}

T3R_LANES_INLINE quad load_quarter_quad(const void *from)
{
    return _mm_loadu_si32(from);
}

T3R_LANES_INLINE void store_quarter_quad(void *to, quad x)
{
    _mm_storeu_si32(to, x);
}

/* Returns the least of four numbers of 32 bits. */
static inline T3R_SSE41 int32_t least_of_quad(quad x)
{
    x = _mm_min_epi32(x, _mm_shuffle_epi32(x, 0x4e));
    return _mm_cvtsi128_si32(_mm_min_epi32(x, _mm_shuffle_epi32(x, 0xb1)));
}

#endif
