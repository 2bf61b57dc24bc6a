/* SPDX-License-Identifier: Apache-2.0 */
/* Stub for builds that do not compare views: core/config.c refuses configurations that ask for fitted widths. */
#include "fitted_widths.h"

#if !T3R_FEATURE_COMPARISON

void t3r_fit_widths(const t3r_head_input *input, uint32_t u, uint32_t v, t3r_footprint *footprint)
{
    (void)input, (void)u, (void)v, (void)footprint;
}

int32_t t3r_mean_density_q10(const t3r_budget_settings *settings, const t3r_cluster *clusters)
{
    (void)settings, (void)clusters;
    return 0;
}

#endif
