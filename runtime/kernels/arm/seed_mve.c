/* SPDX-License-Identifier: Apache-2.0 */
/* Distances of a sample to a centre, four at a time, in vectors of Helium. */
#include "variants.h"

#ifdef T3R_MVE

#include <arm_mve.h>

#include "kernels/seed.h"

/* Returns the distances of four points with this centre added: differences have 16 bits, squares 30. */
static inline int32x4_t distances_with(const t3r_sample *sample, uint32_t i, const int16_t c[T3R_DIMENSIONS],
                                       mve_pred16_t there)
{
    int32x4_t distance = vdupq_n_s32(0);
    for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
        const int32x4_t e = vsubq_n_s32(vldrhq_z_s32(&sample->feature_q11[d][i], there), c[d]);
        distance = vaddq_s32(distance, vshrq_n_s32(vmulq_s32(e, e), 2));
    }
    return vminq_s32(distance, vld1q_z_s32(&sample->distance_q20[i], there));
}

uint64_t t3r_sample_potential_mve(const t3r_sample *sample, uint32_t count, const int16_t centre_q11[T3R_DIMENSIONS])
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < count; i += 4) {
        const mve_pred16_t there = vctp32q(count - i);
        sum = vaddlvaq_p_u32(sum, vreinterpretq_u32_s32(distances_with(sample, i, centre_q11, there)), there);
    }
    return sum;
}

uint64_t t3r_sample_approach_mve(const t3r_sample *sample, uint32_t first, uint32_t end,
                                 const int16_t centre_q11[T3R_DIMENSIONS])
{
    uint64_t sum = 0;
    for (uint32_t i = first; i < end; i += 4) {
        const mve_pred16_t there = vctp32q(end - i);
        const int32x4_t distance = distances_with(sample, i, centre_q11, there);
        vst1q_p_s32(&sample->distance_q20[i], distance, there);
        sum = vaddlvaq_p_u32(sum, vreinterpretq_u32_s32(distance), there);
    }
    return sum;
}

#else
typedef int t3r_no_seed_mve; /* a file may not be empty */
#endif
