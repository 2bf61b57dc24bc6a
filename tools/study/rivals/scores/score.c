/* SPDX-License-Identifier: Apache-2.0 */
#include "study/rivals/scores/score.h"

bool score_of(method_kind kind, const splat_model *model, const splat_view *views, uint32_t view_count, uint32_t seed,
              double *score)
{
    switch (kind) {
    case METHOD_EAGLES:
        return score_eagles(model, views, view_count, score);
    case METHOD_LIGHTGAUSSIAN:
        return score_lightgaussian(model, views, view_count, score);
    case METHOD_PUP:
        return score_pup(model, views, view_count, score);
    case METHOD_EFFICIENTGS:
        return score_efficientgs(model, views, view_count, score);
    default:
        return score_random(model, seed, score);
    }
}
