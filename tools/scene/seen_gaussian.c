/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/seen_gaussian.h"

#include "geometry/power_of_two.h"

#define WIDENED 0.3 /* square pixels that the rasterizer adds; runtime/SPEC.md, "Raster" */
#define HELD 1.3    /* bound of the Jacobian over the tangent to the picture's farther edge, as there */

/* Returns the bound of the slope for which a Gaussian's shape is projected. */
static double limit_of(double pixels, int32_t centre_q16, int32_t focal_q16)
{
    const double before = centre_q16 * 0x1p-16 + 0.5, after = pixels - before; /* from the axis to the edges */
    return HELD * (before > after ? before : after) / (focal_q16 * 0x1p-16);
}

void seen_from_camera(const t3r_camera *camera, const t3r_scene_frame *frame, const seen_traits *traits, uint32_t width,
                      uint32_t height, seen_from *out)
{
    *out = (seen_from){.camera = *camera, .width = width, .height = height, .frame = *frame};
    out->is_own = t3r_pose_in_scene(camera, frame, &out->pose) != T3R_OK || traits->is_spread;
    if (out->is_own) {
        const double limit[2] = {limit_of(width, camera->cx_q16, camera->fx_q16),
                                 limit_of(height, camera->cy_q16, camera->fy_q16)};
        view_frame_of(camera, frame, traits->finer, limit, &out->view);
        out->frame = out->view.frame;
        out->pose = out->view.pose;
    }
}

static double held(double slope, double most)
{
    return slope > most ? most : slope < -most ? -most : slope;
}

/* Writes pixels per unit along the columns of the Gaussian's factor, of x or y in the picture. */
static void project_factor(const t3r_gaussian *gaussian, const double row[3], double out[3])
{
    const double unit = power_of_two(gaussian->factor_exponent);
    for (int column = 0; column < 3; column++) {
        out[column] = 0;
        for (int k = 0; k < 3; k++) {
            out[column] += row[k] * gaussian->factor[3 * k + column] * unit;
        }
    }
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Returns the opacity times the root of the ratio of the determinants in the picture without and with what the
 * rasterizer adds. */
static uint16_t mip_opacity_q15(const t3r_gaussian *gaussian, const seen_from *from)
{
    double seen[3], r[9], row[2][3], t[2][3];
    for (int i = 0; i < 9; i++) {
        r[i] = from->pose.rotation_q30[i] * 0x1p-30; /* camera to scene */
    }
    for (int i = 0; i < 3; i++) {
        seen[i] = 0;
        for (int k = 0; k < 3; k++) {
            seen[i] +=
                r[3 * k + i] * 0x1p-20 * ((double)gaussian->position_q20[k] - (double)from->pose.position_q20[k]);
        }
    }
    if (!(seen[2] > 0)) {
        return gaussian->opacity_q15; /* it is not drawn */
    }
    const double fx = from->camera.fx_q16 * 0x1p-16, fy = from->camera.fy_q16 * 0x1p-16;
    const double u = held(seen[0] / seen[2], limit_of(from->width, from->camera.cx_q16, from->camera.fx_q16)),
                 v = held(seen[1] / seen[2], limit_of(from->height, from->camera.cy_q16, from->camera.fy_q16));
    for (int k = 0; k < 3; k++) { /* pixels a scene unit along each axis of the scene */
        row[0][k] = fx / seen[2] * (r[3 * k] - u * r[3 * k + 2]);
        row[1][k] = fy / seen[2] * (r[3 * k + 1] - v * r[3 * k + 2]);
    }
    project_factor(gaussian, row[0], t[0]);
    project_factor(gaussian, row[1], t[1]);
    const double a = dot(t[0], t[0]), b = dot(t[0], t[1]), c = dot(t[1], t[1]);
    const double ratio = (a * c - b * b) / ((a + WIDENED) * (c + WIDENED) - b * b);
    return (uint16_t)(gaussian->opacity_q15 * __builtin_sqrt(ratio > 0 ? ratio : 0) + 0.5);
}

t3r_status seen_gaussian(const seen_traits *traits, double times, const int16_t *harmonics_q12, const seen_from *from,
                         t3r_gaussian *gaussian)
{
    int32_t direction[3];
    if (from->is_own) {
        view_frame_place(&from->view, times, gaussian);
    }
    for (int axis = 0; axis < 3; axis++) { /* both within 2^30 */
        direction[axis] = gaussian->position_q20[axis] - from->pose.position_q20[axis];
    }
    if (traits->mip) {
        gaussian->opacity_q15 = mip_opacity_q15(gaussian, from);
    }
    return traits->degree == 0 ? T3R_OK
                               : t3r_harmonics_colour(harmonics_q12, traits->degree, direction, gaussian->colour_q7);
}
