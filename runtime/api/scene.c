/* SPDX-License-Identifier: Apache-2.0 */
/* Reads the scene in the arena, or writes one from a file. */
#include "api/scene_checks.h"
#include "core/memory.h"
#include "layout/arena.h"
#include "state/state.h"

t3r_status t3r_get_scene(const t3r_runtime *rt, t3r_scene *scene)
{
    T3R_PASS(t3r_get_scene_checks(rt, scene, NULL));
    scene->frame = rt->frame;
    scene->gaussians = t3r_buffer_at(rt, T3R_BUFFER_SCENE);
    scene->count = rt->gaussians;
    scene->valid_points = rt->valid_points;
    return T3R_OK;
}

t3r_status t3r_scene_begin(t3r_runtime *rt, const t3r_scene_frame *frame)
{
    T3R_PASS(t3r_scene_begin_checks(rt, frame, NULL));
    (void)t3r_reset(rt);
    rt->frame = *frame;
    rt->has_scene = 1;
    return T3R_OK;
}

t3r_status t3r_scene_append(t3r_runtime *rt, const t3r_gaussian *gaussian)
{
    T3R_PASS(t3r_scene_append_checks(rt, gaussian, NULL));
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
    T3R_PASS(t3r_view_camera_checks(rt, view, camera, NULL));
    *camera = rt->camera[view];
    return T3R_OK;
}

t3r_status t3r_view_gain(const t3r_runtime *rt, uint32_t view, uint16_t gain_q14[3])
{
    T3R_PASS(t3r_view_gain_checks(rt, view, gain_q14, NULL));
    memcpy(gain_q14, rt->gain_q14[view], sizeof rt->gain_q14[view]);
    return T3R_OK;
}
