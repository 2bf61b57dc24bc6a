/* Projection, sixteen Gaussians at a time. */
#include "variants.h"

#ifdef T3R_X86_OPTIMIZED

#include "lanes_avx512.h"

#include "project_lanes.h"
#include "records.h"

static __attribute__((noinline)) T3R_AVX512 uint32_t project_batch(const t3r_projection *p,
                                                                   const t3r_gaussian *gaussians, t3r_splat *splats)
{
    __m256i lower[10], upper[10];
    lanes in[10], out[10];
    read_eight(gaussians, lower);
    read_eight(gaussians + 8, upper);
    for (int i = 0; i < 10; i++) {
        in[i] = _mm512_inserti64x4(_mm512_castsi256_si512(lower[i]), upper[i], 1);
    }
    const uint32_t beyond = project_lanes(p, in, out);
    for (int i = 0; i < 10; i++) {
        lower[i] = _mm512_castsi512_si256(out[i]);
        upper[i] = _mm512_extracti64x4_epi64(out[i], 1);
    }
    write_eight(lower, splats);
    write_eight(upper, splats + 8);
    return beyond;
}

void t3r_project_avx512(const t3r_projection *p, const t3r_gaussian *gaussians, uint32_t count, t3r_splat *splats)
{
    project_all(p, gaussians, count, splats);
}

#else
typedef int t3r_no_project_avx512; /* a file may not be empty */
#endif
