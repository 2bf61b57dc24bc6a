/* Surfaces of a view by one over depth, which along a plane is linear in the picture (SPEC.md, "Stereo: surfaces"). */
#ifndef T3R_SURFACE_H
#define T3R_SURFACE_H

#include <stdint.h>

/* One over a depth in steps, Q30: at most that of 64 steps */
#define T3R_INVERSE_MOST (1 << 24)

/* Sums over pixels that have depth: x and y count from any place, i is one over depth. */
typedef struct t3r_surface_sums {
    int64_t n, x, y, i, xx, xy, yy, xi, yi;
} t3r_surface_sums;

/* How one over depth grows a pixel to the right and down, Q30 + 8 */
typedef struct t3r_surface_slope {
    int32_t x_q8, y_q8;
} t3r_surface_slope;

/* 2^30 / depth, round-half-up, of a depth that is not 0 */
int64_t t3r_inverse_depth_q30(uint16_t depth);

/* The slopes of the plane through one over depth by least squares. n > 0; n |x| and n |y| below 2^31. spread_q4: square
 * pixels, above 0, that are added to the spread of places, so that what lies in a row or column has little slope
 * across.
 */
t3r_surface_slope t3r_surface_slope_of(const t3r_surface_sums *sums, int32_t spread_q4);

#endif
