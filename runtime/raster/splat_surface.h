/* SPDX-License-Identifier: Apache-2.0 */
/* The surface that a Gaussian is in a view: its mean depth at each pixel (SPEC.md, "Raster": depth). */
#ifndef T3R_SPLAT_SURFACE_H
#define T3R_SPLAT_SURFACE_H

#include <stdint.h>

#include "kernels/project.h"

/* A plane through the mean. One over depth is linear in the picture along it. */
typedef struct t3r_splat_surface {
    int32_t x_q12, y_q12; /* the mean, pixels */
    int32_t z_q20;        /* its depth, above 0 */
    int32_t slope_q24[2]; /* change of depth a pixel to the right and down at the mean, in parts of its depth */
    int32_t most_q24;     /* most change of one over depth, in parts of the mean's: below 1 */
} t3r_splat_surface;

/* Computes the surface of a Gaussian that the projection does not cull, and whose splat is given. */
t3r_splat_surface t3r_splat_surface_of(const t3r_projection *projection, const t3r_gaussian *gaussian,
                                       const t3r_splat *splat);

/* Returns the surface's depth at the centre of a pixel, scene units, 1..2^31 - 1. */
uint32_t t3r_surface_depth_q20(const t3r_splat_surface *surface, uint32_t x, uint32_t y);

#endif
