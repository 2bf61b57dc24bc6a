#include "reproject.h"

#include "core/fixed.h"

#define NEAREST_Q20 (1 << 15) /* 1/32 scene unit, as the raster has it */

/* The pixel coordinate f x / z + c, to the nearest: |x| < 2^33, x / z at most 16. */
static int64_t place(int64_t x, int64_t z, int32_t focal_q16, int32_t centre_q16)
{
    int64_t ratio_q24 = t3r_round_div64(x * (1 << 24), z);
    return t3r_round_shift64(t3r_round_shift64(ratio_q24 * focal_q16, 24) + centre_q16, 16); /* 2^28 x 2^30 */
}

bool t3r_project_to_pixel(const t3r_view *view, const int32_t point[3], t3r_projected_pixel *projected)
{
    const int32_t *r_q30 = view->pose.rotation_q30;
    int64_t offset[3], camera[3];
    for (int i = 0; i < 3; i++) {
        offset[i] = (int64_t)point[i] - view->pose.position_q20[i];
    }
    for (int i = 0; i < 3; i++) {
        /* R^T offset: |offset| <= 2^31 sqrt 3, so that every partial sum stays below 2^62 */
        camera[i] = t3r_round_shift64(r_q30[i] * offset[0] + r_q30[3 + i] * offset[1] + r_q30[6 + i] * offset[2], 30);
    }
    int64_t z = camera[2];
    if (z < NEAREST_Q20 || z > INT32_MAX || t3r_abs64(camera[0]) > 16 * z || t3r_abs64(camera[1]) > 16 * z) {
        return false;
    }
    int64_t column = place(camera[0], z, view->fx_q16, view->cx_q16);
    int64_t row = place(camera[1], z, view->fy_q16, view->cy_q16);
    if (column < 0 || row < 0 || column >= view->width || row >= view->height) {
        return false;
    }
    projected->pixel = (size_t)row * view->width + (size_t)column;
    projected->z_q20 = (int32_t)z;
    return true;
}

bool t3r_reproject(const t3r_pointmap *from, uint32_t u, uint32_t v, const t3r_pointmap *to,
                   t3r_projected_pixel *projected)
{
    int32_t point[3];
    return t3r_point(from, u, v, point) && t3r_project_to_pixel(to->view, point, projected);
}
