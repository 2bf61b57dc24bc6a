/* Capture: where frames come from. One interface over every source; `replay` (recordings) is the first.
 *
 * A source is opened by its adapter (t3r_replay_open() ...), asked for one frame after the other, and closed.
 * Frames lend their memory: it stays valid until the next call on the same source. */
#ifndef T3R_PLATFORM_CAPTURE_H
#define T3R_PLATFORM_CAPTURE_H

#include <stdbool.h>
#include <stdint.h>

#include "trim3r.h"

/* One captured instant, ready for t3r_add_view(). */
typedef struct t3r_capture_frame {
    uint32_t index;      /* order among the colour images of the source, from 0 */
    int64_t stamp_ns;    /* time of the colour image, in the source's clock */
    bool has_pose;       /* camera's pose is known */
    bool has_intrinsics; /* camera's intrinsics are known */
    t3r_frame frame;     /* frame.depth is NULL when the instant has no depth */
    t3r_camera camera;
} t3r_capture_frame;

typedef struct t3r_capture t3r_capture;

enum { T3R_CAPTURE_FAILED = -1, T3R_CAPTURE_END = 0, T3R_CAPTURE_FRAME = 1 };

/* The next frame: T3R_CAPTURE_FRAME, T3R_CAPTURE_END, or T3R_CAPTURE_FAILED with a reason in
 * t3r_capture_error(). */
int t3r_capture_next(t3r_capture *capture, t3r_capture_frame *frame);
/* What went wrong, where; "" when nothing did. Lives as long as the source. */
const char *t3r_capture_error(const t3r_capture *capture);
void t3r_capture_close(t3r_capture *capture);

/* The adapter `replay`: the frames of an MCAP recording. NULL with a reason in error[] on failure. */
t3r_capture *t3r_replay_open(const char *path, char *error, size_t error_bytes);

#endif
