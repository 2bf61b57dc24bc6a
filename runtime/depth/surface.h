/* SPDX-License-Identifier: Apache-2.0 */
/* Surfaces of a view in terms of one over depth, which is linear in the picture along a plane (SPEC.md, "Stereo:
 * surfaces"). */
#ifndef T3R_SURFACE_H
#define T3R_SURFACE_H

#include <stdint.h>

/* Upper bound of one over depth in steps, Q30: 64 steps. */
#define T3R_INVERSE_MOST (1 << 24)

/* Sums over pixels that have depth. x and y are relative to any fixed place, i is one over depth. */
typedef struct t3r_surface_sums {
    int64_t n, x, y, i, xx, xy, yy, xi, yi;
} t3r_surface_sums;

/* Change of one over depth a pixel to the right and down, Q30 + 8. */
typedef struct t3r_surface_slope {
    int32_t x_q8, y_q8;
} t3r_surface_slope;

/* Returns 2^30 / depth, round-half-up, at most T3R_INVERSE_MOST. depth > 0. */
int64_t t3r_inverse_depth_q30(uint16_t depth);

/* Fits a plane to one over depth by least squares and returns its slopes. n > 0; n |x| and n |y| below 2^31.
 * spread_q4: square pixels, above 0, added to the spread of places, so that pixels in a single row or column give
 * little slope across. */
t3r_surface_slope t3r_surface_slope_of(const t3r_surface_sums *sums, int32_t spread_q4);

#endif
