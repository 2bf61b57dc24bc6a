/* SPDX-License-Identifier: Apache-2.0 */
/* Predicts the budget that a loss allows from two small trial scenes and the disagreement of the context views
 * (SPEC.md, "Budget within a loss"). */
#ifndef T3R_BUDGET_CHOICE_H
#define T3R_BUDGET_CHOICE_H

#include <stdint.h>

#include "budget/importance.h"
#include "state/state.h"
#include "trim3r.h"

/* Inputs of the prediction. */
typedef struct t3r_budget_evidence {
    uint32_t points;          /* valid points, 1..2^28 */
    uint32_t trial;           /* Gaussians of the first trial scene, 1..2^23; the second has twice as many */
    uint32_t error_q8[2];     /* of the trial scenes against the context views, levels^2, at most 2^24 */
    uint32_t disagreement_q8; /* of the context views as given, levels^2, at most 2^24; 0 = nothing to compare */
} t3r_budget_evidence;

/* Predicts the smallest number of Gaussians that loses less than max_loss_q8 dB (1..T3R_MAX_LOSS_Q8) against all
 * points, 1..most. */
uint32_t t3r_predict_budget(const t3r_budget_evidence *evidence, uint32_t most, uint32_t max_loss_q8);

/* Returns the disagreement of the analysed views with the given poses, levels^2 Q8; 0: nothing to compare. New views
 * come with given poses, which nothing aligns. The views' poses are restored before it returns. */
uint32_t t3r_disagreement_as_given_q8(t3r_runtime *rt, t3r_view *views);

/* Lowers build->gaussians to the prediction for the analysed views. Builds two trial scenes in the arena, each of at
 * most 1/50 of the points. importance: for the allocation `given`, else NULL. The views' poses are restored before it
 * returns. With T3R_ERR_CANCELLED, `build` is unchanged. */
t3r_status t3r_choose_budget(t3r_runtime *rt, t3r_view *views, uint32_t max_loss_q8, t3r_build *build,
                             const t3r_importance *importance);

#endif
