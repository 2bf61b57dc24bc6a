/* SPDX-License-Identifier: Apache-2.0 */
/* Sentences about errors of calls that build, read, write and draw a scene. */
#include "api/build_checks.h"
#include "api/scene_checks.h"
#include "sentence.h"

/* Writes the sentence of an error that the analysis finds in views that passed the checks. */
static t3r_status analysed(t3r_status status, const t3r_runtime *rt, t3r_fault *fault)
{
    if (T3R_FEATURE_STEREO && status == T3R_ERR_STEREO) {
        uint32_t partner;
        const t3r_pair pair = t3r_stereo_pair(rt, 0, &partner);
        t3r_note(fault, "no two views give depth; the most promising pair of view 0 is with view #: ", partner, 0, 0,
                 0);
        fault->after = t3r_pair_text(pair);
        return status;
    }
    for (uint32_t v = 0; status == T3R_ERR_CAMERA && v < rt->views; v++) {
        t3r_pose pose;
        T3R_CHECK(fault, t3r_pose_in_scene(&rt->camera[v], &rt->frame, &pose) == T3R_OK, T3R_ERR_CAMERA,
                  "the camera of view # is more than 1,024 scene units, of 2^# world units, from that of view 0", v,
                  rt->frame.exponent);
    }
    return T3R_OK;
}

const char *t3r_reconstruct_error(t3r_status status, const t3r_runtime *rt, const t3r_request *request,
                                  const t3r_scene *scene, char *text, size_t text_bytes)
{
    t3r_fault fault;
    t3r_build_order order;
    const t3r_status found = t3r_reconstruct_checks(rt, request, scene, &order, &fault);
    return t3r_sentence(status, found == T3R_OK ? analysed(status, rt, &fault) : found, &fault, text, text_bytes);
}

const char *t3r_rebuild_error(t3r_status status, const t3r_runtime *rt, const t3r_request *request,
                              const t3r_scene *scene, char *text, size_t text_bytes)
{
    t3r_fault fault;
    t3r_build_order order;
    const t3r_status found = t3r_rebuild_checks(rt, request, scene, &order, &fault);
    return t3r_sentence(status, found, &fault, text, text_bytes);
}

/* Checks the rebuilds and the pictures of t3r_rebuild_least(), which chooses the number of Gaussians itself. */
static t3r_status searched(const t3r_runtime *rt, const t3r_request *request, const t3r_target *picture,
                           const t3r_scene *scene, t3r_fault *fault)
{
    t3r_request tried = request != NULL ? *request : (t3r_request){0};
    t3r_build_order order;
    tried.gaussians = 1;
    T3R_PASS(t3r_rebuild_checks(rt, &tried, scene, &order, fault));
    return t3r_target_checks(rt, picture, fault);
}

const char *t3r_rebuild_least_error(t3r_status status, const t3r_runtime *rt, const t3r_request *request,
                                    uint32_t least_psnr_q8, const t3r_target *picture, const t3r_scene *scene,
                                    const t3r_least *found, char *text, size_t text_bytes)
{
    t3r_fault fault;
    t3r_status refused = t3r_least_checks(rt, request, least_psnr_q8, picture, scene, found, &fault);
    refused = refused == T3R_OK ? searched(rt, request, picture, scene, &fault) : refused;
    return t3r_sentence(status, refused, &fault, text, text_bytes);
}

const char *t3r_get_scene_error(t3r_status status, const t3r_runtime *rt, const t3r_scene *scene, char *text,
                                size_t text_bytes)
{
    t3r_fault fault;
    return t3r_sentence(status, t3r_get_scene_checks(rt, scene, &fault), &fault, text, text_bytes);
}

const char *t3r_scene_begin_error(t3r_status status, const t3r_runtime *rt, const t3r_scene_frame *frame, char *text,
                                  size_t text_bytes)
{
    t3r_fault fault;
    return t3r_sentence(status, t3r_scene_begin_checks(rt, frame, &fault), &fault, text, text_bytes);
}

const char *t3r_scene_append_error(t3r_status status, const t3r_runtime *rt, const t3r_gaussian *gaussian, char *text,
                                   size_t text_bytes)
{
    t3r_fault fault;
    return t3r_sentence(status, t3r_scene_append_checks(rt, gaussian, &fault), &fault, text, text_bytes);
}

const char *t3r_render_error(t3r_status status, const t3r_runtime *rt, const t3r_camera *camera,
                             const t3r_target *target, char *text, size_t text_bytes)
{
    t3r_fault fault;
    t3r_projection projection;
    return t3r_sentence(status, t3r_render_checks(rt, camera, target, &projection, &fault), &fault, text, text_bytes);
}

const char *t3r_view_camera_error(t3r_status status, const t3r_runtime *rt, uint32_t view, const t3r_camera *camera,
                                  char *text, size_t text_bytes)
{
    t3r_fault fault;
    return t3r_sentence(status, t3r_view_camera_checks(rt, view, camera, &fault), &fault, text, text_bytes);
}

const char *t3r_view_gain_error(t3r_status status, const t3r_runtime *rt, uint32_t view, const uint16_t gain_q14[3],
                                char *text, size_t text_bytes)
{
    t3r_fault fault;
    return t3r_sentence(status, t3r_view_gain_checks(rt, view, gain_q14, &fault), &fault, text, text_bytes);
}
