/* SPDX-License-Identifier: Apache-2.0 */
#include "same_frame.h"

#include "core/fixed.h"
#include "core/scene_frame.h"
#include "scene_scale.h"

#define WITHIN_Q20 (1 << 29) /* 512 scene units */

static bool is_near(const t3r_camera *camera, const t3r_scene_frame *frame)
{
    t3r_pose pose;
    if (t3r_pose_in_scene(camera, frame, &pose) != T3R_OK) {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        if (t3r_abs32(pose.position_q20[i]) > WITHIN_Q20) {
            return false;
        }
    }
    return true;
}

bool t3r_is_in_frame(const t3r_runtime *rt, const t3r_view *views)
{
    const t3r_pointmap_work work = t3r_pointmap_work_of(rt);
    int32_t exponent;
    if (t3r_scene_exponent(views, rt->views, &work, &exponent) != T3R_OK || exponent != rt->frame.exponent) {
        return false;
    }
    for (uint32_t v = 0; v < rt->views; v++) {
        if (!is_near(&rt->camera[v], &rt->frame)) {
            return false;
        }
    }
    return true;
}
