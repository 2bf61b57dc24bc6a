/* SPDX-License-Identifier: Apache-2.0 */
/* Stub for builds without fitted passes: core/config.c refuses configurations that ask for them. */
#include "fitted_passes.h"

#if !T3R_FEATURE_LOSS

t3r_passes t3r_fitted_passes(t3r_runtime *rt, const t3r_view *views, uint32_t most)
{
    (void)rt;
    (void)views;
    return (t3r_passes){most, 0};
}

#endif
