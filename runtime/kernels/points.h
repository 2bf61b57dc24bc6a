/* SPDX-License-Identifier: Apache-2.0 */
/* Back-projection of pixels with depth to points of the scene, and projection of points to the pixels of a view. */
#ifndef T3R_KERNEL_POINTS_H
#define T3R_KERNEL_POINTS_H

#include <stdint.h>

#include "core/scene_frame.h"

/* A view: its lens in pixels, and its pose. Focal lengths are at least 8 pixels and below 2^14, |centres| are below
 * 2^14, positions within T3R_POSITION_MOST_Q20. */
typedef struct t3r_pinhole {
    t3r_pose pose;
    int32_t fx_q16, fy_q16, cx_q16, cy_q16;
    uint32_t width, height;
} t3r_pinhole;

/* A view's back-projection: turns its pixels and depth steps into points. */
typedef struct t3r_unprojection {
    t3r_pinhole view;
    t3r_depth_scale scale;
    int32_t inverse_fx_q32, inverse_fy_q32; /* 1 / f, rounded down */
} t3r_unprojection;

#define T3R_POINTS 64u
#define T3R_NO_PIXEL UINT32_MAX

/* A batch of up to T3R_POINTS pixels and their points. Entries after the last may hold anything, and kernels may change
 * them up to the next multiple of 8. */
typedef struct t3r_points {
    uint32_t count;
    uint16_t u[T3R_POINTS], v[T3R_POINTS], depth[T3R_POINTS];
    int32_t point_q20[3][T3R_POINTS];
} t3r_points;

/* The points' places in a view: the pixel whose centre is nearest, as row x width + column, or T3R_NO_PIXEL; and the
 * depth there, undefined without a pixel. */
typedef struct t3r_places {
    uint32_t pixel[T3R_POINTS];
    int32_t z_q20[T3R_POINTS];
} t3r_places;

/* Computes the points of pixels. A depth of 0 gives the view's own position. */
typedef void t3r_unproject_kernel(const t3r_unprojection *restrict from, t3r_points *restrict points);

/* Locates points in a view: no pixel for a point nearer than 1/32 scene unit, more than 16 z off the axis, or outside
 * the image. */
typedef void t3r_locate_kernel(const t3r_pinhole *restrict view, const t3r_points *restrict points,
                               t3r_places *restrict places);

t3r_unproject_kernel t3r_unproject_c;
t3r_locate_kernel t3r_locate_c;

/* Locates one point: returns its pixel or T3R_NO_PIXEL, and stores its depth. */
uint32_t t3r_locate_point(const t3r_pinhole *view, const int32_t point_q20[3], int32_t *z_q20);

#endif
