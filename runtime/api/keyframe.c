/* SPDX-License-Identifier: Apache-2.0 */
/* Streams: takes a keyframe into the map, and computes the overlap of the next picture. */
#include "api/checks.h"
#include "core/camera.h"
#include "image/develop.h"
#include "state/state.h"
#include "stream/stream.h"
#include "stream/stream_overlap.h"

static const t3r_stream_report nothing; /* a literal would take stack at its deepest point */

t3r_status t3r_stream_keyframe(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera,
                               t3r_stream_report *report)
{
    if (report != NULL) {
        *report = nothing;
    }
    T3R_REFUSE_UNLESS(rt != NULL && frame != NULL && camera != NULL, T3R_ERR_ARGUMENT);
    T3R_REFUSE_UNLESS(rt->config.stream && t3r_has_head(rt, rt->config.head) &&
                          rt->config.allocate != T3R_ALLOCATE_GIVEN,
                      T3R_ERR_STATE);
    rt->build = t3r_build_of(&rt->config); /* a restored arena may hold another build, whose head is not bound */
    t3r_stream_report outcome = {0};
    t3r_camera taken;
    t3r_status status = t3r_frame_check(rt, frame, camera, &taken); /* before any change */
    if (status == T3R_OK) {
        status = t3r_stream_take(rt, frame, &taken, &outcome);
    }
    if (report != NULL) {
        *report = outcome;
    }
    return status;
}

t3r_status t3r_stream_overlap(const t3r_runtime *rt, const t3r_camera *camera, uint32_t width, uint32_t height,
                              uint32_t *overlap_q8)
{
    T3R_REFUSE_UNLESS(rt != NULL && camera != NULL && overlap_q8 != NULL && width >= 2 && width <= T3R_MAX_SIDE &&
                          height >= 2 && height <= T3R_MAX_SIDE,
                      T3R_ERR_ARGUMENT);
    T3R_REFUSE_UNLESS(rt->config.stream && rt->keyframes > 0, T3R_ERR_STATE);
    t3r_status status = t3r_camera_check(camera, width, height);
    return status == T3R_OK ? t3r_overlap_with_newest(rt, camera, width, height, overlap_q8) : status;
}
