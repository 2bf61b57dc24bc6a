/* SPDX-License-Identifier: Apache-2.0 */
/* Projection of a camera in the scene's frame. */
#include "core/camera.h"
#include "core/fixed.h"
#include "core/scene_frame.h"
#include "raster_splat.h"

/* Returns 1.3 times |x / z| at the picture's edge that is farther from the axis, at most T3R_ASIDE. Edges lie half a
 * pixel beyond the centres of the first and the last pixel. side: pixels, at most T3R_MAX_SIDE. */
static int32_t limit_q24(uint32_t side, int32_t centre_q16, int32_t f_q16)
{
    /* |c| < 2^30 and side <= 2^12, so the distances are below 2^31 and the numerator below 2^59 */
    const int32_t before_q16 = centre_q16 + 0x8000, after_q16 = (int32_t)(side << 16) - before_q16;
    const int64_t limit = (int64_t)T3R_MAX(before_q16, after_q16) * (13 << 24) / (10 * (int64_t)f_q16);
    return (int32_t)T3R_MIN(limit, (int64_t)T3R_ASIDE << 24);
}

t3r_status t3r_projection_make(const t3r_camera *camera, const t3r_scene_frame *frame, uint32_t width, uint32_t height,
                               t3r_projection *projection)
{
    t3r_status status = t3r_camera_check(camera, width, height);
    if (status != T3R_OK) {
        return status;
    }
    t3r_pose pose;
    status = t3r_pose_in_scene(camera, frame, &pose);
    if (status != T3R_OK) {
        return status;
    }
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++) {
            projection->world_to_camera_q30[row * 3 + column] = pose.rotation_q30[column * 3 + row];
        }
        projection->centre_q20[row] = pose.position_q20[row];
    }
    projection->fx_q16 = camera->fx_q16;
    projection->fy_q16 = camera->fy_q16;
    projection->cx_q16 = camera->cx_q16;
    projection->cy_q16 = camera->cy_q16;
    projection->limit_x_q24 = limit_q24(width, camera->cx_q16, camera->fx_q16);
    projection->limit_y_q24 = limit_q24(height, camera->cy_q16, camera->fy_q16);
    projection->width = width;
    projection->height = height;
    return T3R_OK;
}
