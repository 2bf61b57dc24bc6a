/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/scene_append.h"

#include "core/scene_frame.h"
#include "scene/mip_opacity.h"

/* A viewpoint in the frame of the scene. */
typedef struct viewer {
    t3r_pose pose;
    splat_camera camera;
} viewer;

static t3r_status append_seen(t3r_runtime *runtime, const scene_file *scene, uint32_t index, const viewer *eye)
{
    t3r_gaussian gaussian = scene->gaussians[index];
    int32_t direction[3];
    t3r_status status = T3R_OK;
    for (int axis = 0; axis < 3; axis++) { /* both within 2^30 */
        direction[axis] = gaussian.position_q20[axis] - eye->pose.position_q20[axis];
    }
    if (scene->mip) {
        gaussian.opacity_q15 = mip_opacity_q15(&gaussian, &eye->camera);
    }
    if (scene->degree > 0) {
        status = t3r_harmonics_colour(scene_file_harmonics(scene, index), scene->degree, direction, gaussian.colour_q7);
    }
    return status == T3R_OK ? t3r_scene_append(runtime, &gaussian) : status;
}

t3r_status scene_append_all(t3r_runtime *runtime, const scene_file *scene, const scene_eye *eye, uint32_t *index)
{
    viewer seen;
    t3r_status status = t3r_scene_begin(runtime, &scene->frame);
    if (status == T3R_OK && eye != NULL) {
        status = t3r_pose_in_scene(eye->camera, &scene->frame, &seen.pose);
        seen.camera = splat_camera_of(eye->camera, &scene->frame, eye->width, eye->height);
    }
    for (*index = 0; *index < scene->count && status == T3R_OK; ++*index) {
        status = eye == NULL || !scene_file_depends_on_view(scene)
                     ? t3r_scene_append(runtime, &scene->gaussians[*index])
                     : append_seen(runtime, scene, *index, &seen);
    }
    return status;
}
