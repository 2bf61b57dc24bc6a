/* SPDX-License-Identifier: Apache-2.0 */
/* Projection of the scene's Gaussians to splats of one view (SPEC.md, "Raster"). */
#ifndef T3R_KERNEL_PROJECT_H
#define T3R_KERNEL_PROJECT_H

#include <stdbool.h>
#include <stdint.h>

#include "trim3r.h"

/* Splats at 1/32 scene unit or nearer are culled, and those whose centre has |x| or |y| above 16 z. */
#define T3R_NEAR_Q20 (1 << 15)
#define T3R_ASIDE 16
#define T3R_DILATION_Q24 5033165 /* 0.3 px^2, added to every projected covariance */

/* A Gaussian as seen by one view. q(dx, dy) = a dx^2 + 2 b dx dy + c dy^2 is half the squared Mahalanobis distance. */
typedef struct t3r_splat {
    int32_t x_q12, y_q12;        /* centre, pixels */
    int32_t a_q30, b_q30, c_q30; /* conic, 1 / px^2; a, c <= 1 / 0.6 */
    int32_t z_q20;               /* depth along the optical axis, scene units */
    uint16_t colour_q7[3];
    uint16_t opacity_q15;
    uint16_t x0, y0, x1, y1; /* inclusive box; outside, alpha < 1/255 */
} t3r_splat;

/* The camera of a render in the scene's frame. */
typedef struct t3r_projection {
    int32_t world_to_camera_q30[9];
    int32_t centre_q20[3];
    int32_t fx_q16, fy_q16, cx_q16, cy_q16;
    /* Bounds of |x / z| and |y / z| in the Jacobian: 1.3 times those of the picture's edge that is farther from the
     * axis */
    int32_t limit_x_q24, limit_y_q24;
    uint32_t width, height;
} t3r_projection;

/* Projects `count` Gaussians to as many splats, in order. z_q20 = 0 marks a culled one; its other fields may hold
 * anything. */
typedef void t3r_project_kernel(const t3r_projection *projection, const t3r_gaussian *gaussians, uint32_t count,
                                t3r_splat *splats);
t3r_project_kernel t3r_project_c;

/* Projects one Gaussian. Returns false when it is culled. */
bool t3r_project(const t3r_projection *projection, const t3r_gaussian *gaussian, t3r_splat *splat);

/* Computes the rows of T, pixels in Q12: the Gaussian's footprint in the image is T T^T + 0.3 I, where the columns of T
 * are the projected columns of its factor. Returns false when the mean is culled. */
bool t3r_footprint_rows(const t3r_projection *projection, const t3r_gaussian *gaussian, int32_t a_q12[3],
                        int32_t b_q12[3]);

#endif
