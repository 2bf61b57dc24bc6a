/* SPDX-License-Identifier: Apache-2.0 */
/* Converts a camera between doubles, as a recording holds it, and fixed point, as the runtime takes it. A live frame
 * gets exactly the camera that its recording will have. */
#ifndef TRIM3R_TOOLS_CAPTURE_CAMERA_H
#define TRIM3R_TOOLS_CAPTURE_CAMERA_H

#include <stdbool.h>

#include "recording/recording.h"
#include "trim3r_capture.h"

/* Returns the camera of a frame, with what is known of it; exact. */
t3r_recorded_camera capture_camera_recorded(const t3r_capture_frame *frame);
/* Set intrinsics, pose, or both in the frame's camera, as the reader of recordings does. Return NULL, or what is out of
 * range. */
const char *capture_camera_set_intrinsics(const t3r_recorded_camera *camera, t3r_camera *out);
const char *capture_camera_set_pose(const t3r_recorded_camera *camera, t3r_camera *out);

#endif
