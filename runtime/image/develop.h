/* SPDX-License-Identifier: Apache-2.0 */
/* Stage image: converts a camera's frame to the planes of a context view. */
#ifndef T3R_DEVELOP_H
#define T3R_DEVELOP_H

#include <stdbool.h>

#include "core/fault.h"
#include "trim3r.h"

/* Checks a caller's frame and camera for the image stage, except whether the lens shows too little of the picture.
 * *resized gets the camera of the working size, with its lens. T3R_ERR_UNSUPPORTED: a lens, and this library has none.
 */
t3r_status t3r_frame_check(const t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera,
                           t3r_camera *resized);

/* Does the same and writes the sentence of the check that fails. */
t3r_status t3r_frame_fault(const t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, t3r_camera *resized,
                           t3r_fault *fault);

/* Fills colour, depth and validity of view `index` from a checked frame: resized to the working size and undistorted.
 * *camera comes from t3r_frame_check() and becomes the camera of the planes. After an error the planes may be partly
 * written. */
t3r_status t3r_develop_view(t3r_runtime *rt, uint32_t index, const t3r_frame *frame, t3r_camera *camera);

/* A run of rows of a frame; its planes begin with the first of them. */
typedef struct t3r_strip {
    uint32_t row, rows;             /* of the colour image */
    uint32_t depth_row, depth_rows; /* of the depth image */
    bool begins, ends;              /* whether it is the first, or the last, strip of a view */
} t3r_strip;

/* Fills the view strip by strip; *camera is the planes' camera after the last one. The image stage's work memory must
 * be kept in between. */
t3r_status t3r_develop_strip(t3r_runtime *rt, uint32_t index, const t3r_frame *frame, const t3r_strip *strip,
                             t3r_camera *camera);

#endif
