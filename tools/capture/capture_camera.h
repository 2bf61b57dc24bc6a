/* A camera as a recording holds it, in doubles, and as the runtime takes it, in fixed point: so converted that a live
 * frame has the very camera that its recording will have. */
#ifndef TRIM3R_TOOLS_CAPTURE_CAMERA_H
#define TRIM3R_TOOLS_CAPTURE_CAMERA_H

#include <stdbool.h>

#include "capture/capture.h"
#include "recording/recording.h"

/* The camera of a frame with what it knows; exact. */
t3r_recorded_camera capture_camera_recorded(const t3r_capture_frame *frame);
/* Intrinsics, pose, or both into the frame's camera, as the reader of recordings does it. NULL, or what is out of
 * range. */
const char *capture_camera_set_intrinsics(const t3r_recorded_camera *camera, t3r_camera *out);
const char *capture_camera_set_pose(const t3r_recorded_camera *camera, t3r_camera *out);

#endif
