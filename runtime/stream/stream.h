/* A keyframe of a stream, from the camera's frame to the map. */
#ifndef T3R_STREAM_H
#define T3R_STREAM_H

#include "trim3r.h"

/* Whether the frame can be read and the camera stands where the map reaches; T3R_OK moves the map's origin after it. */
t3r_status t3r_stream_follow(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera);

/* The checked keyframe into the map. */
t3r_status t3r_stream_take(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera,
                           t3r_stream_report *report);

#endif
