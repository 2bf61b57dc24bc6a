/* SPDX-License-Identifier: Apache-2.0 */
/* Cameras: range checks, rotation matrices, change of pixel grid. */
#ifndef T3R_CAMERA_H
#define T3R_CAMERA_H

#include <stdint.h>

#include "fault.h"
#include "trim3r.h"

/* Bound of |position_q32|, so that the difference of two positions fits 63 bits. */
#define T3R_MAX_POSITION_Q32 (INT64_C(1) << 62)
/* Bound of |p1|, |p2| of T3R_DISTORTION_RADTAN: 16. */
#define T3R_MAX_TANGENTIAL_Q24 (INT32_C(1) << 28)

/* Checks a camera for a picture of width x height. Returns T3R_ERR_ARGUMENT for NULL, T3R_ERR_CAMERA when the camera is
 * for another size, or a field is outside the range of trim3r.h and the bounds above. */
t3r_status t3r_camera_check(const t3r_camera *camera, uint32_t width, uint32_t height);

/* Does the same for a camera that is not NULL, and writes the sentence of the check that fails. */
t3r_status t3r_camera_fault(const t3r_camera *camera, uint32_t width, uint32_t height, t3r_fault *fault);

/* Computes the row-major rotation matrix of a checked quaternion w x y z, which is normalised: each entry is the exact
 * quotient, rounded once (error at most 2^-31). */
void t3r_camera_rotation(const int32_t quaternion_q30[4], int32_t rotation_q30[9]);

/* Returns the camera for its image resized from one size to another (sizes 1..T3R_MAX_SIDE). Out-of-range results
 * saturate and then fail t3r_camera_check(). */
t3r_camera t3r_camera_resized(const t3r_camera *camera, uint32_t from_width, uint32_t from_height, uint32_t to_width,
                              uint32_t to_height);

#endif
