/* Eight rays at a time. */
#include "variants.h"

#ifdef T3R_X86

#include "intrinsics.h"

#define TARGET T3R_AVX2
#define LANES 8
#include "ray_lanes.h"

static inline TARGET pairs multiply(ulanes a, ulanes b)
{
    return (pairs)_mm256_mul_epu32((__m256i)a, (__m256i)b);
}

static inline TARGET pairs multiply_signed(lanes a, lanes b)
{
    return (pairs)_mm256_mul_epi32((__m256i)a, (__m256i)b);
}

static inline TARGET lanes join(pairs even, pairs odd)
{
    return (lanes)_mm256_blend_epi32((__m256i)even, (__m256i)odd, 0xaa);
}

TARGET void t3r_ray_row_avx2(const t3r_ray_map *map, const int32_t *a_q24, const int32_t *b_q24, uint32_t count,
                             t3r_ray_places *out)
{
    const bool sloped = (map->slope_q30[0] | map->slope_q30[1] | map->slope_q30[2]) != 0;
    for (uint32_t i = 0; i < count; i += LANES) {
        const lanes a = (lanes)_mm256_loadu_si256((const __m256i *)(a_q24 + i));
        const lanes b = (lanes)_mm256_loadu_si256((const __m256i *)(b_q24 + i));
        lanes u, v, z;
        ray_block(map, a, b, sloped, &u, &v, &z);
        _mm256_storeu_si256((__m256i *)(out->x_q16 + i), (__m256i)u);
        _mm256_storeu_si256((__m256i *)(out->y_q16 + i), (__m256i)v);
        _mm256_storeu_si256((__m256i *)(out->z_q24 + i), (__m256i)z);
    }
}

#else
typedef int t3r_no_ray_row_avx2; /* a file may not be empty */
#endif
