/* How wide a splat is where several views cover its surface. */
#ifndef T3R_FITTED_WIDTHS_H
#define T3R_FITTED_WIDTHS_H

#include "head.h"

/* A closed form makes splats as wide as the retained points of their own view ask for. Where other views have retained
 * points of the surface too, these fill the same gaps. r is the density of the retained points of all views about the
 * pixel over that of its own view, at least 1. The covariance is multiplied by 1.15 / r^0.6: fitted to the training
 * scenes, 2 to 100 % kept. Another view counts where the pixel's point falls on one that has depth, at most 1/8 off,
 * and is not deferred. The pixel must have a depth. At most one projection for each other view. */
void t3r_fit_widths(const t3r_head_input *input, uint32_t u, uint32_t v, t3r_footprint *footprint);

/* Nothing unless the settings ask for it. The compiler knows that they do not where views are not compared. */
static inline void t3r_fit_widths_if_asked(const t3r_head_input *input, uint32_t u, uint32_t v,
                                           t3r_footprint *footprint)
{
    if (T3R_FEATURE_COMPARISON && input->covering != NULL) {
        t3r_fit_widths(input, u, v, footprint);
    }
}

#endif
