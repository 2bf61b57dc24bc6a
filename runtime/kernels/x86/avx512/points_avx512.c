/* SPDX-License-Identifier: Apache-2.0 */
/* Eight points at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "kernels/x86/quads.h"

#define LANES 8
#define TARGET T3R_AVX512
#define OF(instruction) _mm512_##instruction
#define UNPROJECT t3r_unproject_avx512
#define LOCATE t3r_locate_avx512
#include "kernels/lanes/points_lanes.h"

static inline TARGET void narrow(lanes from, int32_t *to)
{
    _mm256_storeu_si256((__m256i *)(void *)to, _mm512_cvtepi64_epi32((__m512i)from));
}

static inline TARGET int any(lanes mask)
{
    return _mm512_test_epi64_mask((__m512i)mask, (__m512i)mask) != 0;
}

#else
typedef int t3r_no_points_avx512; /* a file may not be empty */
#endif
