/* SPDX-License-Identifier: Apache-2.0 */
/* The checks of calls that read, write and draw the scene. */
#ifndef T3R_SCENE_CHECKS_H
#define T3R_SCENE_CHECKS_H

#include <stdbool.h>

#include "checks.h"
#include "core/camera.h"
#include "raster/raster_splat.h"

/* Returns the sentence for a runtime without a scene. */
static inline const char *t3r_no_scene_text(const t3r_runtime *rt)
{
    return t3r_is_stream(&rt->config) ? "there is no scene: call t3r_stream_keyframe() first"
           : rt->views > 0
               ? "there is no scene: call t3r_reconstruct() first"
               : "there is no scene: call t3r_add_view() and t3r_reconstruct(), or t3r_scene_begin(), first";
}

T3R_CHECKS t3r_get_scene_checks(const t3r_runtime *rt, const t3r_scene *scene, t3r_fault *fault)
{
    T3R_PASS(t3r_runtime_checks(rt, fault));
    T3R_MISUSE(fault, scene != NULL, T3R_ERR_ARGUMENT, "scene is NULL");
    T3R_CHECK(fault, rt->has_scene, T3R_ERR_STATE, t3r_no_scene_text(rt));
    return T3R_OK;
}

#define T3R_STREAMS_SCENE_TEXT "this runtime is a stream's: only t3r_stream_keyframe() changes its scene"

T3R_CHECKS t3r_scene_begin_checks(const t3r_runtime *rt, const t3r_scene_frame *frame, t3r_fault *fault)
{
    T3R_PASS(t3r_runtime_checks(rt, fault));
    T3R_MISUSE(fault, frame != NULL, T3R_ERR_ARGUMENT, "frame is NULL");
    T3R_PASS(fault == NULL ? (t3r_is_scene_frame(frame) ? T3R_OK : T3R_ERR_ARGUMENT)
                           : t3r_scene_frame_checks(frame, fault));
    T3R_MISUSE(fault, !t3r_is_stream(&rt->config), T3R_ERR_STATE, T3R_STREAMS_SCENE_TEXT);
    return T3R_OK;
}

T3R_CHECKS t3r_scene_append_checks(const t3r_runtime *rt, const t3r_gaussian *gaussian, t3r_fault *fault)
{
    T3R_PASS(t3r_runtime_checks(rt, fault));
    T3R_MISUSE(fault, gaussian != NULL, T3R_ERR_ARGUMENT, "gaussian is NULL");
    T3R_PASS(fault == NULL ? (t3r_is_gaussian(gaussian) ? T3R_OK : T3R_ERR_ARGUMENT)
                           : t3r_gaussian_checks(gaussian, fault));
    T3R_MISUSE(fault, rt->has_scene && !t3r_is_stream(&rt->config), T3R_ERR_STATE,
               t3r_is_stream(&rt->config) ? T3R_STREAMS_SCENE_TEXT
                                          : "there is no scene to append to: call t3r_scene_begin() first");
    T3R_CHECK(fault, rt->gaussians < rt->config.max_gaussians, T3R_ERR_FULL,
              "the scene has # Gaussians, and no room for another: config.max_gaussians is #", rt->gaussians,
              rt->config.max_gaussians);
    return T3R_OK;
}

/* `null_text`: what is wrong if `result` is NULL. */
T3R_CHECKS t3r_view_checks(const t3r_runtime *rt, uint32_t view, const void *result, const char *null_text,
                           t3r_fault *fault)
{
    T3R_PASS(t3r_runtime_checks(rt, fault));
    T3R_MISUSE(fault, result != NULL, T3R_ERR_ARGUMENT, null_text);
    T3R_MISUSE(fault, view < rt->views, T3R_ERR_ARGUMENT, "view is @: there are # views, counted from 0", view,
               rt->views);
    return T3R_OK;
}

T3R_CHECKS t3r_view_camera_checks(const t3r_runtime *rt, uint32_t view, const t3r_camera *camera, t3r_fault *fault)
{
    return t3r_view_checks(rt, view, camera, "camera is NULL", fault);
}

