/* How many passes of refinement pay. */
#ifndef T3R_FITTED_PASSES_H
#define T3R_FITTED_PASSES_H

#include <stdint.h>

#include "state/state.h"
#include "state/views.h"

/* A pass brings the Gaussians nearer to the context views, and what these views do not share comes along: noise, poses
 * and depth that are a little off, reflections. New views gain by more passes where each Gaussian answers for more
 * pixels, and where views agree. The best number falls as the root of the share of points that are retained times the
 * views' disagreement (t3r_disagreement_q8): fitted to the training scenes, 2 to 100 % kept.
 *
 * points >= gaussians > 0: valid points, and those retained; disagreement_q8: levels^2, 0 counts as the least above;
 * most >= 1. Returns 1..most. */
uint32_t t3r_predict_passes(uint32_t points, uint32_t gaussians, uint32_t disagreement_q8, uint32_t most);

/* The same of a scene that is made: `most` >= 1 passes are allowed. */
uint32_t t3r_fitted_passes(t3r_runtime *rt, const t3r_view *views, uint32_t most);

#endif
