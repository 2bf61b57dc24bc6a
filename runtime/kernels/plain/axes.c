/* SPDX-License-Identifier: Apache-2.0 */
#include "core/fixed.h"
#include "kernels/project.h"

void t3r_axes_c(const t3r_projection *p, const t3r_gaussian *gaussians, const t3r_splat *splats, uint32_t count,
                t3r_splat_axes *axes)
{
    for (uint32_t i = 0; i < count; i++) {
        const t3r_splat *s = &splats[i];
        int32_t row[2][3];
        if (s->z_q20 == 0 || !t3r_footprint_rows(p, &gaussians[i], row[0], row[1])) {
            continue;
        }
        for (int k = 0; k < 2; k++) {
            /* the conic is S^-1 / 2, so it holds S^-1 in Q29. |T| <= 2^24: the sums stay below 2^56. */
            int64_t right = t3r_round_shift64((int64_t)row[0][k] * s->a_q30 + (int64_t)row[1][k] * s->b_q30, 26);
            int64_t down = t3r_round_shift64((int64_t)row[0][k] * s->b_q30 + (int64_t)row[1][k] * s->c_q30, 26);
            axes[i].right_q15[k] = (int16_t)t3r_clamp64(right, -T3R_AXIS_MOST_Q15, T3R_AXIS_MOST_Q15);
            axes[i].down_q15[k] = (int16_t)t3r_clamp64(down, -T3R_AXIS_MOST_Q15, T3R_AXIS_MOST_Q15);
        }
    }
}
