/* SPDX-License-Identifier: Apache-2.0 */
/* A frame as pose estimation sees it: corners, their rays, their depths. */
#ifndef TRIM3R_TOOLS_POSING_VIEW_H
#define TRIM3R_TOOLS_POSING_VIEW_H

#include <stdbool.h>
#include <stddef.h>

#include "posing/corners.h"
#include "trim3r.h"

/* A frame whose longer side is more is worked on at this size, */
#define POSE_SIDE_MOST 1024u
/* one whose is less at this: corners between pixels have their own, and borders shrink. */
#define POSE_SIDE_LEAST 512u

typedef struct pose_view {
    corner *corners;
    uint32_t count;
    double (*rays)[2]; /* x and y at depth 1, the lens undone */
    double *depth;     /* a corner: along z in world units; 0 = not known, or at an edge */
    double focal;      /* mean focal length, pixels of the corners' places */
    double enlarged;   /* pixels of the corners' places to one of the frame */
    bool measured;     /* depth came with the frame */
} pose_view;

/* Of a frame and its intrinsics; the camera's pose is not read. 0, or -1 with a reason in error[];
 * pose_view_free() in either case. */
int pose_view_make(const t3r_frame *frame, const t3r_camera *camera, pose_view *out, char *error, size_t error_bytes);
void pose_view_free(pose_view *view);

#endif
