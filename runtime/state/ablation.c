/* SPDX-License-Identifier: Apache-2.0 */
#include "ablation.h"

#include "state.h"

t3r_status t3r_set_ablation(t3r_runtime *rt, const t3r_ablation *ablation)
{
    T3R_REFUSE_UNLESS(rt != NULL, T3R_ERR_ARGUMENT);
    T3R_REFUSE_UNLESS(T3R_FEATURE_EXTRAS || ablation == NULL, T3R_ERR_UNSUPPORTED);
    rt->ablation = ablation != NULL ? *ablation : (t3r_ablation){0};
    return T3R_OK;
}
