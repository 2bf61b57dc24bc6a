/* What a view as a whole shows brighter, or with more contrast, than the other views do. */
#ifndef T3R_VIEW_LEVELS_H
#define T3R_VIEW_LEVELS_H

#include <stdint.h>

#include "kernels/scatter.h"

/* Passes before which levels are measured: the second one sees colours that the first has corrected. */
#define T3R_LEVELLED_PASSES 2u

/* Of r, g, b: a level t of the view stands offset + slope (t - 128) above what the views in the mean show there.
 * Exposure is levelled by gains before ("Between views"); what gains leave is shadow, haze and a camera's curve. */
typedef struct t3r_view_levels {
    int16_t offset_q8[3]; /* levels, at most 32 either way */
    int16_t slope_q14[3]; /* at most 1/4 either way */
} t3r_view_levels;

/* Of the pixels that count, below 2^24 of them: t is the target less 128 levels, r what is still missing. */
typedef struct t3r_level_sums {
    uint32_t pixels;
    int64_t target_q4[3], squares_q8[3], missing_q4[3], products_q8[3]; /* of t, t^2, r, r t */
} t3r_level_sums;

/* Adds a tile that is drawn and compared. */
void t3r_add_levels(const t3r_wanted *tile, const t3r_view_levels *levels, t3r_level_sums *sums);

/* Adds the sums of other tiles. */
void t3r_join_levels(t3r_level_sums *sums, const t3r_level_sums *others);

/* One view's sums become a line through what is missing, by least squares. */
t3r_view_levels t3r_fit_levels(const t3r_level_sums *sums);

/* All lines less the mean of all: that one is the scene's to correct. count >= 1. */
void t3r_center_levels(t3r_view_levels *lines, uint32_t count);

/* Levels move by a line. */
void t3r_move_levels(t3r_view_levels *levels, const t3r_view_levels *line);

/* What the tile lacks, less the view's own levels. */
void t3r_level_residuals(t3r_wanted *tile, const t3r_view_levels *levels);

#endif
