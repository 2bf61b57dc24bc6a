/* SPDX-License-Identifier: Apache-2.0 */
/* Predicts the refinement passes that are best for new views. */
#ifndef T3R_FITTED_PASSES_H
#define T3R_FITTED_PASSES_H

#include <stdbool.h>
#include <stdint.h>

#include "refine.h"
#include "state/state.h"
#include "state/views.h"

/* Predicts the best number of whole passes for new views. A pass brings the Gaussians nearer to the context views, and
 * also to what these views don't share: noise, small errors of poses and depth, reflections. More passes help where
 * each Gaussian covers more pixels and where views agree. Only the disagreement that neighbouring pixels share counts:
 * noise and detail narrower than a pixel differ from pixel to pixel, and a Gaussian of some pixels averages them. The
 * best number is inversely proportional to the root of (share of points retained x shared disagreement), as fitted to
 * the training scenes with 2 to 20 % kept.
 *
 * points >= gaussians > 0: valid and retained points. shared_q8: of t3r_disagreement_q8(), levels^2, 0 counts as 1.
 * most >= 1. Returns 1..most. */
uint32_t t3r_predict_passes(uint32_t points, uint32_t gaussians, uint32_t shared_q8, uint32_t most);

/* Whether a pass over a part of the pixels finds what one over all of them does. It does where views disagree by more
 * than noise and details narrower than a pixel: then neighbours differ alike, and one of them is enough. It does not
 * where views agree, or where a picture has few pixels for its detail.
 *
 * pixels: of a view, at most 2^24. disagreement_q8, shared_q8: of t3r_disagreement_q8(). */
bool t3r_parts_suffice(uint32_t pixels, uint32_t disagreement_q8, int32_t shared_q8);

/* Returns passes over a part of the pixels that do what `whole` >= 1 whole ones do: from three on about 5/4 as many,
 * the last one whole. Fewer stay whole. */
t3r_passes t3r_passes_in_parts(uint32_t whole);

/* Predicts the passes for the scene in the arena, of at most `most` >= 1 whole ones. The structural loss compares
 * neighbours, so its passes are whole. */
t3r_passes t3r_fitted_passes(t3r_runtime *rt, const t3r_view *views, uint32_t most);

#endif
