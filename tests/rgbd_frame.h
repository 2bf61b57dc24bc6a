/* SPDX-License-Identifier: Apache-2.0 */
/* A frame of rows without padding, and the camera of a square frame, for most tests. */
#ifndef T3R_TESTS_RGBD_FRAME_H
#define T3R_TESTS_RGBD_FRAME_H

#include <stdint.h>

#include "trim3r.h"

enum { MILLIMETRE_Q40 = 1099511628 };

/* Makes a frame of RGB, 3 bytes a pixel, and depth of the same size, 2 bytes a pixel, in steps of unit_q40 metres. */
static inline t3r_frame rgbd_frame(const uint8_t *rgb, const uint8_t *depth, uint32_t width, uint32_t height,
                                   uint64_t unit_q40)
{
    return (t3r_frame){.format = T3R_PIXEL_RGB24,
                       .width = width,
                       .height = height,
                       .planes = {rgb},
                       .stride_bytes = {3 * width},
                       .depth = depth,
                       .depth_width = width,
                       .depth_height = height,
                       .depth_stride_bytes = 2 * width,
                       .depth_unit_q40 = unit_q40};
}

/* Makes a camera at the origin that looks along z: a focal length of `side` pixels, the axis through the middle. */
static inline t3r_camera straight_camera(uint32_t side)
{
    const int32_t focal_q16 = (int32_t)side << 16;
    return (t3r_camera){.fx_q16 = focal_q16,
                        .fy_q16 = focal_q16,
                        .cx_q16 = focal_q16 / 2,
                        .cy_q16 = focal_q16 / 2,
                        .rotation_q30 = {1 << 30}};
}

#endif
