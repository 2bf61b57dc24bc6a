/* SPDX-License-Identifier: Apache-2.0 */
/* points.c with several points at a time, in 64-bit lanes: included once for each width, which defines LANES, TARGET,
 * the prefix of its instructions (OF), and the functions declared first. Factors of products always fit 32 bits. */
#include "core/fixed.h"
#include "kernels/points_parts.h"

typedef int64_t lanes __attribute__((vector_size(LANES * sizeof(int64_t))));
typedef uint64_t wide __attribute__((vector_size(LANES * sizeof(uint64_t))));
typedef long long vector
    __attribute__((vector_size(LANES * sizeof(int64_t)), may_alias)); /* type of the instructions' operands */
typedef long long half_there __attribute__((vector_size(LANES * sizeof(int32_t)), aligned(4), may_alias));

/* Stores the lower halves. */
static inline TARGET void narrow(lanes from, int32_t *to);
/* Whether any lane of a mask is set. */
static inline TARGET int any(lanes mask);

static inline TARGET lanes times(lanes a, lanes b)
{
    return (lanes)OF(mul_epi32)((vector)a, (vector)b);
}

static inline TARGET lanes times_unsigned(lanes a, lanes b)
{
    return (lanes)OF(mul_epu32)((vector)a, (vector)b);
}

static inline TARGET lanes widened_steps(const uint16_t *from)
{
    return (lanes)OF(cvtepu16_epi64)(LANES == 4 ? load_half_quad(from) : load_quad(from));
}

static inline TARGET lanes widened(const int32_t *from)
{
    return (lanes)OF(cvtepi32_epi64)(*(const half_there *)(const void *)from);
}

static inline TARGET lanes all(int64_t x)
{
    return (lanes){0} + x;
}

/* Returns b where the mask has ones, else a. */
static inline TARGET lanes chosen(lanes mask, lanes b, lanes a)
{
    return (b & mask) | (a & ~mask);
}

static inline TARGET lanes held(lanes x, int64_t most)
{
    x = chosen(x > all(most), all(most), x);
    return chosen(x < all(-most), all(-most), x);
}

/* Returns x / 2^shift rounded down, |x| <= 2^62, without a 64-bit arithmetic shift, which AVX2 lacks. */
static inline TARGET lanes down(lanes x, int shift)
{
    return (lanes)((wide)(x + all(INT64_C(1) << 62)) >> shift) - all(INT64_C(1) << (62 - shift));
}

/* Returns t3r_round_shift64(). */
static inline TARGET lanes rounded(lanes x, int shift)
{
    return down(x + all(INT64_C(1) << (shift - 1)), shift);
}

static inline TARGET lanes ray(lanes at, int32_t centre_q16, int32_t inverse_q32)
{
    return held(rounded(times((at << 16) - all(centre_q16), all(inverse_q32)), 24), T3R_RAY_MOST_Q24);
}

/* Returns t3r_depth_q20(): the shift is 0..62, and a product of 48 bits plus half of 2^shift fits. */
static inline TARGET lanes depth_of(t3r_depth_scale scale, lanes step)
{
    const uint64_t half = scale.shift > 0 ? UINT64_C(1) << (scale.shift - 1) : 0;
    const lanes z = (lanes)((wide)(times_unsigned(step, all(scale.mantissa)) + all((int64_t)half)) >> scale.shift);
    const lanes most = all(T3R_POSITION_MOST_Q20 - 1);
    return chosen(z > most, most, z);
}

TARGET void UNPROJECT(const t3r_unprojection *restrict from, t3r_points *restrict points)
{
    const t3r_pinhole *view = &from->view;
    for (uint32_t i = 0; i < points->count; i += LANES) {
        const lanes z = depth_of(from->scale, widened_steps(points->depth + i));
        const lanes x = ray(widened_steps(points->u + i), view->cx_q16, from->inverse_fx_q32);
        const lanes y = ray(widened_steps(points->v + i), view->cy_q16, from->inverse_fy_q32);
        for (int k = 0; k < 3; k++) {
            const int32_t *r_q30 = view->pose.rotation_q30 + 3 * k;
            const lanes direction =
                rounded(times(x, all(r_q30[0])) + times(y, all(r_q30[1])) + all((int64_t)r_q30[2] * (1 << 24)), 30);
            const lanes at = rounded(times(direction, z), 24) + all(view->pose.position_q20[k]);
            narrow(held(at, T3R_POSITION_MOST_Q20), points->point_q20[k] + i);
        }
    }
}

