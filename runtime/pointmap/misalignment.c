/* SPDX-License-Identifier: Apache-2.0 */
#include "misalignment.h"

#include <stdbool.h>

#include "core/fixed.h"
#include "kernels/points_parts.h"
#include "reproject.h"

#define SAME_SURFACE 16           /* on one surface, depths differ by at most 1/16 of the lesser */
#define DERIVATIVE_MOST (1 << 20) /* levels a radian or scene unit */
#define PULL_MOST (1 << 28)
#define LEVER_MOST_Q20 (1 << 26)

/* A pixel of one view as seen in another. */
typedef struct sighting {
    int32_t point_q20[3];
    int32_t ratio_q24[2];  /* x / z and y / z in the other view, within +-16 */
    int32_t at_q16[2];     /* column and row there */
    int32_t inverse_z_q20; /* at most 2^25 */
} sighting;

/* Finds where `to` shows a pixel of `from`. Returns false if another surface is there. */
static bool sees(const t3r_pointmap *from, uint32_t u, uint32_t v, const t3r_pointmap *to, sighting *s)
{
    const t3r_view *view = to->view;
    t3r_projected_pixel there;
    if (!t3r_point(from, u, v, s->point_q20) || !t3r_project_to_pixel(view, s->point_q20, &there) ||
        !t3r_is_reliable(view->validity[there.pixel])) {
        return false;
    }
    const int64_t z = there.z_q20, surface = t3r_depth_q20(to->scale, view->depth[there.pixel]);
    if (!t3r_is_one_surface(z, surface, SAME_SURFACE)) {
        return false;
    }
    const int32_t *r_q30 = view->pose.rotation_q30;
    const int32_t focal_q16[2] = {view->fx_q16, view->fy_q16}, centre_q16[2] = {view->cx_q16, view->cy_q16};
    for (int i = 0; i < 2; i++) {
        int64_t sum = 0; /* as in t3r_locate_point(): partial sums below 2^62 */
        for (int k = 0; k < 3; k++) {
            sum += (int64_t)r_q30[3 * k + i] * (s->point_q20[k] - (int64_t)view->pose.position_q20[k]);
        }
        s->ratio_q24[i] = (int32_t)t3r_round_div64(t3r_round_shift64(sum, 30) * (1 << 24), z); /* |x| <= 16 z < 2^35 */
        /* within half a pixel of `there`, which is in the image */
        s->at_q16[i] = (int32_t)t3r_round_shift64((int64_t)s->ratio_q24[i] * focal_q16[i], 24) + centre_q16[i];
    }
    s->inverse_z_q20 = (int32_t)((INT64_C(1) << 40) / z);
    return true;
}

/* Returns the luma at a place of a level, Q8, bilinear. The place must have pixels around it. */
static int32_t luma_q8(const t3r_luma_level *luma, const int32_t at_q16[2])
{
    const uint8_t *p = luma->pixels + (size_t)(at_q16[1] >> 16) * luma->width + (uint32_t)(at_q16[0] >> 16);
    const int32_t fu = (at_q16[0] >> 8) & 255, fv = (at_q16[1] >> 8) & 255;
    const int32_t above = p[0] * (256 - fu) + p[1] * fu;
    const int32_t below = p[luma->width] * (256 - fu) + p[luma->width + 1] * fu;
    return t3r_round_shift32(above * (256 - fv) + below * fv, 8);
}

/* Converts full-size pixel coordinates to a level. Returns false within a pixel and a half of its edges. */
static bool place_of(const t3r_luma_level *luma, const int32_t full_q16[2], int32_t at_q16[2])
{
    const uint32_t side[2] = {luma->width, luma->height};
    for (int i = 0; i < 2; i++) {
        at_q16[i] = ((full_q16[i] + (1 << 15)) >> luma->level) - (1 << 15);
        if (at_q16[i] < 1 << 16 || at_q16[i] >= (int32_t)(side[i] - 2) << 16) {
            return false;
        }
    }
    return true;
}

/* Computes how luma changes with the point's ray, levels a radian in Q8, in the axes of the scene. Times 1 / z this is
 * the change with the point. */
static void pull_of(const t3r_luma_level *luma, const int32_t at_q16[2], const sighting *s, const t3r_view *view,
                    int64_t pull_q8[3])
{
    const int32_t focal_q16[2] = {view->fx_q16, view->fy_q16};
    int64_t axis_q8[3];
    for (int i = 0; i < 2; i++) {
        int32_t before[2] = {at_q16[0], at_q16[1]}, behind[2] = {at_q16[0], at_q16[1]};
        before[i] -= 1 << 16;
        behind[i] += 1 << 16;
        const int64_t rise = luma_q8(luma, behind) - luma_q8(luma, before); /* over two pixels, Q8 */
        axis_q8[i] = t3r_clamp64(t3r_round_shift64(rise * focal_q16[i], luma->level + 17), -PULL_MOST, PULL_MOST);
    }
    const int64_t along = axis_q8[0] * s->ratio_q24[0] + axis_q8[1] * s->ratio_q24[1]; /* below 2^57 */
    axis_q8[2] = t3r_clamp64(-t3r_round_shift64(along, 24), -PULL_MOST, PULL_MOST);
    for (int i = 0; i < 3; i++) {
        const int32_t *r_q30 = view->pose.rotation_q30 + 3 * i;
        pull_q8[i] = t3r_round_shift64(r_q30[0] * axis_q8[0] + r_q30[1] * axis_q8[1] + r_q30[2] * axis_q8[2], 30);
    }
}

