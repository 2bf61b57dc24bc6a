/* From the sums over a splat's pixels in a tile to moments in the splat's own coordinates (SPEC.md, "Refinement"). */
#ifndef T3R_REFINE_MOMENTS_H
#define T3R_REFINE_MOMENTS_H

#include <stdint.h>

#include "kernels/scatter.h"
#include "refine.h"

/* The splat's own coordinates: e = K d, K = T^T S^-1 with the first two columns of T, so that d q = -e . step for a
 * shift by `step` of them; e per pixel to the right and down, Q20, held to T3R_OWN_AXIS_MOST_Q20. */
typedef struct t3r_own_axes {
    int32_t right_q20[2], down_q20[2];
} t3r_own_axes;

#define T3R_OWN_AXIS_MOST_Q20 964688 /* |K| <= t / (t^2 + 0.3) < 0.913 for each of T's singular values t */

/* Moments e_x^i e_y^j, levels^2, Q7. */
typedef struct t3r_own_moments {
    int64_t gradient[T3R_REFINE_MOMENTS_2];
    int64_t curvature[T3R_REFINE_MOMENTS_4];
} t3r_own_moments;

/* dx, dy: the last column and row of the sums less the splat's centre, pixels in Q12, below 2^27. */
void t3r_own_moments_of(const t3r_tile_sums *sums, const t3r_own_axes *axes, int64_t dx_q12, int64_t dy_q12,
                        t3r_own_moments *own);

#endif
