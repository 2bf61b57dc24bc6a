/* SPDX-License-Identifier: Apache-2.0 */
/* Predicts the number of refinement passes that is best for new views. */
#ifndef T3R_FITTED_PASSES_H
#define T3R_FITTED_PASSES_H

#include <stdint.h>

#include "state/state.h"
#include "state/views.h"

/* Predicts the best number of passes for new views. A pass brings the Gaussians nearer to the context views, and also
 * to what these views don't share: noise, small errors of poses and depth, reflections. More passes help where each
 * Gaussian covers more pixels and where views agree. The best number is inversely proportional to the root of (share of
 * points retained x the views' disagreement, t3r_disagreement_q8()), as fitted to the training scenes with 2 to 100 %
 * kept.
 *
 * points >= gaussians > 0: valid and retained points. disagreement_q8: levels^2, 0 counts as 1. most >= 1.
 * Returns 1..most. */
uint32_t t3r_predict_passes(uint32_t points, uint32_t gaussians, uint32_t disagreement_q8, uint32_t most);

/* Predicts the passes for the scene in the arena, at most `most` >= 1. */
uint32_t t3r_fitted_passes(t3r_runtime *rt, const t3r_view *views, uint32_t most);

#endif
