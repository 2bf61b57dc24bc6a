/* SPDX-License-Identifier: Apache-2.0 */
/* Four points at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "kernels/x86/quads.h"

#define LANES 4
#define TARGET T3R_AVX2
#define OF(instruction) _mm256_##instruction
#define UNPROJECT t3r_unproject_avx2
#define LOCATE t3r_locate_avx2
#include "kernels/lanes/points_lanes.h"

static inline TARGET void narrow(lanes from, int32_t *to)
{
    const __m256i low = _mm256_permutevar8x32_epi32((__m256i)from, _mm256_setr_epi32(0, 2, 4, 6, 0, 2, 4, 6));
    _mm_storeu_si128((__m128i *)(void *)to, _mm256_castsi256_si128(low));
}

static inline TARGET int any(lanes mask)
{
    return !_mm256_testz_si256((__m256i)mask, (__m256i)mask);
}

#else
typedef int t3r_no_points_avx2; /* a file may not be empty */
#endif
