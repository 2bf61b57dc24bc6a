/* SPDX-License-Identifier: Apache-2.0 */
#include "fitted_passes.h"

#include "core/fixed.h"
#include "pointmap/disagreement.h"

/* passes^2 x share x shared disagreement in levels^2. On the training scenes, whole pictures, 200 loses 0.04 dB, and
 * 800 takes a third more time for 0.01 dB. */
#define PASSES_FACTOR 400u
#define SHARE_COUNTED 4u       /* a share above 1/4 counts as 1/4: Gaussians don't get narrower than a pixel */
#define STEP 2u                /* pixels between compared pixels */
#define PAIRS_LEAST 64u        /* with fewer compared pairs, the disagreement is unknown */
#define UNKNOWN_Q8 (100u << 8) /* levels^2, typical of good sensors */
#define SHARED_LEAST_PART 8    /* of the disagreement, however little neighbours share */

/* Passes compare a part of the pixels where neighbours share at least this part of the disagreement, Q3, and
 * disagreement times pixels is at least that of 80 levels^2 at 256 x 256. In the built-in room neighbours share at most
 * 2.5 eighths, in recorded training scenes mostly 3.5 and more. Other rendered views disagree less. */
#define SHARED_LEAST_Q3 3
#define PARTS_FROM_Q8 ((UINT64_C(80) << 16) << 8)
#define PARTS_LEAST 3u /* so few whole passes at least: with fewer, the last one has to do too much */

uint32_t t3r_predict_passes(uint32_t points, uint32_t gaussians, uint32_t shared_q8, uint32_t most)
{
    if (gaussians == 0 || points == 0) { /* possible in a restored arena */
        return 1;
    }
    const uint64_t quarter = ((uint64_t)points + SHARE_COUNTED - 1) / SHARE_COUNTED;
    const uint64_t retained = T3R_MIN(gaussians, quarter);
    /* four times the square: its root is twice the result, which is then halved with rounding. Below 2^11 x 2^8 x
     * 2^32. */
    const uint64_t square = (uint64_t)4 * PASSES_FACTOR * 256u * points / (retained * T3R_MAX(shared_q8, 1u));
    return (uint32_t)t3r_clamp64(((int64_t)t3r_isqrt64(square) + 1) / 2, 1, most);
}

bool t3r_parts_suffice(uint32_t pixels, uint32_t disagreement_q8, int32_t shared_q8)
{
    return (uint64_t)pixels * disagreement_q8 >= PARTS_FROM_Q8 &&
           8 * (int64_t)shared_q8 >= SHARED_LEAST_Q3 * (int64_t)disagreement_q8;
}

t3r_passes t3r_passes_in_parts(uint32_t whole)
{
    const uint32_t count = whole + (whole + 1) / 4;
    return whole >= PARTS_LEAST ? (t3r_passes){count, count - 1} : (t3r_passes){whole, 0};
}

t3r_passes t3r_fitted_passes(t3r_runtime *rt, const t3r_view *views, uint32_t most)
{
    uint32_t pairs;
    int32_t shared_q8;
    const uint32_t measured_q8 =
        t3r_disagreement_q8(views, rt->views, rt->frame.exponent, rt->gain_q14, STEP, &pairs, &shared_q8);
    const bool known = pairs >= PAIRS_LEAST;
    const uint32_t counted_q8 = (uint32_t)T3R_MAX(shared_q8, (int32_t)(measured_q8 / SHARED_LEAST_PART));
    const uint32_t whole = t3r_predict_passes(rt->valid_points, rt->gaussians, known ? counted_q8 : UNKNOWN_Q8, most);
    const bool in_parts = known && !rt->config.structural &&
                          t3r_parts_suffice(rt->config.width * rt->config.height, measured_q8, shared_q8);
    return in_parts ? t3r_passes_in_parts(whole) : (t3r_passes){whole, 0};
}
