/* SPDX-License-Identifier: Apache-2.0 */
/* The rim: two rings of wide Gaussians around the picture of each context view, in the colours of its border. They lie
 * four times as far away as the surfaces there, and behind all that a context view shows. So a view beside the context
 * views, and a gap between near surfaces, is not black. They have no depth, and refinement corrects their colours alone
 * (SPEC.md, "Rim"). */
#ifndef T3R_RIM_H
#define T3R_RIM_H

#include "state/state.h"
#include "state/views.h"

#define T3R_RIM_MOST_SEGMENTS 4u /* along a side of a picture, in the inner ring; half as many in the outer */

/* The least budget of a whole rim: 16 times its Gaussians. From half of that on there is half a rim. */
#define T3R_RIM_BUDGET(views) (16u * 4 * (T3R_RIM_MOST_SEGMENTS + T3R_RIM_MOST_SEGMENTS / 2) * (views))

/* Writes the rim's Gaussians, at most 24 a view, and returns their number; out NULL only counts them. Their number
 * follows from the budget, the depth and the poses, so it is known before points are chosen. */
uint32_t t3r_make_rim(const t3r_runtime *rt, const t3r_view *views, t3r_gaussian *out);

#endif
