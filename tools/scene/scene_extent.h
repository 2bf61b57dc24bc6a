/* SPDX-License-Identifier: Apache-2.0 */
/* Place and size of a scene, by medians, so that a few Gaussians far away change nothing. */
#ifndef TRIM3R_TOOLS_SCENE_EXTENT_H
#define TRIM3R_TOOLS_SCENE_EXTENT_H

#include <stdbool.h>

#include "scene/scene_rows.h"

typedef struct scene_extent {
    double centre[3]; /* median of each coordinate, in the axes of the rows */
    double typical;   /* median distance from the centre, without those at it; less if a tenth is much nearer to it,
                       * or to each other; if all share one place, the size of the largest; > 0 */
    uint32_t finer;   /* near detail needs units of 2^-finer of the typical distance's */
    uint32_t far;     /* Gaussians beyond the reach */
    double harmonics; /* the largest coefficient above degree 0, without its sign */
    double width;     /* median of the Gaussians' largest widths */
    double step;      /* of floats as large as the centre's coordinates, if all positions are floats; else 0 */
    scene_bounds colour, log_scale; /* of all Gaussians */
} scene_extent;

/* The reach of the fixed point, and of formats that share their bits among all Gaussians, in units of the largest power
 * of two in the typical distance. It leaves a margin to 2^10 for the rounding of the origin. */
#define SCENE_REACH 1023

/* Reads every row once. Returns 0, or -1 with the reason in error[], for a row that cannot be read, too. */
int scene_extent_of(const scene_rows *rows, scene_extent *out, char *error, size_t error_bytes);
/* Returns floor(log2) of the typical distance. */
int scene_extent_exponent(const scene_extent *extent);
/* Whether floats lost detail: their step is over half of the width. */
bool scene_extent_is_rounded(const scene_extent *extent);
/* Whether a position of the rows is within the reach. */
bool scene_extent_holds(const scene_extent *extent, const double position[3]);

/* Moves a Gaussian that is farther from the origin than `reach` to that distance, and scales it alike: it looks the
 * same from there. Returns how many times as far it was, at least 1. */
double scene_pull(scene_row *row, double reach);

#endif
