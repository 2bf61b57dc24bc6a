/* SPDX-License-Identifier: Apache-2.0 */
/* Eight rays at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "kernels/x86/intrinsics.h"

#define TARGET T3R_AVX2
#define LANES 8
#define OF(instruction) _mm256_##instruction
#define RAY_ROW t3r_ray_row_avx2
#include "kernels/lanes/ray_lanes.h"

static inline TARGET lanes join(pairs even, pairs odd)
{
    return (lanes)_mm256_blend_epi32((__m256i)even, (__m256i)odd, 0xaa);
}

#else
typedef int t3r_no_ray_row_avx2; /* a file may not be empty */
#endif
