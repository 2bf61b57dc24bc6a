/* SPDX-License-Identifier: Apache-2.0 */
/* Back-projection of one pixel, and parts shared by plain C and the variants of `locate` (points.c). */
#ifndef T3R_KERNEL_POINTS_PARTS_H
#define T3R_KERNEL_POINTS_PARTS_H

#include <stdbool.h>
#include <stdint.h>

#include "core/fixed.h"
#include "core/scene_frame.h"

#define T3R_RAY_MOST_Q24 (16 << 24)

/* Returns the direction of a pixel's ray along one axis at unit depth, Q24, clamped to +-16: `at` is u or v. With |u -
 * c| < 2^15 and 1 / f <= 1/8 the product stays below 2^31 x 2^29. */
static inline int32_t t3r_ray_along_q24(uint32_t at, int32_t centre_q16, int32_t inverse_q32)
{
    const int64_t x = t3r_round_shift64((((int64_t)at << 16) - centre_q16) * inverse_q32, 24);
    return (int32_t)t3r_clamp64(x, -T3R_RAY_MOST_Q24, T3R_RAY_MOST_Q24);
}

/* Computes the point of a ray x, y, 1 at depth z. |ray| <= 2^28 sqrt 3: sums below 2^60, directions at most 2^28.8; z <
 * 2^30. */
static inline void t3r_point_along(const t3r_pose *pose, const int32_t ray_q24[2], int64_t z_q20, int32_t point_q20[3])
{
    for (int i = 0; i < 3; i++) {
        const int32_t *r_q30 = pose->rotation_q30 + 3 * i;
        const int64_t sum =
            (int64_t)r_q30[0] * ray_q24[0] + (int64_t)r_q30[1] * ray_q24[1] + (int64_t)r_q30[2] * (1 << 24);
        const int64_t x = pose->position_q20[i] + t3r_round_shift64(t3r_round_shift64(sum, 30) * z_q20, 24);
        point_q20[i] = (int32_t)t3r_clamp64(x, -T3R_POSITION_MOST_Q20, T3R_POSITION_MOST_Q20);
    }
}

#define T3R_NEAREST_Q20 (1 << 15) /* 1/32 scene unit, as in the rasterizer */

/* Returns a bound, Q16, of the error of a pixel coordinate computed by a reciprocal.
 *
 * The exact coordinate rounds x / z to 2^-24, which moves f x / z by at most f 2^-25, and rounds once more: 1/2. The
 * other one takes x 2^shift / 32 rounded down (off by at most 1) times rn (off by at most 8 of 2^31): a product of 2^57
 * x / z that is off by at most 9 x 2^31. Rounded down to Q25 that is 5.5 units, so f x / z moves by 5.5 f 2^-25, and
 * rounding down once more by 1. Together less than 8 f 2^-25 + 2. */
static inline int64_t t3r_place_slack_q16(int32_t focal_q16)
{
    return (focal_q16 >> 22) + 2;
}

/* Whether a coordinate plus 1/2 is far enough from whole pixels that rounding it down gives the exact coordinate's
 * pixel. */
static inline bool t3r_is_between(int64_t at_q16, int32_t focal_q16)
{
    const int64_t part = at_q16 & 0xffff, slack = t3r_place_slack_q16(focal_q16);
    return part >= slack && part < (1 << 16) - slack;
}

#endif
