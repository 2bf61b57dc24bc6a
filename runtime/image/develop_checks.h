/* SPDX-License-Identifier: Apache-2.0 */
/* The checks of a frame with its camera. */
#ifndef T3R_DEVELOP_CHECKS_H
#define T3R_DEVELOP_CHECKS_H

#include "core/camera.h"
#include "core/features.h"
#include "frame_checks.h"
#include "state/state.h"

/* Checks a camera for width x height at the working size, of which *resized becomes the camera. */
T3R_CHECKS t3r_resized_checks(const t3r_runtime *rt, const t3r_camera *camera, uint32_t width, uint32_t height,
                              t3r_camera *resized, t3r_fault *fault)
{
    *resized = t3r_camera_resized(camera, width, height, rt->config.width, rt->config.height);
    const t3r_status status = fault == NULL ? t3r_camera_check(resized, rt->config.width, rt->config.height)
                                            : t3r_camera_fault(resized, rt->config.width, rt->config.height, fault);
    if (fault != NULL && status != T3R_OK) {
        fault->after = ", after resizing to the working size";
    }
    return status;
}

T3R_CHECKS t3r_develop_checks(const t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera,
                              t3r_camera *resized, t3r_fault *fault)
{
    T3R_PASS(fault == NULL ? t3r_image_check(frame) : t3r_frame_checks(frame, fault));
    T3R_PASS(fault == NULL ? t3r_camera_check(camera, frame->width, frame->height)
                           : t3r_camera_fault(camera, frame->width, frame->height, fault));
    T3R_PASS(t3r_resized_checks(rt, camera, frame->width, frame->height, resized, fault));
    T3R_CHECK(fault, T3R_FEATURE_EXTRAS || resized->distortion == T3R_DISTORTION_NONE, T3R_ERR_UNSUPPORTED,
              "camera.distortion is #: this library was built without lenses (T3R_FEATURE_EXTRAS)",
              resized->distortion);
    return T3R_OK;
}

#endif
