/* SPDX-License-Identifier: Apache-2.0 */
/* Stubs for builds without streams. */
#include "state/state.h"

#if !T3R_FEATURE_STREAMS

t3r_status t3r_stream_keyframe(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera,
                               t3r_stream_report *report)
{
    if (report != NULL) {
        *report = (t3r_stream_report){0};
    }
    T3R_REFUSE_UNLESS(rt != NULL && frame != NULL && camera != NULL, T3R_ERR_ARGUMENT);
    return T3R_ERR_UNSUPPORTED;
}

t3r_status t3r_stream_again(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, uint32_t round)
{
    (void)round;
    T3R_REFUSE_UNLESS(rt != NULL && frame != NULL && camera != NULL, T3R_ERR_ARGUMENT);
    return T3R_ERR_UNSUPPORTED;
}

t3r_status t3r_stream_overlap(const t3r_runtime *rt, const t3r_camera *camera, uint32_t width, uint32_t height,
                              uint32_t *overlap_q8)
{
    (void)width;
    (void)height;
    T3R_REFUSE_UNLESS(rt != NULL && camera != NULL && overlap_q8 != NULL, T3R_ERR_ARGUMENT);
    return T3R_ERR_UNSUPPORTED;
}

#endif
