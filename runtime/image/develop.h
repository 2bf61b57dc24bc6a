/* Stage image: a camera's frame to the planes of a context view. */
#ifndef T3R_DEVELOP_H
#define T3R_DEVELOP_H

#include "trim3r.h"

/* Checks frame and camera, then fills colour, depth and validity of view `index`: resized to the working size and
 * undistorted. *undistorted gets the camera of the planes. On an error the planes may be part written. */
t3r_status t3r_develop_view(t3r_runtime *rt, uint32_t index, const t3r_frame *frame, const t3r_camera *camera,
                            t3r_camera *undistorted);

#endif
