/* SPDX-License-Identifier: Apache-2.0 */
#include "fitted_passes.h"

#include "core/fixed.h"
#include "pointmap/disagreement.h"

/* passes^2 x share x disagreement in levels^2. On the training scenes 400 to 800 are within 0.01 dB. */
#define PAY 512u
#define SHARE_COUNTED 4u       /* a share above 1/4 counts as 1/4: Gaussians don't get narrower than a pixel */
#define STEP 2u                /* pixels between compared pixels */
#define PAIRS_LEAST 64u        /* with fewer compared pairs, the disagreement is unknown */
#define UNKNOWN_Q8 (150u << 8) /* levels^2, typical of good sensors */

uint32_t t3r_predict_passes(uint32_t points, uint32_t gaussians, uint32_t disagreement_q8, uint32_t most)
{
    if (gaussians == 0 || points == 0) { /* possible in a restored arena */
        return 1;
    }
    const uint64_t quarter = ((uint64_t)points + SHARE_COUNTED - 1) / SHARE_COUNTED;
    const uint64_t retained = T3R_MIN(gaussians, quarter);
    /* four times the square: its root is twice the result, which is then halved with rounding. Below 2^11 x 2^8 x
     * 2^32. */
    const uint64_t square = (uint64_t)4 * PAY * 256u * points / (retained * T3R_MAX(disagreement_q8, 1u));
    return (uint32_t)t3r_clamp64(((int64_t)t3r_isqrt64(square) + 1) / 2, 1, most);
}

uint32_t t3r_fitted_passes(t3r_runtime *rt, const t3r_view *views, uint32_t most)
{
    uint32_t pairs;
    const uint32_t disagreement_q8 =
        t3r_disagreement_q8(views, rt->views, rt->frame.exponent, rt->gain_q14, STEP, &pairs);
    return t3r_predict_passes(rt->valid_points, rt->gaussians, pairs < PAIRS_LEAST ? UNKNOWN_Q8 : disagreement_q8,
                              most);
}
