/* Sixteen rays at a time. */
#include "variants.h"

#ifdef T3R_X86

#include "intrinsics.h"

#define TARGET T3R_AVX512
#define LANES 16
#include "ray_lanes.h"

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

TARGET void t3r_ray_row_avx512(const t3r_ray_map *map, const int32_t *a_q24, const int32_t *b_q24, uint32_t count,
                               t3r_ray_places *out)
{
    const bool sloped = (map->slope_q30[0] | map->slope_q30[1] | map->slope_q30[2]) != 0;
    for (uint32_t i = 0; i < count; i += LANES) {
        const lanes a = (lanes)_mm512_loadu_si512(a_q24 + i);
        const lanes b = (lanes)_mm512_loadu_si512(b_q24 + i);
        lanes u, v, z;
        ray_block(map, a, b, sloped, &u, &v, &z);
        _mm512_storeu_si512(out->x_q16 + i, (__m512i)u);
        _mm512_storeu_si512(out->y_q16 + i, (__m512i)v);
        _mm512_storeu_si512(out->z_q24 + i, (__m512i)z);
    }
}

#else
typedef int t3r_no_ray_row_avx512; /* a file may not be empty */
#endif
