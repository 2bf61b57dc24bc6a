/* SPDX-License-Identifier: Apache-2.0 */
/* Four lanes of 32 bits, or 64 for products, in vectors of SSE4.1. */
#ifndef T3R_KERNELS_X86_LANES_SSE41_H
#define T3R_KERNELS_X86_LANES_SSE41_H

#include "kernels/x86/quads.h"
#include "kernels/x86/variants.h"

#define LANES 4
#define T3R_LANES_TARGET T3R_SSE41
#define OF_LANES(instruction) _mm_##instruction
#define OF_ALL_BITS(instruction) _mm_##instruction##_si128
#define T3R_LANES_BY_FACTORS 1
#define ALL_64 _mm_set1_epi64x

typedef __m128i lanes; /* of 32 bits */
typedef __m128i_u lanes_there;

#include "kernels/lanes/vectors/operations.h"

#include "kernels/lanes/vectors/even_odd.h"
#include "kernels/lanes/vectors/masks.h"

#include "kernels/lanes/vectors/alternating.h"

static inline T3R_SSE41 lanes alternating(lanes even, lanes odd)
{
    return _mm_blend_epi16(even, odd, 0xcc);
}

static inline T3R_SSE41 lanes joined(const quad x[LANES / 4])
{
    return x[0];
}

static inline T3R_SSE41 quad part(lanes x, int i)
{
    (void)i; /* 0 */
    return x;
}

/* Repeats 128 bits. */
static inline T3R_SSE41 lanes repeated(quad x)
{
    return x;
}

/* Returns one bit per lane, its sign. */
static inline T3R_SSE41 uint32_t signs_of(lanes x)
{
    return (uint32_t)_mm_movemask_ps(_mm_castsi128_ps(x));
}

/* Shifts each lane by its own count, as instructions shift all lanes by one: once for each count. Counts beyond the
 * bits give 0, or the sign. */
#define SHIFTED(instruction, x, by)                                                                                    \
    _mm_blend_epi16(                                                                                                   \
        alternating(instruction(x, _mm_cvtepu32_epi64(by)), instruction(x, odd_of(by))),                               \
        alternating(instruction(x, _mm_unpackhi_epi32(by, all(0))), instruction(x, _mm_srli_si128(by, 12))), 0xf0)

static inline T3R_SSE41 lanes left_each(lanes x, lanes by)
{
    return SHIFTED(_mm_sll_epi32, x, by);
}

static inline T3R_SSE41 lanes right_each(lanes x, lanes by)
{
    return SHIFTED(_mm_srl_epi32, x, by);
}

static inline T3R_SSE41 lanes signed_right_each(lanes x, lanes by)
{
    return SHIFTED(_mm_sra_epi32, x, by);
}

/* Shifts two 64-bit numbers in the same way. */
#define SHIFTED_64(instruction, x, by)                                                                                 \
    _mm_blend_epi16(instruction(x, by), instruction(x, _mm_unpackhi_epi64(by, by)), 0xf0)

static inline T3R_SSE41 wide right_by(wide x, wide by)
{
    return (wide){SHIFTED_64(_mm_srl_epi64, x.even, by.even), SHIFTED_64(_mm_srl_epi64, x.odd, by.odd)};
}

static inline T3R_SSE41 wide left_by(wide x, wide by)
{
    return (wide){SHIFTED_64(_mm_sll_epi64, x.even, by.even), SHIFTED_64(_mm_sll_epi64, x.odd, by.odd)};
}

/* Shifts x in 1..2^31 - 1 left until bit 30 is its highest; *by: the shift. The exponent of the number converted to
 * floating point gives the shift; bits below a 1 are cleared first, so that rounding cannot carry. */
static inline T3R_SSE41 lanes normal_of(lanes x, int first_step, lanes *by)
{
    (void)first_step;
    const __m128 rounded = _mm_cvtepi32_ps(without(_mm_srli_epi32(x, 1), x));
    *by = subtract(all(127 + 30), _mm_srli_epi32(_mm_castps_si128(rounded), 23));
    /* 2^by, by conversion from floating point */
    const __m128 power = _mm_castsi128_ps(_mm_slli_epi32(add(*by, all(127)), 23));
    return multiply(x, _mm_cvttps_epi32(power));
}

/* Repeats the first 32 bits in all lanes. */
static inline T3R_SSE41 lanes first_of(quad x)
{
    return _mm_shuffle_epi32(x, 0);
}

/* Loads pairs of signed 8-bit numbers, widened to 16. */
static inline T3R_SSE41 lanes load_8(const uint8_t *from)
{
    return _mm_cvtepi8_epi16(_mm_loadl_epi64((const __m128i_u *)(const void *)from));
}

/* Load and store 16-bit numbers; stored ones are below 2^16. */
static inline T3R_SSE41 lanes load_16(const uint16_t *from)
{
    return _mm_cvtepu16_epi32(_mm_loadl_epi64((const __m128i *)(const void *)from));
}

static inline T3R_SSE41 void store_16(uint16_t *to, lanes x)
{
    _mm_storel_epi64((__m128i *)(void *)to, _mm_packus_epi32(x, x));
}

#endif
