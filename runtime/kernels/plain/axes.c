/* SPDX-License-Identifier: Apache-2.0 */
#include "core/fixed.h"
#include "kernels/scatter.h"

/* Returns a column of T times a column of the conic. The conic is S^-1 / 2, so it holds S^-1 in Q29. |T| <= 2^24: the
 * sum stays below 2^56. */
static int16_t axis_q15(int32_t a_q12, int32_t first_q30, int32_t b_q12, int32_t second_q30)
{
    const int64_t axis_q41 = (int64_t)a_q12 * first_q30 + (int64_t)b_q12 * second_q30;
    return (int16_t)t3r_clamp32((int32_t)t3r_round_shift64(axis_q41, 26), -T3R_AXIS_MOST_Q15, T3R_AXIS_MOST_Q15);
}

void t3r_axes_c(const t3r_projection *p, const t3r_gaussian *gaussians, const t3r_splat *splats, uint32_t count,
                t3r_refine_sums *sums)
{
    for (uint32_t i = 0; i < count; i++) {
        const t3r_splat *s = &splats[i];
        int32_t a_q12[3], b_q12[3];
        if (s->z_q20 == 0) {
            continue;
        }
        (void)t3r_footprint_rows(p, &gaussians[i], a_q12, b_q12); /* a splat's Gaussian is visible */
        for (int k = 0; k < 2; k++) {
            sums[i].axes.right_q15[k] = axis_q15(a_q12[k], s->a_q30, b_q12[k], s->b_q30);
            sums[i].axes.down_q15[k] = axis_q15(a_q12[k], s->b_q30, b_q12[k], s->c_q30);
        }
    }
}
