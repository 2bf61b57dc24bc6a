/* Eight points at a time (points_lanes.h). */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "kernels/x86/intrinsics.h"

#define LANES 8
#define TARGET T3R_AVX512
#define UNPROJECT t3r_unproject_avx512
#define LOCATE t3r_locate_avx512
typedef int64_t eight __attribute__((vector_size(64)));

static inline T3R_AVX512 eight times(eight a, eight b)
{
    return (eight)_mm512_mul_epi32((__m512i)a, (__m512i)b);
}

static inline T3R_AVX512 eight times_unsigned(eight a, eight b)
{
    return (eight)_mm512_mul_epu32((__m512i)a, (__m512i)b);
}

static inline T3R_AVX512 eight widened_steps(const uint16_t *from)
{
    return (eight)_mm512_cvtepu16_epi64(_mm_loadu_si128((const __m128i *)(const void *)from));
}

static inline T3R_AVX512 eight widened(const int32_t *from)
{
    return (eight)_mm512_cvtepi32_epi64(_mm256_loadu_si256((const __m256i *)(const void *)from));
}

/* The lower halves */
static inline T3R_AVX512 void narrow(eight from, int32_t *to)
{
    _mm256_storeu_si256((__m256i *)(void *)to, _mm512_cvtepi64_epi32((__m512i)from));
}

static inline T3R_AVX512 int any(eight mask)
{
    return _mm512_test_epi64_mask((__m512i)mask, (__m512i)mask) != 0;
}

#include "kernels/lanes/points_lanes.h"

#else
typedef int t3r_no_points_avx512; /* a file may not be empty */
#endif