T3R_CHECKS t3r_view_gain_checks(const t3r_runtime *rt, uint32_t view, const uint16_t gain_q14[3], t3r_fault *fault)
{
    return t3r_view_checks(rt, view, gain_q14, "gain_q14 is NULL", fault);
}

/* --- targets -------------------------------------------------------------------------------------------------- */

/* Whether `row_bytes` of all rows can be written there, aligned for their type. NULL: not requested. */
T3R_CONDITION t3r_is_plane(const void *plane, size_t element_bytes, uint32_t row_bytes, uint32_t stride_bytes)
{
    return plane == NULL ||
           ((uintptr_t)plane % element_bytes == 0 && stride_bytes % element_bytes == 0 && stride_bytes >= row_bytes);
}

#define T3R_TARGET_STRIDE_TEXT_(field)                                                                                 \
    "target." field " is @: a stride is in bytes, not in pixels, at least the # of a row"
#define T3R_TARGET_PLANE_TEXT_(field) "target." field " is not aligned to its type"

T3R_CHECKS t3r_target_checks(const t3r_runtime *rt, const t3r_target *t, t3r_fault *fault)
{
    T3R_CHECK(fault, t->width >= 1 && t->width <= rt->config.render_width, T3R_ERR_ARGUMENT,
              "target.width is @: a target is 1..# pixels wide, which is config.render_width", t->width,
              rt->config.render_width);
    T3R_CHECK(fault, t->height >= 1 && t->height <= rt->config.render_height, T3R_ERR_ARGUMENT,
              "target.height is @: a target is 1..# pixels high, which is config.render_height", t->height,
              rt->config.render_height);
    T3R_CHECK(fault, t3r_is_plane(t->rgb, sizeof *t->rgb, 3 * t->width, t->rgb_stride_bytes), T3R_ERR_ARGUMENT,
              T3R_TARGET_STRIDE_TEXT_("rgb_stride_bytes"), t->rgb_stride_bytes, 3 * t->width);
    T3R_CHECK(fault, t3r_is_plane(t->depth_q20, sizeof *t->depth_q20, 4 * t->width, t->depth_stride_bytes),
              T3R_ERR_ARGUMENT,
              (uintptr_t)t->depth_q20 % sizeof *t->depth_q20 != 0
                  ? T3R_TARGET_PLANE_TEXT_("depth_q20")
                  : T3R_TARGET_STRIDE_TEXT_("depth_stride_bytes") ", and a multiple of 4",
              t->depth_stride_bytes, 4 * t->width);
    T3R_CHECK(fault, t3r_is_plane(t->alpha_q15, sizeof *t->alpha_q15, 2 * t->width, t->alpha_stride_bytes),
              T3R_ERR_ARGUMENT,
              (uintptr_t)t->alpha_q15 % sizeof *t->alpha_q15 != 0
                  ? T3R_TARGET_PLANE_TEXT_("alpha_q15")
                  : T3R_TARGET_STRIDE_TEXT_("alpha_stride_bytes") ", and even",
              t->alpha_stride_bytes, 2 * t->width);
    return T3R_OK;
}

T3R_CHECKS t3r_render_checks(const t3r_runtime *rt, const t3r_camera *camera, const t3r_target *target,
                             t3r_projection *projection, t3r_fault *fault)
{
    T3R_PASS(t3r_runtime_checks(rt, fault));
    T3R_MISUSE(fault, camera != NULL, T3R_ERR_ARGUMENT, "camera is NULL");
    T3R_MISUSE(fault, target != NULL, T3R_ERR_ARGUMENT, "target is NULL");
    T3R_MISUSE(fault, rt->has_scene, T3R_ERR_STATE, t3r_no_scene_text(rt));
    T3R_PASS(t3r_target_checks(rt, target, fault));
    T3R_CHECK(fault, camera->distortion == T3R_DISTORTION_NONE, T3R_ERR_CAMERA,
              "camera.distortion is @: pictures are drawn without distortion, as T3R_DISTORTION_NONE",
              camera->distortion);
    if (fault == NULL) {
        return t3r_projection_make(camera, &rt->frame, target->width, target->height, projection);
    }
    T3R_PASS(t3r_camera_fault(camera, target->width, target->height, fault));
    return t3r_far_checks(camera, &rt->frame, fault);
}

#endif
