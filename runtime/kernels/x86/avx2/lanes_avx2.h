/* SPDX-License-Identifier: Apache-2.0 */
/* Eight lanes of 32 bits, or 64 for products, in vectors of AVX2. */
#ifndef T3R_KERNELS_X86_LANES_AVX2_H
#define T3R_KERNELS_X86_LANES_AVX2_H

#include "kernels/x86/quads.h"
#include "kernels/x86/variants.h"

#define LANES 8
#define T3R_LANES_TARGET T3R_AVX2
#define OF_LANES(instruction) _mm256_##instruction
#define OF_ALL_BITS(instruction) _mm256_##instruction##_si256
#define T3R_LANES_BY_FACTORS 0
#define ALL_64 _mm256_set1_epi64x

typedef __m256i lanes; /* of 32 bits */
typedef __m256i_u lanes_there;

#include "kernels/lanes/vectors/operations.h"

#include "kernels/lanes/vectors/even_odd.h"
#include "kernels/lanes/vectors/masks.h"

#include "kernels/lanes/vectors/alternating.h"
#include "kernels/lanes/vectors/shifts.h"

static inline T3R_AVX2 lanes alternating(lanes even, lanes odd)
{
    return _mm256_blend_epi32(even, odd, 0xaa);
}

/* Joins two vectors of 128 bits. */
static inline T3R_AVX2 lanes joined(const quad x[LANES / 4])
{
    return _mm256_inserti128_si256(_mm256_castsi128_si256(x[0]), x[1], 1);
}

static inline T3R_AVX2 quad part(lanes x, int i)
{
    return i == 0 ? _mm256_castsi256_si128(x) : _mm256_extracti128_si256(x, 1);
}

/* Repeats 128 bits. */
static inline T3R_AVX2 lanes repeated(quad x)
{
    return _mm256_broadcastsi128_si256(x);
}

/* Returns one bit per lane, its sign. */
static inline T3R_AVX2 uint32_t signs_of(lanes x)
{
    return (uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(x));
}

/* Shifts x in 1..2^31 - 1 left until bit 30 is its highest; *by: the shift, below twice the first step. */
static inline T3R_AVX2 lanes normal_of(lanes x, int first_step, lanes *by)
{
    *by = all(0);
    for (int step = first_step; step > 0; step >>= 1) {
        const lanes shift = both(greater(all(1 << (31 - step)), x), all(step));
        x = _mm256_sllv_epi32(x, shift);
        *by = add(*by, shift);
    }
    return x;
}

/* Repeats the first 32 bits in all lanes. */
static inline T3R_AVX2 lanes first_of(quad x)
{
    return _mm256_broadcastd_epi32(x);
}

/* Loads pairs of signed 8-bit numbers, widened to 16. */
static inline T3R_AVX2 lanes load_8(const uint8_t *from)
{
    return _mm256_cvtepi8_epi16(_mm_loadu_si128((const __m128i_u *)(const void *)from));
}

/* Load and store 16-bit numbers; stored ones are below 2^16. */
static inline T3R_AVX2 lanes load_16(const uint16_t *from)
{
    return _mm256_cvtepu16_epi32(_mm_loadu_si128((const __m128i *)(const void *)from));
}

static inline T3R_AVX2 void store_16(uint16_t *to, lanes x)
{
    const lanes packed = _mm256_permute4x64_epi64(_mm256_packus_epi32(x, x), 0x08);
    _mm_storeu_si128((__m128i *)(void *)to, _mm256_castsi256_si128(packed));
}

#endif
