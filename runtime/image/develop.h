/* Stage image: converts a camera's frame to the planes of a context view. */
#ifndef T3R_DEVELOP_H
#define T3R_DEVELOP_H

#include <stdbool.h>

#include "trim3r.h"

/* Checks what callers bring: whether the image stage takes this frame and camera, but for a lens that shows too little
 * of the picture. *resized gets the camera of the working size, its lens too. T3R_ERR_UNSUPPORTED: a lens, and this
 * library has none. */
t3r_status t3r_frame_check(const t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera,
                           t3r_camera *resized);

/* Fills colour, depth and validity of view `index` from a checked frame: resized to the working size and undistorted.
 * *camera is that of t3r_frame_check() and becomes that of the planes. On an error the planes may be part written. */
t3r_status t3r_develop_view(t3r_runtime *rt, uint32_t index, const t3r_frame *frame, t3r_camera *camera);

/* A run of rows of a frame; its planes begin with the first of them. */
typedef struct t3r_strip {
    uint32_t row, rows;             /* of the colour image */
    uint32_t depth_row, depth_rows; /* of the depth image */
    bool begins, ends;              /* whether it is the first strip of a view, and the last */
} t3r_strip;

/* The same strip by strip; *camera is that of the planes after the last one. In between, the work of the image stage
 * must stay. */
t3r_status t3r_develop_strip(t3r_runtime *rt, uint32_t index, const t3r_frame *frame, const t3r_strip *strip,
                             t3r_camera *camera);

#endif
