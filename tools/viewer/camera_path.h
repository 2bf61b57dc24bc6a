/* SPDX-License-Identifier: Apache-2.0 */
/* The path of a recording's camera, for a page. */
#ifndef TRIM3R_TOOLS_VIEWER_CAMERA_PATH_H
#define TRIM3R_TOOLS_VIEWER_CAMERA_PATH_H

#include "recording/recording.h"

#define CAMERA_PATH_MOST 512u

typedef struct camera_path {
    t3r_camera places[CAMERA_PATH_MOST]; /* only their poses count */
    uint32_t count;
} camera_path;

/* Reads the poses of the recording's frames, in their order; of more than CAMERA_PATH_MOST as many, evenly spaced.
 * Frames without a pose are left out. */
void camera_path_read(const t3r_recording *recording, camera_path *out);

#endif
