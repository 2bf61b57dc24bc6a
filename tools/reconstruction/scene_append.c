/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/scene_append.h"

#include "core/scene_frame.h"

static t3r_status append_seen(t3r_runtime *runtime, const scene_file *scene, uint32_t index, const t3r_pose *eye)
{
    t3r_gaussian gaussian = scene->gaussians[index];
    int32_t direction[3];
    for (int axis = 0; axis < 3; axis++) { /* both within 2^30 */
        direction[axis] = gaussian.position_q20[axis] - eye->position_q20[axis];
    }
    t3r_status status =
        t3r_harmonics_colour(scene_file_harmonics(scene, index), scene->degree, direction, gaussian.colour_q7);
    return status == T3R_OK ? t3r_scene_append(runtime, &gaussian) : status;
}

t3r_status scene_append_all(t3r_runtime *runtime, const scene_file *scene, const t3r_camera *eye, uint32_t *index)
{
    t3r_pose pose;
    t3r_status status = t3r_scene_begin(runtime, &scene->frame);
    if (status == T3R_OK && eye != NULL) {
        status = t3r_pose_in_scene(eye, &scene->frame, &pose);
    }
    for (*index = 0; *index < scene->count && status == T3R_OK; ++*index) {
        status = eye == NULL || scene->degree == 0 ? t3r_scene_append(runtime, &scene->gaussians[*index])
                                                   : append_seen(runtime, scene, *index, &pose);
    }
    return status;
}