/* Computes the derivatives by the six unknowns of a camera at `centre`, if the point moves with it. |pull| is below
 * 2^29 and levers are at most 2^26: products below 2^56. */
static void derivatives(const sighting *s, const int64_t pull_q8[3], const int32_t centre_q20[3], int32_t sign,
                        int32_t d[T3R_ALIGN_UNKNOWNS])
{
    int64_t lever_q20[3]; /* over z */
    for (int i = 0; i < 3; i++) {
        const int64_t offset = s->point_q20[i] - (int64_t)centre_q20[i];
        lever_q20[i] = t3r_clamp64(t3r_round_shift64(offset * s->inverse_z_q20, 20), -LEVER_MOST_Q20, LEVER_MOST_Q20);
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const int64_t turn = t3r_round_shift64(lever_q20[j] * pull_q8[k] - lever_q20[k] * pull_q8[j], 28);
        const int64_t shift = t3r_round_shift64(pull_q8[i] * s->inverse_z_q20, 28);
        d[i] = sign * (int32_t)t3r_clamp64(turn, -DERIVATIVE_MOST, DERIVATIVE_MOST);
        d[3 + i] = sign * (int32_t)t3r_clamp64(shift, -DERIVATIVE_MOST, DERIVATIVE_MOST);
    }
}

/* Adds one pixel. A view has fewer than 2^18, each with derivatives up to 2^20, a difference up to 2^13 and a weight up
 * to 2^8: sums stay below 2^58. */
static void add(t3r_align_sums *sums, const int32_t d[T3R_ALIGN_UNKNOWNS], int32_t difference_q4, int32_t weight_q8)
{
    for (uint32_t i = 0, at = 0; i < T3R_ALIGN_UNKNOWNS; i++) {
        const int64_t weighted = t3r_round_shift64((int64_t)d[i] * weight_q8, 8);
        sums->gradient_q4[i] += weighted * difference_q4;
        for (uint32_t j = i; j < T3R_ALIGN_UNKNOWNS; j++) {
            sums->products[at++] += weighted * d[j];
        }
    }
    sums->squares_q8 += t3r_round_shift64((int64_t)difference_q4 * difference_q4 * weight_q8, 8);
}

uint32_t t3r_compare_pair(const t3r_aligned_view *from, const t3r_aligned_view *to, uint32_t stride,
                          const t3r_pair_levels *levels, uint32_t bins[T3R_ALIGN_BINS], t3r_align_sums *of_from,
                          t3r_align_sums *of_to)
{
    const t3r_view *view = from->map.view, *other = to->map.view;
    uint32_t count = 0;
    for (uint32_t v = stride / 2; v < view->height; v += stride) {
        for (uint32_t u = stride / 2; u < view->width; u += stride) {
            const int32_t full_q16[2] = {(int32_t)(u << 16), (int32_t)(v << 16)};
            int32_t here_q16[2], there_q16[2];
            sighting s;
            if (!t3r_is_reliable(view->validity[(size_t)v * view->width + u]) ||
                !place_of(&from->luma, full_q16, here_q16) || !sees(&from->map, u, v, &to->map, &s) ||
                !place_of(&to->luma, s.at_q16, there_q16)) {
                continue;
            }
            const int32_t rise_q8 = luma_q8(&to->luma, there_q16) - luma_q8(&from->luma, here_q16);
            bins[t3r_round_shift32(rise_q8, 8) + (int32_t)T3R_ALIGN_BINS / 2]++;
            count++;
            if (levels->spread == 0) {
                continue;
            }
            int64_t pull_q8[3];
            int32_t d[T3R_ALIGN_UNKNOWNS];
            const int32_t difference_q4 = t3r_round_shift32(rise_q8, 4) - levels->middle * 16;
            const int32_t size_q4 = t3r_abs32(difference_q4), spread_q4 = levels->spread * 16;
            const int32_t weight_q8 = size_q4 <= spread_q4 ? 256 : spread_q4 * 256 / size_q4;
            pull_of(&to->luma, there_q16, &s, other, pull_q8);
            derivatives(&s, pull_q8, view->pose.position_q20, 1, d);
            add(of_from, d, difference_q4, weight_q8);
            derivatives(&s, pull_q8, other->pose.position_q20, -1, d);
            add(of_to, d, difference_q4, weight_q8);
        }
    }
    return count;
}

t3r_pair_levels t3r_levels_of(const uint32_t bins[T3R_ALIGN_BINS], uint32_t count)
{
    const int32_t most = (int32_t)T3R_ALIGN_BINS / 2;
    int32_t middle = -most, spread = 0;
    for (uint32_t below = bins[0]; 2 * below < count; below += bins[middle + most]) {
        middle++;
    }
    /* At least half of the pixels lie on either side, the middle counted with both, so the loop ends within the
     * bins. */
    for (uint32_t within = bins[middle + most]; 2 * within < count;) {
        spread++;
        T3R_BOUND(spread <= most + middle && spread < most - middle);
        within += bins[middle - spread + most] + bins[middle + spread + most];
    }
    return (t3r_pair_levels){(int16_t)middle, (int16_t)(2 * spread + 2)};
}
