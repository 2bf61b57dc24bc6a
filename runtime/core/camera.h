/* Cameras: range checks, rotation matrices, change of pixel grid. */
#ifndef T3R_CAMERA_H
#define T3R_CAMERA_H

#include <stdint.h>

#include "trim3r.h"

/* |position_q32| stays below this, so that the difference of two positions fits 63 bits. */
#define T3R_MAX_POSITION_Q32 (INT64_C(1) << 62)
/* |p1|, |p2| of T3R_DISTORTION_RADTAN stay below this: 16. */
#define T3R_MAX_TANGENTIAL_Q24 (INT32_C(1) << 28)

/* T3R_OK; T3R_ERR_ARGUMENT for NULL; T3R_ERR_CAMERA when a field is outside the range that trim3r.h and the
 * limits above give it. */
t3r_status t3r_camera_check(const t3r_camera *camera);

/* The row-major rotation matrix of a checked quaternion w x y z, normalised: each entry the exact quotient
 * rounded once (error at most 2^-31). */
void t3r_camera_rotation(const int32_t quaternion_q30[4], int32_t rotation_q30[9]);

/* The same camera for its image resized from one size to another (sizes 1..T3R_MAX_SIDE). Out-of-range results
 * saturate and then fail t3r_camera_check(). */
t3r_camera t3r_camera_resized(const t3r_camera *camera, uint32_t from_width, uint32_t from_height, uint32_t to_width,
                              uint32_t to_height);

#endif
