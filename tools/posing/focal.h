/* SPDX-License-Identifier: Apache-2.0 */
/* The focal length of pictures that nothing states it of. */
#ifndef TRIM3R_TOOLS_POSING_FOCAL_H
#define TRIM3R_TOOLS_POSING_FOCAL_H

#include <stdbool.h>
#include <stdint.h>

#include "posing/view.h"

#define FOCAL_USUAL 0.8 /* of the longer side: a lens of 28 mm, as most phones have */

/* Estimates the focal length that all views share, of which their rays assume FOCAL_USUAL of the longer side, and
 * corrects the rays. It is the one with which the motions of some pairs explain most of their matches; lengths near the
 * usual one win where the pairs do not decide. Returns the factor to the assumed length, 1 where no pair has enough
 * matches. Deterministic. */
double focal_estimate(pose_view *views, uint32_t count);

#endif
