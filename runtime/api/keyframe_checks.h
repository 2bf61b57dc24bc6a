/* SPDX-License-Identifier: Apache-2.0 */
/* The checks of a stream's calls. */
#ifndef T3R_KEYFRAME_CHECKS_H
#define T3R_KEYFRAME_CHECKS_H

#include "adding_checks.h"
#include "checks.h"
#include "core/camera.h"

#define T3R_NO_STREAMS_TEXT "this library was built without streams (T3R_FEATURE_STREAMS)"
#define T3R_NO_STREAM_TEXT "this runtime is no stream: set config.stream before t3r_init()"

/* *resized becomes the camera at the working size. */
T3R_CHECKS t3r_keyframe_checks(const t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera,
                               t3r_camera *resized, t3r_fault *fault)
{
    T3R_PASS(t3r_taken_checks(rt, frame, camera, fault));
    T3R_CHECK(fault, T3R_FEATURE_STREAMS, T3R_ERR_UNSUPPORTED, T3R_NO_STREAMS_TEXT);
    T3R_MISUSE(fault, rt->config.stream, T3R_ERR_STATE, T3R_NO_STREAM_TEXT);
    T3R_MISUSE(fault, t3r_has_head(rt, rt->config.head), T3R_ERR_STATE, T3R_NO_HEAD_TEXT);
    T3R_MISUSE(fault, rt->config.allocate != T3R_ALLOCATE_GIVEN, T3R_ERR_STATE,
               "config.allocate is T3R_ALLOCATE_GIVEN: a keyframe has no importance");
    T3R_CHECK_FRAME(rt, frame, camera, resized, fault);
    return T3R_OK;
}

/* *resized becomes the camera at the working size. */
T3R_CHECKS t3r_again_checks(const t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, uint32_t round,
                            t3r_camera *resized, t3r_fault *fault)
{
    T3R_PASS(t3r_keyframe_checks(rt, frame, camera, resized, fault));
    T3R_MISUSE(fault, round >= 1 && round <= T3R_MAX_ROUND, T3R_ERR_ARGUMENT, "round is @: it is 1..#", round,
               T3R_MAX_ROUND);
    T3R_MISUSE(fault, rt->keyframes > 0, T3R_ERR_STATE,
               "there is no keyframe to show again: t3r_stream_keyframe() comes first");
    return T3R_OK;
}

T3R_CHECKS t3r_overlap_checks(const t3r_runtime *rt, const t3r_camera *camera, uint32_t width, uint32_t height,
                              const uint32_t *overlap_q8, t3r_fault *fault)
{
    T3R_PASS(t3r_runtime_checks(rt, fault));
    T3R_MISUSE(fault, camera != NULL, T3R_ERR_ARGUMENT, "camera is NULL");
    T3R_MISUSE(fault, overlap_q8 != NULL, T3R_ERR_ARGUMENT, "overlap_q8 is NULL");
    T3R_CHECK(fault, T3R_FEATURE_STREAMS, T3R_ERR_UNSUPPORTED, T3R_NO_STREAMS_TEXT);
    T3R_MISUSE(fault, width >= 2 && width <= T3R_MAX_SIDE, T3R_ERR_ARGUMENT, "width is @: a side is 2..# pixels", width,
               T3R_MAX_SIDE);
    T3R_MISUSE(fault, height >= 2 && height <= T3R_MAX_SIDE, T3R_ERR_ARGUMENT, "height is @: a side is 2..# pixels",
               height, T3R_MAX_SIDE);
    T3R_MISUSE(fault, rt->config.stream, T3R_ERR_STATE, T3R_NO_STREAM_TEXT);
    T3R_MISUSE(fault, rt->keyframes > 0, T3R_ERR_STATE, "there is no keyframe: call t3r_stream_keyframe() first");
    return fault == NULL ? t3r_camera_check(camera, width, height) : t3r_camera_fault(camera, width, height, fault);
}

#endif
