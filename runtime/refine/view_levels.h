/* SPDX-License-Identifier: Apache-2.0 */
/* Differences in brightness and contrast between a whole view and the other views. */
#ifndef T3R_VIEW_LEVELS_H
#define T3R_VIEW_LEVELS_H

#include <stdint.h>

#include "kernels/scatter.h"

/* Passes before which levels are measured. In the second, colours have been corrected once. */
#define T3R_LEVELLED_PASSES 2u

/* A line for each of r, g, b: at level t the view is offset + slope (t - 128) above the mean of the views. Gains have
 * levelled the exposure ("Between views"); this line covers the rest: shadow, haze and the camera's response curve. */
typedef struct t3r_view_levels {
    int16_t offset_q8[3]; /* levels, at most 32 either way */
    int16_t slope_q14[3]; /* at most 1/4 either way */
} t3r_view_levels;

/* Sums over the counted pixels, fewer than 2^24. t is the target minus 128 levels, r the remaining residual. */
typedef struct t3r_level_sums {
    uint32_t pixels;
    int64_t target_q4[3], squares_q8[3], missing_q4[3], products_q8[3]; /* of t, t^2, r, r t */
} t3r_level_sums;

/* Adds the sums of a drawn and compared tile. */
void t3r_add_levels(const t3r_wanted *tile, const t3r_view_levels *levels, t3r_level_sums *sums);

/* Adds the sums of other tiles. */
void t3r_join_levels(t3r_level_sums *sums, const t3r_level_sums *others);

/* Fits a line through one view's residuals by least squares. */
t3r_view_levels t3r_fit_levels(const t3r_level_sums *sums);

/* Subtracts the mean of all lines from each: the scene itself corrects the mean. count >= 1. */
void t3r_center_levels(t3r_view_levels *lines, uint32_t count);

/* Adds a line to the levels. */
void t3r_move_levels(t3r_view_levels *levels, const t3r_view_levels *line);

/* Subtracts the view's levels from the tile's residuals. */
void t3r_level_residuals(t3r_wanted *tile, const t3r_view_levels *levels);

#endif
