/* SPDX-License-Identifier: Apache-2.0 */
/* Reads the scene in the arena, or writes one from a file. */
#include "api/checks.h"
#include "core/features.h"
#include "layout/arena.h"
#include "state/state.h"

t3r_status t3r_get_scene(const t3r_runtime *rt, t3r_scene *scene)
{
    T3R_REFUSE_UNLESS(rt != NULL && scene != NULL, T3R_ERR_ARGUMENT);
    if (!rt->has_scene) {
        return T3R_ERR_STATE;
    }
    scene->frame = rt->frame;
    scene->gaussians = t3r_buffer_at(rt, T3R_BUFFER_SCENE);
    scene->count = rt->gaussians;
    scene->valid_points = rt->valid_points;
    return T3R_OK;
}

t3r_status t3r_scene_begin(t3r_runtime *rt, const t3r_scene_frame *frame)
{
    T3R_REFUSE_UNLESS(rt != NULL && frame != NULL, T3R_ERR_ARGUMENT);
    if (!t3r_is_scene_frame(frame)) {
        return T3R_ERR_ARGUMENT;
    }
    T3R_REFUSE_UNLESS(!t3r_is_stream(&rt->config), T3R_ERR_STATE);
    (void)t3r_reset(rt);
    rt->frame = *frame;
    rt->has_scene = 1;
    return T3R_OK;
}

t3r_status t3r_scene_append(t3r_runtime *rt, const t3r_gaussian *gaussian)
{
    T3R_REFUSE_UNLESS(rt != NULL && gaussian != NULL, T3R_ERR_ARGUMENT);
    if (!t3r_is_gaussian(gaussian)) {
        return T3R_ERR_ARGUMENT;
    }
    T3R_REFUSE_UNLESS(rt->has_scene && !t3r_is_stream(&rt->config), T3R_ERR_STATE);
    if (rt->gaussians >= rt->config.max_gaussians) {
        return T3R_ERR_FULL;
    }
    t3r_gaussian *scene = t3r_buffer_at(rt, T3R_BUFFER_SCENE);
    scene[rt->gaussians++] = *gaussian;
    return T3R_OK;
}

uint32_t t3r_render_passes(const t3r_runtime *rt)
{
    return rt == NULL ? 0 : rt->render_passes;
}

uint32_t t3r_refinement_passes(const t3r_runtime *rt)
{
    return rt == NULL ? 0 : rt->passes;
}

t3r_status t3r_view_camera(const t3r_runtime *rt, uint32_t view, t3r_camera *camera)
{
    T3R_REFUSE_UNLESS(rt != NULL && camera != NULL && view < rt->views, T3R_ERR_ARGUMENT);
    *camera = rt->camera[view];
    return T3R_OK;
}
