/* Projection, eight Gaussians at a time. */
#include "variants.h"

#ifdef T3R_X86

#include "lanes_avx2.h"

#include "project_lanes.h"
#include "records.h"

static __attribute__((noinline)) T3R_AVX2 uint32_t project_batch(const t3r_projection *p, const t3r_gaussian *gaussians,
                                                                 t3r_splat *splats)
{
    lanes in[10], out[10];
    read_eight(gaussians, in);
    const uint32_t beyond = project_lanes(p, in, out);
    write_eight(out, splats);
    return beyond;
}

void t3r_project_avx2(const t3r_projection *p, const t3r_gaussian *gaussians, uint32_t count, t3r_splat *splats)
{
    project_all(p, gaussians, count, splats);
}

#else
typedef int t3r_no_project_avx2; /* a file may not be empty */
#endif
