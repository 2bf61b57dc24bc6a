/* Eight numbers of 32 bits, and of 64 where a product has them: in vectors of AVX2. */
#ifndef T3R_KERNELS_X86_LANES_AVX2_H
#define T3R_KERNELS_X86_LANES_AVX2_H

#include "intrinsics.h"
#include "variants.h"

#define LANES 8
#define T3R_LANES_TARGET T3R_AVX2
#define OF_LANES(instruction) _mm256_##instruction
#define ALL_64 _mm256_set1_epi64x

typedef __m256i lanes; /* of 32 bits */

static inline T3R_AVX2 lanes both(lanes a, lanes b)
{
    return _mm256_and_si256(a, b);
}

static inline T3R_AVX2 lanes either(lanes a, lanes b)
{
    return _mm256_or_si256(a, b);
}

static inline T3R_AVX2 lanes different(lanes a, lanes b)
{
    return _mm256_xor_si256(a, b);
}

#include "lanes_operations.h"

/* All bits where a is greater, or equal; else none. */
static inline T3R_AVX2 lanes greater(lanes a, lanes b)
{
    return _mm256_cmpgt_epi32(a, b);
}

static inline T3R_AVX2 lanes equal(lanes a, lanes b)
{
    return _mm256_cmpeq_epi32(a, b);
}

/* a >= b, of unsigned numbers */
static inline T3R_AVX2 lanes at_least(lanes a, lanes b)
{
    return equal(_mm256_max_epu32(a, b), a);
}

/* b where the mask has all bits, else a */
static inline T3R_AVX2 lanes chosen(lanes mask, lanes b, lanes a)
{
    return _mm256_blendv_epi8(a, b, mask);
}

/* a bit of each lane's sign */
static inline T3R_AVX2 uint32_t signs_of(lanes x)
{
    return (uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(x));
}

/* The low and the high halves of 64 bits. */
static inline T3R_AVX2 lanes low_of(wide x)
{
    return _mm256_blend_epi32(x.even, _mm256_slli_epi64(x.odd, 32), 0xaa);
}

static inline T3R_AVX2 lanes high_of(wide x)
{
    return _mm256_blend_epi32(odd_of(x.even), x.odd, 0xaa);
}

/* Shifts x in 1..2^31 - 1 left until bit 30 is its highest; *by: how far, below twice the first step. */
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

/* Two neighbours in the table. */
static inline T3R_AVX2 __m128i pair_at(const uint32_t *table, const uint32_t *index)
{
    return _mm_loadl_epi64((const __m128i *)(const void *)&table[*index]);
}

/* Entries 0..127 of a table of 129, and those after them. Loads one by one take no more time than a gather. */
static inline T3R_AVX2 void look_up(const uint32_t *table, lanes index, lanes *entry, lanes *next)
{
    uint32_t at[LANES];
    _mm256_storeu_si256((__m256i *)(void *)at, index);
    /* 0, 2 | 4, 6 and 1, 3 | 5, 7 */
    const __m128i even = _mm_unpacklo_epi64(pair_at(table, at), pair_at(table, at + 2));
    const __m128i odd = _mm_unpacklo_epi64(pair_at(table, at + 1), pair_at(table, at + 3));
    const __m128i more_even = _mm_unpacklo_epi64(pair_at(table, at + 4), pair_at(table, at + 6));
    const __m128i more_odd = _mm_unpacklo_epi64(pair_at(table, at + 5), pair_at(table, at + 7));
    const wide pair = {_mm256_inserti128_si256(_mm256_castsi128_si256(even), more_even, 1),
                       _mm256_inserti128_si256(_mm256_castsi128_si256(odd), more_odd, 1)};
    *entry = low_of(pair);
    *next = high_of(pair);
}

#endif
