/* SPDX-License-Identifier: Apache-2.0 */
/* Corners of two views that show the same. */
#ifndef TRIM3R_TOOLS_POSING_MATCHES_H
#define TRIM3R_TOOLS_POSING_MATCHES_H

#include "posing/view.h"

typedef struct pose_match {
    uint32_t a, b;    /* corners of the first and of the second view */
    uint32_t rivalry; /* how nearly another place would have done, 0 .. 256 */
} pose_match;

/* Matches that are each other's best and clearly better than the next place, those with the least rivalry first.
 * `matches` has room for a->count, at most CORNERS_MOST; returns their number. */
uint32_t matches_mutual(const pose_view *a, const pose_view *b, pose_match *matches);

/* The same among the pairs that lie within `pixels` of each other's epipolar line, x_b^T e x_a = 0, with less asked of
 * how alike they look. */
uint32_t matches_along(const pose_view *a, const pose_view *b, const double e[9], double pixels, pose_match *matches);

/* Pixels by which two rays fail x_b^T e x_a = 0, to first order (Sampson); the sign is kept. */
double epipolar_error(const double e[9], const double ray_a[2], const double ray_b[2], double focal);

#endif
