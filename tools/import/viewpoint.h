/* SPDX-License-Identifier: Apache-2.0 */
/* Viewpoints of pictures: pose files, trajectories and turntables. */
#ifndef TRIM3R_TOOLS_VIEWPOINT_H
#define TRIM3R_TOOLS_VIEWPOINT_H

#include <stddef.h>
#include <stdint.h>

#include "geometry/rigid.h"
#include "import/poses/pose_losses.h"
#include "trim3r.h"

typedef struct viewpoint_list {
    t3r_camera *items; /* without distortion, each with its size; heap, viewpoint_list_free() */
    uint32_t count;
    double rate;        /* pictures a second, as a camera path states it; 0 = it does not */
    pose_losses losses; /* poses that are left out */
} viewpoint_list;

/* Reads a JSON object with the fields of one frame of transforms.json (fl_x [fl_y cx cy] w h transform_matrix), a whole
 * transforms.json, or a list of cameras (camera_list.h); pictures are not opened. width, height: sides of views whose
 * file does not state them; 0 = there are none. Returns 0, or -1 with "path: field: what" in error[] if no frame gives
 * a view. */
int viewpoint_read_pose(const char *path, uint32_t width, uint32_t height, viewpoint_list *out, char *error,
                        size_t error_bytes);

/* Reads a list of poses (pose_list.h), camera to world, x right, y down, z forward. Intrinsics and size are those of
 * `lens`. Returns 0, or -1 with "path: line: what" in error[]. */
int viewpoint_read_trajectory(const char *path, const t3r_camera *lens, viewpoint_list *out, char *error,
                              size_t error_bytes);

/* Makes a lens of the given horizontal angle in degrees, (0, 180), at the world's origin, looking along its z. Returns
 * 0, or -1 when the focal length is out of the runtime's range. */
int viewpoint_from_angle(double degrees, uint32_t width, uint32_t height, t3r_camera *out);

/* Sets the pose of a camera. Returns 0, or -1 when it is out of the runtime's range. */
int viewpoint_place(t3r_camera *camera, const rigid *pose);
/* Turns a view about the axis through `centre` with the direction `axis`, a unit vector: `count` views, evenly around,
 * the first being `start`; or evenly on an arc above 0 degrees, with `start` in its middle. Returns 0, or -1 with a
 * reason in error[]. */
int viewpoint_turn(const t3r_camera *start, const double centre[3], const double axis[3], uint32_t count, double arc,
                   viewpoint_list *out, char *error, size_t error_bytes);

void viewpoint_list_free(viewpoint_list *list);

#endif
