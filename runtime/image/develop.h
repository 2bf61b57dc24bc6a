/* Stage image: converts a camera's frame to the planes of a context view. */
#ifndef T3R_DEVELOP_H
#define T3R_DEVELOP_H

#include <stdbool.h>

#include "trim3r.h"

/* Checks whether the image stage accepts this frame and camera, except that the lens may still show too little of the
 * picture. Writes no plane. *resized becomes the camera at the working size, lens included. T3R_ERR_UNSUPPORTED: a lens
 * that this library was built without. */
t3r_status t3r_frame_check(const t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera,
                           t3r_camera *resized);

/* Checks frame and camera, then fills colour, depth and validity of view `index`: resized to the working size and
 * undistorted. *undistorted becomes the camera of the planes. On an error the planes may be partly written. */
t3r_status t3r_develop_view(t3r_runtime *rt, uint32_t index, const t3r_frame *frame, const t3r_camera *camera,
                            t3r_camera *undistorted);

/* A run of rows of a frame; its planes begin with the first of them. */
typedef struct t3r_strip {
    uint32_t row, rows;             /* of the colour image */
    uint32_t depth_row, depth_rows; /* of the depth image */
    bool begins, ends;              /* whether it is the first strip of a view, and the last */
} t3r_strip;

/* As t3r_develop_view(), strip by strip; the last strip sets *undistorted. The image stage's work memory must stay
 * unchanged between strips. */
t3r_status t3r_develop_strip(t3r_runtime *rt, uint32_t index, const t3r_frame *frame, const t3r_camera *camera,
                             const t3r_strip *strip, t3r_camera *undistorted);

#endif
