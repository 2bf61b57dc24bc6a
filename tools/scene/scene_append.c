/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_append.h"

static seen_traits traits_of(const scene_file *scene)
{
    return (seen_traits){.degree = scene->degree,
                         .mip = scene->mip,
                         .is_spread = scene->finer > 0 || scene->far_count > 0,
                         .finer = scene->finer};
}

seen_from scene_seen_from(const scene_file *scene, const scene_eye *eye)
{
    const seen_traits traits = traits_of(scene);
    seen_from from;
    seen_from_camera(eye->camera, &scene->frame, &traits, eye->width, eye->height, &from);
    return from;
}

bool scene_differs(const scene_file *scene, const seen_from *from)
{
    const seen_traits traits = traits_of(scene);
    return seen_differs(&traits, from);
}

/* Appends the Gaussians as a camera sees them. */
static t3r_status append_seen(t3r_runtime *runtime, const scene_file *scene, const seen_from *from, uint32_t *index)
{
    const seen_traits traits = traits_of(scene);
    uint32_t far = 0;
    t3r_status status = t3r_scene_begin(runtime, &from->frame);
    for (*index = 0; *index < scene->count && status == T3R_OK; ++*index) {
        t3r_gaussian gaussian = scene->gaussians[*index];
        const bool is_far = far < scene->far_count && scene->far[far].index == *index;
        const double times = is_far ? scene->far[far++].times : 1;
        status = seen_gaussian(&traits, times, scene->degree > 0 ? scene_file_harmonics(scene, *index) : NULL, from,
                               &gaussian);
        status = status == T3R_OK ? t3r_scene_append(runtime, &gaussian) : status;
    }
    return status;
}

t3r_status scene_append_all(t3r_runtime *runtime, const scene_file *scene, const scene_eye *eye, uint32_t *index)
{
    if (eye != NULL) {
        const seen_from from = scene_seen_from(scene, eye);
        if (scene_differs(scene, &from)) {
            return append_seen(runtime, scene, &from, index);
        }
    }
    t3r_status status = t3r_scene_begin(runtime, &scene->frame);
    for (*index = 0; *index < scene->count && status == T3R_OK; ++*index) {
        status = t3r_scene_append(runtime, &scene->gaussians[*index]);
    }
    return status;
}
