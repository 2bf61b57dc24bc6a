/* SPDX-License-Identifier: Apache-2.0 */
#include "surface.h"

#include "core/fixed.h"

#define SLOPE_MOST_Q8 INT32_MAX

int64_t t3r_inverse_depth_q30(uint16_t depth)
{
    const uint32_t twice = 2 * (uint32_t)depth;
    return T3R_MIN(((UINT32_C(1) << 31) + depth) / twice, (uint32_t)T3R_INVERSE_MOST);
}

/* Returns n / d in Q8, where n has `bits` more fraction bits than d; |n| < 2^62. */
static int32_t quotient_q8(int64_t n, int64_t d, int32_t bits)
{
    const int32_t shift = T3R_MIN(12, 60 - (int32_t)t3r_msb64((uint64_t)t3r_abs64(n) | 1));
    const int64_t q = t3r_scale64(t3r_round_div64(n * (INT64_C(1) << shift), d), 8 - shift - bits);
    return (int32_t)t3r_clamp64(q, -SLOPE_MOST_Q8, SLOPE_MOST_Q8);
}

t3r_surface_slope t3r_surface_slope_of(const t3r_surface_sums *s, int32_t spread_q4)
{
    /* i at most 2^24: sums of x squared below 2^62, of x i below 2^55 */
    const int64_t mean = t3r_round_div64(s->i, s->n);
    const int64_t xx = t3r_round_div64(16 * (s->xx - t3r_round_div64(s->x * s->x, s->n)), s->n) + spread_q4;
    const int64_t yy = t3r_round_div64(16 * (s->yy - t3r_round_div64(s->y * s->y, s->n)), s->n) + spread_q4;
    const int64_t xy = t3r_round_div64(16 * (s->xy - t3r_round_div64(s->x * s->y, s->n)), s->n);
    const int64_t xi = t3r_round_div64(s->xi - s->x * mean, s->n), yi = t3r_round_div64(s->yi - s->y * mean, s->n);
    /* Q4; xi at most sqrt(xx) 2^24. These are covariances of real pixels up to rounding, with the spread added, so the
     * determinant is positive. */
    const int64_t determinant = T3R_MAX(xx * yy - xy * xy, 1);
    return (t3r_surface_slope){quotient_q8(xi * yy - yi * xy, determinant, -4),
                               quotient_q8(yi * xx - xi * xy, determinant, -4)};
}
