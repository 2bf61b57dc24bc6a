#include "scene/splat_camera.h"

#include <math.h>

#include "geometry/quaternion.h"

splat_camera splat_camera_of(const t3r_camera *camera, const t3r_scene_frame *frame, uint32_t width, uint32_t height)
{
    splat_camera c = {
        .width = width,
        .height = height,
        .fx = ldexp(camera->fx_q16, -16),
        .fy = ldexp(camera->fy_q16, -16),
        .cx = ldexp(camera->cx_q16, -16),
        .cy = ldexp(camera->cy_q16, -16),
    };
    double q[4];
    for (int i = 0; i < 4; i++) {
        q[i] = camera->rotation_q30[i];
    }
    quaternion_normalise(q);
    quaternion_matrix(q, c.rotation);
    for (int i = 0; i < 3; i++) {
        /* subtracts in integers, because doubles would lose bits far from the world's origin; both below 2^62 */
        c.position[i] = ldexp((double)(camera->position_q32[i] - frame->origin_q32[i]), -32 - frame->exponent);
    }
    return c;
}
