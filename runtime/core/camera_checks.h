/* SPDX-License-Identifier: Apache-2.0 */
/* The checks of a camera. */
#ifndef T3R_CAMERA_CHECKS_H
#define T3R_CAMERA_CHECKS_H

#include <stdbool.h>

#include "camera.h"
#include "features.h"

#define T3R_FOCAL_LEAST_Q16 (8 << 16)
#define T3R_PIXELS_MOST_Q16 ((16384 << 16) - 1)

static inline uint64_t t3r_square(int32_t x)
{
    return (uint64_t)((int64_t)x * x);
}

/* Returns the squared norm, Q60. Only four components of -2 reach 2^64, which wraps to 0. */
static inline uint64_t t3r_norm2_q60(const int32_t q[4])
{
    return t3r_square(q[0]) + t3r_square(q[1]) + t3r_square(q[2]) + t3r_square(q[3]);
}

static inline bool t3r_is_focal(int32_t f_q16)
{
    return f_q16 >= T3R_FOCAL_LEAST_Q16 && f_q16 <= T3R_PIXELS_MOST_Q16;
}

static inline bool t3r_is_centre(int32_t c_q16)
{
    return c_q16 >= -T3R_PIXELS_MOST_Q16 && c_q16 <= T3R_PIXELS_MOST_Q16;
}

T3R_CONDITION t3r_is_rotation(const int32_t q[4])
{
    const uint64_t norm2 = t3r_norm2_q60(q);
    return norm2 >= UINT64_C(1) << 58 && norm2 <= UINT64_C(9) << 58;
}

/* Whether the camera is for that size, or for any. */
static inline bool t3r_is_for(const t3r_camera *camera, uint32_t width, uint32_t height)
{
    return (camera->width == width && camera->height == height) || (camera->width | camera->height) == 0;
}

#define T3R_FOCAL_TEXT_(field)                                                                                         \
    "camera." field " is #: a focal length is #..#, in 1/65536 pixel (8 pixels to below 16384)"
#define T3R_CENTRE_TEXT_(field) "camera." field " is #: a principal point is #..#, in 1/65536 pixel (within 16384)"

T3R_CHECKS t3r_camera_checks(const t3r_camera *camera, uint32_t width, uint32_t height, t3r_fault *fault)
{
    T3R_CHECK(fault, t3r_is_for(camera, width, height), T3R_ERR_CAMERA,
              "camera.width x height is # x #, and the picture is # x #: the intrinsics are for another size; 0 x 0 "
              "fits any",
              camera->width, camera->height, width, height);
    T3R_CHECK(fault, t3r_is_focal(camera->fx_q16), T3R_ERR_CAMERA, T3R_FOCAL_TEXT_("fx_q16"), camera->fx_q16,
              T3R_FOCAL_LEAST_Q16, T3R_PIXELS_MOST_Q16);
    T3R_CHECK(fault, t3r_is_focal(camera->fy_q16), T3R_ERR_CAMERA, T3R_FOCAL_TEXT_("fy_q16"), camera->fy_q16,
              T3R_FOCAL_LEAST_Q16, T3R_PIXELS_MOST_Q16);
    T3R_CHECK(fault, t3r_is_centre(camera->cx_q16), T3R_ERR_CAMERA, T3R_CENTRE_TEXT_("cx_q16"), camera->cx_q16,
              -T3R_PIXELS_MOST_Q16, T3R_PIXELS_MOST_Q16);
    T3R_CHECK(fault, t3r_is_centre(camera->cy_q16), T3R_ERR_CAMERA, T3R_CENTRE_TEXT_("cy_q16"), camera->cy_q16,
              -T3R_PIXELS_MOST_Q16, T3R_PIXELS_MOST_Q16);
    T3R_CHECK(fault, camera->distortion < T3R_DISTORTION_COUNT, T3R_ERR_CAMERA,
              "camera.distortion is @: a t3r_distortion is 0..#", camera->distortion, T3R_DISTORTION_COUNT - 1);
    T3R_CHECK(fault, t3r_is_rotation(camera->rotation_q30), T3R_ERR_CAMERA,
              "camera.rotation_q30 is # # # #: the norm of a rotation w x y z is 0.5..1.5, in 1/2^30; 1073741824 0 0 0 "
              "is the identity",
              camera->rotation_q30[0], camera->rotation_q30[1], camera->rotation_q30[2], camera->rotation_q30[3]);
    for (uint32_t i = 0; i < 3; i++) {
        T3R_CHECK(fault,
                  camera->position_q32[i] < T3R_MAX_POSITION_Q32 && camera->position_q32[i] > -T3R_MAX_POSITION_Q32,
                  T3R_ERR_CAMERA, "camera.position_q32[#] is #: a coordinate is between -# and #, in 1/2^32 world unit",
                  i, camera->position_q32[i], T3R_MAX_POSITION_Q32, T3R_MAX_POSITION_Q32);
    }
    if (T3R_FEATURE_EXTRAS && camera->distortion == T3R_DISTORTION_RADTAN) { /* without lenses any is refused */
        for (uint32_t i = 2; i < 4; i++) {
            const int32_t p = camera->distortion_q24[i];
            T3R_CHECK(fault, p < T3R_MAX_TANGENTIAL_Q24 && p > -T3R_MAX_TANGENTIAL_Q24, T3R_ERR_CAMERA,
                      "camera.distortion_q24[#] is #: p1 and p2 are between -# and #, in 1/2^24", i, p,
                      T3R_MAX_TANGENTIAL_Q24, T3R_MAX_TANGENTIAL_Q24);
        }
    }
    return T3R_OK;
}

#endif
