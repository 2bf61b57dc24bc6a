/* SPDX-License-Identifier: Apache-2.0 */
/* How wide a splat is where several views cover its surface. */
#ifndef T3R_FITTED_WIDTHS_H
#define T3R_FITTED_WIDTHS_H

#include "head.h"

/* The head `analytic` makes splats as wide as the retained points of their own view ask for. Where other views have
 * retained points of the surface too, these fill the same gaps. r is the density of the retained points of all views
 * about the pixel over that of its own view, at least 1. Where points are few for the budget, the surface is smooth,
 * and a wide splat blurs nothing but leaves no gap. d is the density of the own view's points over the mean. The
 * covariance is multiplied by 1.15 / (r^0.6 d^0.25): fitted to the training scenes, 2 to 100 % kept. Another view
 * counts where the pixel's point falls on one that has depth, at most 1/8 off, and is not deferred. The pixel must have
 * a depth. At most one projection for each other view. */
void t3r_fit_widths(const t3r_head_input *input, uint32_t u, uint32_t v, t3r_footprint *footprint);

/* log2 of the share of all points that are not deferred that the budget retains, Q10, at most 0. */
int32_t t3r_mean_density_q10(const t3r_budget_settings *settings, const t3r_cluster *clusters);

/* Nothing unless the settings ask for it. The compiler knows that they do not where views are not compared. */
static inline void t3r_fit_widths_if_asked(const t3r_head_input *input, uint32_t u, uint32_t v,
                                           t3r_footprint *footprint)
{
    if (T3R_FEATURE_COMPARISON && input->covering != NULL) {
        t3r_fit_widths(input, u, v, footprint);
    }
}

#endif
