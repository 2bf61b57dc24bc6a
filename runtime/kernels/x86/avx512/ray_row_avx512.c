/* SPDX-License-Identifier: Apache-2.0 */
/* Sixteen rays at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "kernels/x86/intrinsics.h"

#define TARGET T3R_AVX512
#define LANES 16
#define OF(instruction) _mm512_##instruction
#define RAY_ROW t3r_ray_row_avx512
#include "kernels/lanes/ray_lanes.h"

static inline TARGET lanes join(pairs even, pairs odd)
{
    return (lanes)_mm512_mask_blend_epi32(0xaaaa, (__m512i)even, (__m512i)odd);
}

#else
typedef int t3r_no_ray_row_avx512; /* a file may not be empty */
#endif
