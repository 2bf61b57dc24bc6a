/* SPDX-License-Identifier: Apache-2.0 */
/* The frame of one view, for scenes whose own frame cannot show near detail and far surroundings at once: the camera is
 * its origin, and depths are compressed beyond what is near. A picture of it is that of the scene, since each Gaussian
 * moves along its ray and shrinks alike. It needs no C library. */
#ifndef TRIM3R_TOOLS_VIEW_FRAME_H
#define TRIM3R_TOOLS_VIEW_FRAME_H

#include "core/scene_frame.h"
#include "trim3r.h"

typedef struct view_frame {
    t3r_scene_frame frame; /* its unit is 2^-finer units of the scene, if that exponent is in range */
    t3r_pose pose;         /* of the camera in it */
    double ratio;          /* units of this frame in one of the scene */
    double offset[3];      /* from the camera to the scene's origin, units of this frame */
    double forward[3];     /* optical axis */
    double limit[2];       /* most |x / z| and |y / z| for which a Gaussian's shape is projected */
} view_frame;

/* limit: that of the rasterizer for the picture to draw. */
void view_frame_of(const t3r_camera *camera, const t3r_scene_frame *scene, uint32_t finer, const double limit[2],
                   view_frame *out);
/* Moves a Gaussian from the scene's frame to that of the view. It is `times` (at least 1) as far from the scene's
 * origin, and as large, as it says. Along the axis its shape is compressed as depths are, so that view_frame_depth()
 * finds the depth at each of its pixels, too. Gaussians that no picture shows go to the camera. */
void view_frame_place(const view_frame *view, double times, t3r_gaussian *gaussian);
/* Returns the depth in the scene of a depth in the view's frame, both in units of that frame. */
double view_frame_depth(double compressed);

#endif
