/* SPDX-License-Identifier: Apache-2.0 */
/* The motion between two views: from colour alone, or with depth. */
#ifndef TRIM3R_TOOLS_POSING_RELATIVE_H
#define TRIM3R_TOOLS_POSING_RELATIVE_H

#include <stddef.h>

#include "posing/fit.h"

typedef struct relative_pose {
    motion motion;       /* from the first camera's axes to the second's; |t| = 1 where metric is false */
    bool metric;         /* |t| is in the depths' unit */
    pose_match *matches; /* the inliers */
    uint32_t count;
    uint32_t tried; /* matches that there were */
    fit_account account;
    double parallax_pixels; /* median over the inliers of what is left of their motion when the rotation is undone */
} relative_pose;

/* Five-point hypotheses on random fives (from a fixed seed, a bounded number), the best ones refined. `matches` are
 * those of matches_mutual(). 0, or -1 with what is wrong in error[]: too few matches, no parallax, two motions that
 * explain them equally, an unsure direction. relative_free() in either case. */
int relative_by_colour(const pose_view *a, const pose_view *b, const pose_match *matches, uint32_t count,
                       relative_pose *out, char *error, size_t error_bytes);

/* The same for two views with depth: alignments of random threes of points (Kabsch), refined on projections. */
int relative_by_depth(const pose_view *a, const pose_view *b, const pose_match *matches, uint32_t count,
                      relative_pose *out, char *error, size_t error_bytes);

void relative_free(relative_pose *pose);

/* Depths of a match in both cameras by the midpoint of its rays; false where they meet behind one or nowhere near. */
bool relative_triangulate(const motion *m, const double ray_a[2], const double ray_b[2], double *depth_a,
                          double *depth_b);

#endif
