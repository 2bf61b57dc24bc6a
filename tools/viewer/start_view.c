/* SPDX-License-Identifier: Apache-2.0 */
#include "viewer/start_view.h"

#include <math.h>

#include "import/viewpoint.h"
#include "scene/summary/scene_box.h"

#define DEGREES 60 /* horizontal angle */

int start_view(const scene_file *scene, uint32_t width, uint32_t height, t3r_camera *out)
{
    (void)viewpoint_from_angle(DEGREES, width, height, out);
    scene_box box;
    if (scene_box_of(scene, scene->up, &box) != 0) {
        return -1;
    }
    const double wide = box.half[0] * out->fx_q16 / (width << 15);
    const double high = box.half[1] * out->fy_q16 / (height << 15);
    double at[3];
    scene_box_world(&box, scene,
                    (const double[3]){box.middle[0], box.middle[1], box.middle[2] - box.half[2] - fmax(wide, high)},
                    at);
    for (int axis = 0; axis < 3; axis++) {
        out->position_q32[axis] = llround(ldexp(at[axis], 32));
    }
    for (int i = 0; i < 4; i++) {
        const double turned = i == 0 ? box.upright.rotation[0] : -box.upright.rotation[i];
        out->rotation_q30[i] = (int32_t)llround(ldexp(turned, 30));
    }
    return 0;
}
