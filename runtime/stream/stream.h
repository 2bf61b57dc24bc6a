/* SPDX-License-Identifier: Apache-2.0 */
/* Takes a keyframe of a stream, from the camera's frame to the map. */
#ifndef T3R_STREAM_H
#define T3R_STREAM_H

#include "trim3r.h"

/* Takes the checked frame into the map, or refuses it: report->refusal. `camera` comes from t3r_frame_check(). */
t3r_status t3r_stream_take(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera,
                           t3r_stream_report *report);

/* Shows the map a checked frame again that was a keyframe before: refinement alone, in this round, from 1 on. */
t3r_status t3r_stream_show(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, uint32_t round);

#endif
