/* SPDX-License-Identifier: Apache-2.0 */
#include "kernels/points.h"

#include "core/fixed.h"
#include "kernels/points_parts.h"

void t3r_unproject_c(const t3r_unprojection *restrict from, t3r_points *restrict points)
{
    const t3r_pinhole *view = &from->view;
    for (uint32_t i = 0; i < points->count; i++) {
        const int32_t ray_q24[2] = {t3r_ray_along_q24(points->u[i], view->cx_q16, from->inverse_fx_q32),
                                    t3r_ray_along_q24(points->v[i], view->cy_q16, from->inverse_fy_q32)};
        int32_t point_q20[3];
        t3r_point_along(&view->pose, ray_q24, t3r_depth_q20(from->scale, points->depth[i]), point_q20);
        for (int k = 0; k < 3; k++) {
            points->point_q20[k][i] = point_q20[k];
        }
    }
}

/* Returns the pixel coordinate f x / z + c, rounded to the nearest: |x| <= 16 z, z < 2^31. */
static int64_t place(int64_t x, int64_t z, int32_t focal_q16, int32_t centre_q16)
{
    const int64_t ratio_q24 = t3r_round_div64(x * (1 << 24), z);
    return t3r_round_shift64(t3r_round_shift64(ratio_q24 * focal_q16, 24) + centre_q16, 16); /* 2^28 x 2^30 */
}

/* Computes place() by a reciprocal of z, z 2^shift = 2^62 / rn: x 2^shift is at most 2^36, 1/32 of it below 2^31. */
static int64_t place_by(int64_t x, int64_t z, uint32_t shift, int64_t rn, int32_t focal_q16, int32_t centre_q16)
{
    const int64_t ratio_q25 = ((x * ((int64_t)1 << shift) >> 5) * rn) >> 32;
    const int64_t at_q16 = ((ratio_q25 * focal_q16) >> 25) + centre_q16 + (1 << 15);
    return t3r_is_between(at_q16, focal_q16) ? at_q16 >> 16 : place(x, z, focal_q16, centre_q16);
}

uint32_t t3r_locate_point(const t3r_pinhole *view, const int32_t point_q20[3], int32_t *z_q20)
{
    const int32_t *r_q30 = view->pose.rotation_q30;
    int64_t offset[3], camera[3];
    for (int i = 0; i < 3; i++) {
        offset[i] = (int64_t)point_q20[i] - view->pose.position_q20[i];
    }
    for (int i = 0; i < 3; i++) {
        /* R^T offset: |offset| <= 2^31 sqrt 3, so that every partial sum stays below 2^62 */
        camera[i] = t3r_round_shift64(r_q30[i] * offset[0] + r_q30[3 + i] * offset[1] + r_q30[6 + i] * offset[2], 30);
    }
    const int64_t z = camera[2];
    *z_q20 = (int32_t)z;
    if (z < T3R_NEAREST_Q20 || z > INT32_MAX || t3r_abs64(camera[0]) > 16 * z || t3r_abs64(camera[1]) > 16 * z) {
        return T3R_NO_PIXEL;
    }
    const uint32_t shift = 31 - t3r_msb32((uint32_t)z);
    const int64_t rn = (int64_t)((UINT64_C(1) << 62) / ((uint32_t)z << shift));
    const int64_t column = place_by(camera[0], z, shift, rn, view->fx_q16, view->cx_q16);
    const int64_t row = place_by(camera[1], z, shift, rn, view->fy_q16, view->cy_q16);
    if (column < 0 || row < 0 || column >= view->width || row >= view->height) {
        return T3R_NO_PIXEL;
    }
    return (uint32_t)row * view->width + (uint32_t)column;
}

void t3r_locate_c(const t3r_pinhole *restrict view, const t3r_points *restrict points, t3r_places *restrict places)
{
    for (uint32_t i = 0; i < points->count; i++) {
        const int32_t point[3] = {points->point_q20[0][i], points->point_q20[1][i], points->point_q20[2][i]};
        places->pixel[i] = t3r_locate_point(view, point, &places->z_q20[i]);
    }
}
