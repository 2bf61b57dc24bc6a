/* SPDX-License-Identifier: Apache-2.0 */
/* How well a motion explains matches, and the motion that explains them best. */
#ifndef TRIM3R_TOOLS_POSING_FIT_H
#define TRIM3R_TOOLS_POSING_FIT_H

#include "posing/matches.h"
#include "posing/motion.h"

/* What a motion is measured on. */
typedef struct fit_pair {
    const pose_view *a, *b;
    const pose_match *matches;
    uint32_t count;
    bool metric; /* corners with a depth are projected into the other view, and |t| is sought too; else |t| = 1 */
} fit_pair;

/* A match that a motion misses by more is none of its inliers; pixels of level 0, wider above. Depths are less exact
 * than the places of corners; and the narrower the band about an epipolar line, the fewer wrong matches lie in it. */
#define FIT_PIXELS_DEPTH 2.0
#define FIT_PIXELS_COLOUR 1.2

static inline double fit_pixels(const fit_pair *pair)
{
    return pair->metric ? FIT_PIXELS_DEPTH : FIT_PIXELS_COLOUR;
}

/* Root of the mean square over what a match tells of the motion (from a to b): the epipolar error, or, where a corner
 * has a depth and the pair is metric, the distances from its projections; pixels, divided by the coarser corner's
 * level. */
double fit_error(const fit_pair *pair, uint32_t match, const motion *m);

/* Sum over matches of min(error, fit_pixels())^2: the smaller the better. `inliers` (may be NULL): how many are
 * below. */
double fit_cost(const fit_pair *pair, const motion *m, uint32_t *inliers);

/* How sure the best motion is. */
typedef struct fit_account {
    double pixels;           /* deviation of the inliers' errors */
    double turn_degrees;     /* standard deviation of the rotation, its largest axis */
    double direction_degree; /* of t's direction, likewise */
} fit_account;

/* The least squares of the inliers' errors by Levenberg and Marquardt, inliers chosen anew a few times. 0, or -1 when
 * the inliers do not determine it; *m is then as before. */
int fit_refine(const fit_pair *pair, motion *m, fit_account *account);

#endif
