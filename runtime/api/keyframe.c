/* SPDX-License-Identifier: Apache-2.0 */
/* Streams: takes a keyframe into the map, and computes the overlap of the next picture. */
#include "api/keyframe_checks.h"
#include "stream/stream.h"
#include "stream/stream_overlap.h"

static const t3r_stream_report nothing; /* a literal would take stack at its deepest point */

t3r_status t3r_stream_keyframe(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera,
                               t3r_stream_report *report)
{
    if (report != NULL) {
        *report = nothing;
    }
    t3r_camera taken;
    T3R_PASS(t3r_keyframe_checks(rt, frame, camera, &taken, NULL)); /* before any change */
    rt->build = t3r_build_of(&rt->config); /* a restored arena may hold another build, whose head is not bound */
    t3r_stream_report outcome = {0};
    const t3r_status status = t3r_stream_take(rt, frame, &taken, &outcome);
    if (report != NULL) {
        *report = outcome;
    }
    return status;
}

t3r_status t3r_stream_again(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, uint32_t round)
{
    t3r_camera shown;
    T3R_PASS(t3r_again_checks(rt, frame, camera, round, &shown, NULL));
    rt->build = t3r_build_of(&rt->config);
    return t3r_stream_show(rt, frame, &shown, round);
}

t3r_status t3r_stream_overlap(const t3r_runtime *rt, const t3r_camera *camera, uint32_t width, uint32_t height,
                              uint32_t *overlap_q8)
{
    T3R_PASS(t3r_overlap_checks(rt, camera, width, height, overlap_q8, NULL));
    return t3r_overlap_with_newest(rt, camera, width, height, overlap_q8);
}
