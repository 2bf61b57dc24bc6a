/* Projection of a camera in the scene's frame. */
#include "core/camera.h"
#include "core/fixed.h"
#include "core/scene_frame.h"
#include "raster_splat.h"

t3r_status t3r_projection_make(const t3r_camera *camera, const t3r_scene_frame *frame, uint32_t width, uint32_t height,
                               t3r_projection *projection)
{
    t3r_status status = t3r_camera_check(camera);
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
    /* 1.3 (w / 2) / f = 13 w / (20 f), Q24; w < 2^13, so the numerator is below 2^57 */
    int64_t most = (int64_t)T3R_ASIDE << 24;
    projection->limit_x_q24 = (int32_t)T3R_MIN(((int64_t)(13 * width) << 40) / ((int64_t)20 * camera->fx_q16), most);
    projection->limit_y_q24 = (int32_t)T3R_MIN(((int64_t)(13 * height) << 40) / ((int64_t)20 * camera->fy_q16), most);
    projection->width = width;
    projection->height = height;
    return T3R_OK;
}
