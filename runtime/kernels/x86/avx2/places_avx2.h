/* SPDX-License-Identifier: Apache-2.0 */
/* Eight places in a picture, and the pixels around them. */
#ifndef T3R_KERNELS_X86_PLACES_AVX2_H
#define T3R_KERNELS_X86_PLACES_AVX2_H

#include "kernels/x86/intrinsics.h"

typedef int32_t lanes __attribute__((vector_size(32)));
typedef uint32_t ulanes __attribute__((vector_size(32)));

static inline T3R_AVX2 lanes load(const int32_t *from)
{
    return (lanes)_mm256_loadu_si256((const __m256i *)from);
}

static inline T3R_AVX2 lanes least(lanes a, lanes b)
{
    return (lanes)_mm256_min_epi32((__m256i)a, (__m256i)b);
}

static inline T3R_AVX2 lanes most(lanes a, lanes b)
{
    return (lanes)_mm256_max_epi32((__m256i)a, (__m256i)b);
}

/* Clamps to 0..end. */
static inline T3R_AVX2 lanes held(lanes x, int32_t end)
{
    return least(most(x, (lanes){0}), (lanes){0} + end);
}

static inline T3R_AVX2 lanes where(lanes condition, lanes a, lanes b)
{
    return (lanes)_mm256_blendv_epi8((__m256i)b, (__m256i)a, (__m256i)condition);
}

/* Rounds half up, for any x. */
static inline T3R_AVX2 lanes rounded(lanes x, int bits)
{
    return ((x >> (bits - 1)) + 1) >> 1;
}

/* Loads four of a plane's bytes from `at` on, fewer at its end; last: the number of its bytes minus four. */
static inline T3R_AVX2 lanes bytes_from(const uint8_t *plane, lanes at, int32_t last)
{
    const lanes from = least(at, (lanes){0} + last);
    const __m256i four = _mm256_i32gather_epi32((const int *)plane, (__m256i)from, 1);
    return (lanes)_mm256_srlv_epi32(four, (__m256i)((at - from) * 8));
}

#endif
