/* Stub for builds without a bounded loss: api/build.c refuses requests that ask for one. */
#include "budget_choice.h"

#if !T3R_FEATURE_LOSS

t3r_status t3r_choose_budget(t3r_runtime *rt, t3r_view *views, uint32_t max_loss_q8, t3r_build *build,
                             const t3r_importance *importance)
{
    (void)rt;
    (void)views;
    (void)max_loss_q8;
    (void)build;
    (void)importance;
    return T3R_ERR_UNSUPPORTED;
}

#endif
