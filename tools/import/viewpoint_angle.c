/* SPDX-License-Identifier: Apache-2.0 */
#include <math.h>

#include "core/camera.h"
#include "import/viewpoint.h"

int viewpoint_from_angle(double degrees, uint32_t width, uint32_t height, t3r_camera *out)
{
    const double focal = width / 2.0 / tan(degrees * M_PI / 360);
    *out = (t3r_camera){.width = width, .height = height, .rotation_q30 = {1 << 30, 0, 0, 0}};
    out->fx_q16 = out->fy_q16 = (int32_t)nearbyint(fmin(ldexp(focal, 16), INT32_MAX));
    out->cx_q16 = (int32_t)(width - 1) << 15;
    out->cy_q16 = (int32_t)(height - 1) << 15;
    return t3r_camera_check(out, width, height) == T3R_OK ? 0 : -1;
}
