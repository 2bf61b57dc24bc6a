/* SPDX-License-Identifier: Apache-2.0 */
/* Stage image, second part: the pinhole image of the same intrinsics, through a coarse grid of source positions.
 *
 * A grid has a node every T3R_GRID_STEP pixels, (width / step + 2) x (height / step + 2) nodes row by row, each two
 * int32: the source x and y in pixels, Q16. A node outside the lens (beyond the fold of its polynomial, or out of
 * range) is T3R_GRID_OUTSIDE twice, and the cells that touch it show nothing. */
#ifndef T3R_UNDISTORT_H
#define T3R_UNDISTORT_H

#include <stdint.h>

#include "trim3r.h"

#define T3R_GRID_OUTSIDE INT32_MIN

/* Number of int32 in a grid for an image of that size. */
#define T3R_GRID_VALUES(width, height) (2 * T3R_GRID_NODES_(width, height))

/* Fills the grid for a checked camera of a width x height image (t3r_camera_resized). Returns T3R_ERR_CAMERA if fewer
 * than half of the nodes are inside: no real lens has such coefficients. */
t3r_status t3r_undistort_grid(const t3r_camera *camera, uint32_t width, uint32_t height, int32_t *grid);

/* Undistorts colour with bilinear samples; 0 where the source position's nearest pixel is outside. source and out are
 * different planes of width x height. */
void t3r_undistort_colour(const int32_t *grid, uint32_t width, uint32_t height, uint32_t begin, uint32_t end,
                          const uint8_t *const source[3], uint8_t *const out[3]);

/* Undistorts depth by the nearest pixel; 0, "no depth", where that pixel is outside, which later stages need not know
 * otherwise. */
void t3r_undistort_depth(const int32_t *grid, uint32_t width, uint32_t height, uint32_t begin, uint32_t end,
                         const uint16_t *source, uint16_t *out);

#endif
