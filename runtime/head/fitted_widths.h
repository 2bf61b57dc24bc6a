/* SPDX-License-Identifier: Apache-2.0 */
/* Widths of splats on surfaces that several views cover. */
#ifndef T3R_FITTED_WIDTHS_H
#define T3R_FITTED_WIDTHS_H

#include "head.h"

/* Scales a splat's covariance by 1.15 / (r^0.6 d^0.25), fitted to the training scenes with 2 to 100 % kept. The head
 * `analytic` makes splats wide enough for the retained points of their own view; retained points of other views on the
 * same surface fill the same gaps. r is the density of the retained points of all views about the pixel over that of
 * its own view, at least 1. d is the density of its own view's points over the mean: where the budget places few
 * points the surface is smooth, so a wide splat leaves no gap and blurs nothing. Another view counts if the pixel's
 * point falls on one of its pixels with depth, at most 1/8 off, that is not deferred. The pixel must have a depth. At
 * most one projection for each other view. */
void t3r_fit_widths(const t3r_head_input *input, uint32_t u, uint32_t v, t3r_footprint *footprint);

/* Returns log2 of the share of all points that are not deferred which the budget retains, Q10, at most 0. */
int32_t t3r_mean_density_q10(const t3r_budget_settings *settings, const t3r_cluster *clusters);

/* Fits widths if the settings ask for it, a constant false in builds that do not compare views. */
static inline void t3r_fit_widths_if_asked(const t3r_head_input *input, uint32_t u, uint32_t v,
                                           t3r_footprint *footprint)
{
    if (T3R_FEATURE_COMPARISON && input->covering != NULL) {
        t3r_fit_widths(input, u, v, footprint);
    }
}

#endif
