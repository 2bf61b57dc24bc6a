#include "scene/splat_camera.h"

#include <math.h>
#include <string.h>

void splat_rotation(const double q[4], double r[9])
{
    double norm = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    double w = q[0] / norm, x = q[1] / norm, y = q[2] / norm, z = q[3] / norm;
    const double m[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                         2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                         2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    memcpy(r, m, sizeof m);
}

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
    splat_rotation(q, c.rotation);
    for (int i = 0; i < 3; i++) {
        /* subtracts in integers, because doubles would lose bits far from the world's origin; both below 2^62 */
        c.position[i] = ldexp((double)(camera->position_q32[i] - frame->origin_q32[i]), -32 - frame->exponent);
    }
    return c;
}
