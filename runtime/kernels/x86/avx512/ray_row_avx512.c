/* Sixteen rays at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "kernels/x86/intrinsics.h"

#define TARGET T3R_AVX512
#define LANES 16
#define RAY_ROW t3r_ray_row_avx512
#include "kernels/lanes/ray_lanes.h"

static inline TARGET pairs multiply(ulanes a, ulanes b)
{
    return (pairs)_mm512_mul_epu32((__m512i)a, (__m512i)b);
}

static inline TARGET pairs multiply_signed(lanes a, lanes b)
{
    return (pairs)_mm512_mul_epi32((__m512i)a, (__m512i)b);
}

static inline TARGET lanes join(pairs even, pairs odd)
{
    return (lanes)_mm512_mask_blend_epi32(0xaaaa, (__m512i)even, (__m512i)odd);
}

#else
typedef int t3r_no_ray_row_avx512; /* a file may not be empty */
#endif