/* Returns 1..16: z in [2^15, 2^31) times 2^shift is in [2^31, 2^32). */
static inline TARGET lanes leading_zeros(lanes z)
{
    lanes shift = all(1);
    for (int step = 8; step > 0; step >>= 1) {
        const lanes more = ((z << shift) < all(INT64_C(1) << (32 - step))) & all(step);
        shift += more;
    }
    return shift;
}

/* Returns 2^62 / normal minus 1 to 7, in (2^30 - 8, 2^31), for a normal in [2^31, 2^32). Newton's iteration r (2 - n
 * r) starts from 48/17 - 32/17 n, whose error is 1/17, squares the error three times to 2^-32.7, and stays below the
 * quotient; rounding down on the way adds at most 3 units of 2^-30 in either direction. */
static inline TARGET lanes reciprocal(lanes normal)
{
    lanes r_q30 = all(3031741621) - (lanes)((wide)times_unsigned(normal, all(2021161081)) >> 32);
    for (int turn = 0; turn < 3; turn++) {
        const lanes error_q30 = all(INT64_C(1) << 31) - (lanes)((wide)times_unsigned(normal, r_q30) >> 32);
        r_q30 = (lanes)((wide)times_unsigned(r_q30, error_q30) >> 30);
    }
    return r_q30 - all(4);
}

/* Returns place_by(): the coordinate plus 1/2, Q16. */
static inline TARGET lanes place(lanes x, lanes shift, lanes rn, int32_t focal_q16, int32_t centre_q16)
{
    const lanes ratio_q25 = down(times(down(x << shift, 5), rn), 32);
    return down(times(ratio_q25, all(focal_q16)), 25) + all((int64_t)centre_q16 + (1 << 15));
}

static inline TARGET lanes is_between(lanes at_q16, int32_t focal_q16)
{
    const lanes part = at_q16 & all(0xffff), slack = all(t3r_place_slack_q16(focal_q16));
    return (part >= slack) & (part < all(1 << 16) - slack);
}

/* Finds the pixels of LANES points; returns the lanes that only t3r_locate_point() can decide. */
static inline TARGET lanes locate(const t3r_pinhole *restrict view, const t3r_points *restrict points, uint32_t at,
                                  t3r_places *restrict places)
{
    const int32_t *r_q30 = view->pose.rotation_q30;
    lanes offset[3], camera[3], wide_offset = all(0);
    for (int i = 0; i < 3; i++) {
        offset[i] = widened(points->point_q20[i] + at) - all(view->pose.position_q20[i]);
        wide_offset |= offset[i] > all(INT32_MAX); /* 2^31 itself would be multiplied as -2^31 */
    }
    for (int i = 0; i < 3; i++) {
        camera[i] = rounded(times(offset[0], all(r_q30[i])) + times(offset[1], all(r_q30[3 + i])) +
                                times(offset[2], all(r_q30[6 + i])),
                            30);
    }
    const lanes z16 = camera[2] << 4;
    const lanes is_before = (camera[2] >= all(T3R_NEAREST_Q20)) & (camera[2] <= all(INT32_MAX)) & (camera[0] <= z16) &
                            (camera[0] + z16 >= all(0)) & (camera[1] <= z16) & (camera[1] + z16 >= all(0));
    const lanes z = chosen(is_before, camera[2], all(1 << 20));
    const lanes shift = leading_zeros(z), rn = reciprocal(z << shift);
    const lanes column_q16 = place(camera[0] & is_before, shift, rn, view->fx_q16, view->cx_q16);
    const lanes row_q16 = place(camera[1] & is_before, shift, rn, view->fy_q16, view->cy_q16);
    const lanes column = down(column_q16, 16), row = down(row_q16, 16);
    const lanes is_inside =
        is_before & (column >= all(0)) & (row >= all(0)) & (column < all(view->width)) & (row < all(view->height));
    narrow((times(row, all(view->width)) + column) | ~is_inside, (int32_t *)places->pixel + at);
    narrow(camera[2], places->z_q20 + at);
    const lanes is_sure = is_between(column_q16, view->fx_q16) & is_between(row_q16, view->fy_q16);
    return wide_offset | (is_before & ~is_sure);
}

TARGET void LOCATE(const t3r_pinhole *restrict view, const t3r_points *restrict points, t3r_places *restrict places)
{
    for (uint32_t at = 0; at < points->count; at += LANES) {
        const lanes open = locate(view, points, at, places);
        if (!any(open)) {
            continue;
        }
        for (uint32_t i = 0; i < LANES; i++) {
            if (open[i] != 0) {
                const int32_t point[3] = {points->point_q20[0][at + i], points->point_q20[1][at + i],
                                          points->point_q20[2][at + i]};
                places->pixel[at + i] = t3r_locate_point(view, point, &places->z_q20[at + i]);
            }
        }
    }
}
