/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_append.h"

#include "scene/seen_gaussian.h"

t3r_status scene_append_all(t3r_runtime *runtime, const scene_file *scene, const scene_eye *eye, uint32_t *index)
{
    const seen_traits traits = {.degree = scene->degree, .mip = scene->mip};
    const bool depends = eye != NULL && scene_file_depends_on_view(scene);
    seen_from from;
    t3r_status status = t3r_scene_begin(runtime, &scene->frame);
    if (status == T3R_OK && depends) {
        status = seen_from_camera(eye->camera, &scene->frame, eye->width, eye->height, &from);
    }
    for (*index = 0; *index < scene->count && status == T3R_OK; ++*index) {
        t3r_gaussian gaussian = scene->gaussians[*index];
        if (depends) {
            status = seen_gaussian(&traits, scene->degree > 0 ? scene_file_harmonics(scene, *index) : NULL, &from,
                                   &gaussian);
        }
        status = status == T3R_OK ? t3r_scene_append(runtime, &gaussian) : status;
    }
    return status;
}
