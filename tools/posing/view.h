/* SPDX-License-Identifier: Apache-2.0 */
/* A frame as pose estimation sees it: features, their rays, their depths. */
#ifndef TRIM3R_TOOLS_POSING_VIEW_H
#define TRIM3R_TOOLS_POSING_VIEW_H

#include <stdbool.h>
#include <stddef.h>

#include "posing/opencv_module.h"
#include "trim3r.h"

/* A frame whose longer side is more is worked on at this size, */
#define POSE_SIDE_MOST 1024u
/* one whose longer side is less at this one: then features between pixels are found, and borders shrink. */
#define POSE_SIDE_LEAST 512u

typedef struct pose_view {
    const pose_module *module;
    pose_features features;
    bool measured; /* depth came with the frame */
} pose_view;

/* Makes the view of a frame and its intrinsics; the camera's pose is not read. 0, or -1 with a reason in error[];
 * pose_view_free() in either case. */
int pose_view_make(const t3r_frame *frame, const t3r_camera *camera, pose_view *out, char *error, size_t error_bytes);
void pose_view_free(pose_view *view);

#endif
