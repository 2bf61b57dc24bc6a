/* Eight numbers of 32 bits, and of 64 where a product has them: in vectors of AVX2. */
#ifndef T3R_KERNELS_X86_LANES_AVX2_H
#define T3R_KERNELS_X86_LANES_AVX2_H

#include "intrinsics.h"
#include "variants.h"

#define LANES 8

typedef __m256i lanes; /* of 32 bits */

/* 64 bits of each lane: of lanes 0, 2, 4, 6 and of 1, 3, 5, 7. */
typedef struct wide {
    __m256i even, odd;
} wide;

static inline T3R_AVX2 lanes all(int32_t x)
{
    return _mm256_set1_epi32(x);
}

static inline T3R_AVX2 lanes add(lanes a, lanes b)
{
    return _mm256_add_epi32(a, b);
}

static inline T3R_AVX2 lanes subtract(lanes a, lanes b)
{
    return _mm256_sub_epi32(a, b);
}

/* Modulo 2^32. */
static inline T3R_AVX2 lanes multiply(lanes a, lanes b)
{
    return _mm256_mullo_epi32(a, b);
}

/* All bits where a >= b, of unsigned numbers. */
static inline T3R_AVX2 lanes at_least(lanes a, lanes b)
{
    return _mm256_cmpeq_epi32(_mm256_max_epu32(a, b), a);
}

static inline T3R_AVX2 __m256i odd_of(lanes x)
{
    return _mm256_srli_epi64(x, 32);
}

static inline T3R_AVX2 wide widened(lanes x)
{
    return (wide){_mm256_and_si256(x, _mm256_set1_epi64x(UINT32_MAX)), odd_of(x)};
}

static inline T3R_AVX2 wide product(lanes a, lanes b)
{
    return (wide){_mm256_mul_epi32(a, b), _mm256_mul_epi32(odd_of(a), odd_of(b))};
}

static inline T3R_AVX2 wide unsigned_product(lanes a, lanes b)
{
    return (wide){_mm256_mul_epu32(a, b), _mm256_mul_epu32(odd_of(a), odd_of(b))};
}

static inline T3R_AVX2 wide sum(wide a, wide b)
{
    return (wide){_mm256_add_epi64(a.even, b.even), _mm256_add_epi64(a.odd, b.odd)};
}

static inline T3R_AVX2 wide difference(wide a, wide b)
{
    return (wide){_mm256_sub_epi64(a.even, b.even), _mm256_sub_epi64(a.odd, b.odd)};
}

static inline T3R_AVX2 wide all_wide(int64_t x)
{
    return (wide){_mm256_set1_epi64x(x), _mm256_set1_epi64x(x)};
}

/* The low and the high halves. */
static inline T3R_AVX2 lanes low_of(wide x)
{
    return _mm256_blend_epi32(x.even, _mm256_slli_epi64(x.odd, 32), 0xaa);
}

static inline T3R_AVX2 lanes high_of(wide x)
{
    return _mm256_blend_epi32(odd_of(x.even), x.odd, 0xaa);
}

/* Unsigned shifts: of the result only what bits had is right. */
static inline T3R_AVX2 wide right(wide x, int shift)
{
    return (wide){_mm256_srli_epi64(x.even, shift), _mm256_srli_epi64(x.odd, shift)};
}

/* Words 0..7 of eight records to a vector a word, or back. */
static inline T3R_AVX2 void transpose(lanes v[8])
{
    lanes t[8], u[8];
    for (int i = 0; i < 8; i += 2) {
        t[i] = _mm256_unpacklo_epi32(v[i], v[i + 1]);
        t[i + 1] = _mm256_unpackhi_epi32(v[i], v[i + 1]);
    }
    for (int i = 0; i < 8; i += 4) {
        u[i] = _mm256_unpacklo_epi64(t[i], t[i + 2]);
        u[i + 1] = _mm256_unpackhi_epi64(t[i], t[i + 2]);
        u[i + 2] = _mm256_unpacklo_epi64(t[i + 1], t[i + 3]);
        u[i + 3] = _mm256_unpackhi_epi64(t[i + 1], t[i + 3]);
    }
    for (int i = 0; i < 4; i++) {
        v[i] = _mm256_permute2x128_si256(u[i], u[i + 4], 0x20);
        v[i + 4] = _mm256_permute2x128_si256(u[i], u[i + 4], 0x31);
    }
}

#endif
