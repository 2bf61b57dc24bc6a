/* SPDX-License-Identifier: Apache-2.0 */
#include "fitted_widths.h"

#include "core/fixed.h"
#include "pointmap/reproject.h"

#define LOG_GAIN_Q16 13214             /* log2 of 1.15, the gain where no other view counts */
#define POWER_Q10 614                  /* 0.6 */
#define LOG_RATIO_MOST_Q16 (8 * 65536) /* bound of another view's density, far beyond any visible effect */

/* Returns log2 of the area of a pixel, (z / f)^2, Q16, up to a constant. z >= 1; twice f in Q8 is below 2^23. */
static int32_t log_area_q16(const t3r_view *view, int32_t z_q20)
{
    const int64_t twice_f_q8 = ((int64_t)view->fx_q16 + view->fy_q16) >> 8;
    return 2 * (t3r_log2_q16((uint32_t)z_q20) - t3r_log2_q16((uint32_t)twice_f_q8));
}

/* Whether a view shows the surface of a point at a pixel. */
static bool covers(const t3r_head_input *input, const t3r_view *other, const t3r_projected_pixel *projected)
{
    const size_t pixel = projected->pixel;
    if (!t3r_has_depth(other->validity[pixel]) || t3r_is_deferred(other, pixel, input->settings)) {
        return false;
    }
    const t3r_depth_scale scale = t3r_depth_scale_of(other->depth_unit_q40, input->covering->exponent);
    const int32_t there_q20 = t3r_depth_q20(scale, other->depth[pixel]);
    return t3r_is_one_surface(projected->z_q20, there_q20, 8);
}

/* Returns the density of the retained points of all views about a pixel over that of its own view: Q16, at most 2^16 +
 * 15 x 2^24. */
static uint32_t density_ratio_q16(const t3r_head_input *input, uint32_t u, uint32_t v)
{
    const t3r_view *own = input->map.view;
    const size_t pixel = (size_t)v * own->width + u;
    const int32_t z_q20 = T3R_MAX(t3r_depth_q20(input->map.scale, own->depth[pixel]), 1);
    const int32_t own_q16 = t3r_log_density_q10(own, pixel, input->settings, input->clusters) * 64;
    int32_t point_q20[3];
    (void)t3r_point(&input->map, u, v, point_q20);
    uint32_t ratio_q16 = 1 << 16;
    for (uint32_t w = 0; w < input->covering->count; w++) {
        const t3r_view *other = &input->covering->views[w];
        t3r_projected_pixel projected;
        if (w == input->view_index || !t3r_project_to_pixel(other, point_q20, &projected) ||
            !covers(input, other, &projected)) {
            continue;
        }
        const int32_t other_q16 = t3r_log_density_q10(other, projected.pixel, input->settings, input->clusters) * 64;
        const int32_t log_ratio_q16 =
            other_q16 - own_q16 + log_area_q16(own, z_q20) - log_area_q16(other, projected.z_q20);
        ratio_q16 += t3r_exp2_q16(t3r_clamp32(log_ratio_q16, -LOG_RATIO_MOST_Q16, LOG_RATIO_MOST_Q16));
    }
    return ratio_q16;
}

int32_t t3r_mean_density_q10(const t3r_budget_settings *settings, const t3r_cluster *clusters)
{
    uint32_t points = 0; /* at most 2^28 */
    for (uint32_t k = 0; k < settings->clusters; k++) {
        points += clusters[k].points - T3R_MIN(clusters[k].deferred, clusters[k].points);
    }
    if (settings->gaussians == 0 || settings->gaussians >= points) {
        return 0;
    }
    return t3r_round_shift32(t3r_log2_q16(settings->gaussians) - t3r_log2_q16(points), 6);
}

/* Scales an entry of a covariance: it stays below 2^23, and the gain below 8. */
static int32_t scaled(int32_t x_q12, uint32_t gain_q16)
{
    return (int32_t)t3r_round_shift64((int64_t)x_q12 * gain_q16, 16);
}

void t3r_fit_widths(const t3r_head_input *input, uint32_t u, uint32_t v, t3r_footprint *footprint)
{
    const int32_t log_ratio_q16 = t3r_log2_q16(density_ratio_q16(input, u, v)) - 16 * 65536; /* below 2^20 */
    const size_t pixel = (size_t)v * input->map.view->width + u;
    const int32_t density_q10 = t3r_log_density_q10(input->map.view, pixel, input->settings, input->clusters);
    /* a quarter of it, Q10 to Q16 */
    const int32_t log_sparseness_q16 = (input->covering->mean_density_q10 - density_q10) * 16;
    const uint32_t gain_q16 =
        t3r_exp2_q16(LOG_GAIN_Q16 + log_sparseness_q16 - t3r_round_shift32(log_ratio_q16 * POWER_Q10, 10));
    footprint->xx_q12 = scaled(footprint->xx_q12, gain_q16);
    footprint->xy_q12 = scaled(footprint->xy_q12, gain_q16);
    footprint->yy_q12 = scaled(footprint->yy_q12, gain_q16);
}
