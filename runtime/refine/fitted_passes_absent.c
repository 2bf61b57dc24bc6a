/* Fitted passes where they are left out: no configuration is allowed to ask for them (core/config.c). */
#include "fitted_passes.h"

#if !T3R_FEATURE_LOSS

uint32_t t3r_fitted_passes(t3r_runtime *rt, const t3r_view *views, uint32_t most)
{
    (void)rt;
    (void)views;
    return most;
}

#endif
