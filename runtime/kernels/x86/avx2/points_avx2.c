/* Four points at a time (points_lanes.h). */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "kernels/x86/intrinsics.h"

#define LANES 4
#define TARGET T3R_AVX2
#define UNPROJECT t3r_unproject_avx2
#define LOCATE t3r_locate_avx2
typedef int64_t four __attribute__((vector_size(32)));

static inline T3R_AVX2 four times(four a, four b)
{
    return (four)_mm256_mul_epi32((__m256i)a, (__m256i)b);
}

static inline T3R_AVX2 four times_unsigned(four a, four b)
{
    return (four)_mm256_mul_epu32((__m256i)a, (__m256i)b);
}

static inline T3R_AVX2 four widened_steps(const uint16_t *from)
{
    return (four)_mm256_cvtepu16_epi64(_mm_loadl_epi64((const __m128i *)(const void *)from));
}

static inline T3R_AVX2 four widened(const int32_t *from)
{
    return (four)_mm256_cvtepi32_epi64(_mm_loadu_si128((const __m128i *)(const void *)from));
}

/* The lower halves */
static inline T3R_AVX2 void narrow(four from, int32_t *to)
{
    const __m256i low = _mm256_permutevar8x32_epi32((__m256i)from, _mm256_setr_epi32(0, 2, 4, 6, 0, 2, 4, 6));
    _mm_storeu_si128((__m128i *)(void *)to, _mm256_castsi256_si128(low));
}

static inline T3R_AVX2 int any(four mask)
{
    return !_mm256_testz_si256((__m256i)mask, (__m256i)mask);
}

#include "kernels/lanes/points_lanes.h"

#else
typedef int t3r_no_points_avx2; /* a file may not be empty */
#endif
