/* SPDX-License-Identifier: Apache-2.0 */
/* A frame from a camera or a recording, and the outcomes of asking for one. */
#ifndef T3R_PLATFORM_CAPTURED_FRAME_H
#define T3R_PLATFORM_CAPTURED_FRAME_H

#include <stdbool.h>
#include <stdint.h>

#include "trim3r.h"

/* One captured frame, ready for t3r_add_view() once pose and intrinsics are known. */
typedef struct t3r_capture_frame {
    uint32_t index;         /* order among the colour images of the source, from 0 */
    uint32_t sequence;      /* the driver's count, with gaps; in recordings the index */
    int64_t stamp_ns;       /* time of the colour image, in the source's clock */
    int64_t depth_stamp_ns; /* time of the depth image; equal to stamp_ns if they are one image */
    bool has_pose;          /* camera's pose is known */
    bool has_intrinsics;    /* camera's intrinsics are known */
    bool straightened;      /* redrawn without the lens's distortion, which `camera` cannot hold */
    t3r_frame frame;        /* frame.depth is NULL without depth */
    t3r_camera camera;
} t3r_capture_frame;

enum {
    T3R_CAPTURE_LOST = -2,   /* the device is gone, stalled or changed its format: t3r_capture_reopen() */
    T3R_CAPTURE_FAILED = -1, /* this frame failed; the next one may be good */
    T3R_CAPTURE_END = 0,     /* there are no more frames */
    T3R_CAPTURE_FRAME = 1,
    T3R_CAPTURE_NOTHING = 2, /* no frame by the deadline, or a signal came: ask again */
};

#endif
