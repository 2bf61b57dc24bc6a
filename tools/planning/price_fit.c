#include "planning/price_fit.h"

#include <math.h>

#define SWEEPS 20000u

/* Minimises | A x - 1 |^2, x >= 0, by coordinate descent, where row i of A has the units of time i divided by that
 * time. The kinds are few and the sum is convex, so the sweeps converge to the minimum. */
double price_fit_solve(const price_fit *fit, double prices[PRICE_FIT_KINDS])
{
    double left[PRICE_FIT_TIMES], norm[PRICE_FIT_KINDS] = {0}; /* 1 - A x; squared length of each column */
    for (uint32_t k = 0; k < fit->kinds; k++) {
        prices[k] = 0;
        for (uint32_t i = 0; i < fit->times; i++) {
            const double a = fit->units[i][k] / fit->seconds[i];
            norm[k] += a * a;
        }
    }
    for (uint32_t i = 0; i < fit->times; i++) {
        left[i] = 1;
    }
    for (uint32_t sweep = 0; sweep < SWEEPS; sweep++) {
        for (uint32_t k = 0; k < fit->kinds; k++) {
            if (norm[k] <= 0) {
                continue;
            }
            double slope = 0;
            for (uint32_t i = 0; i < fit->times; i++) {
                slope += left[i] * fit->units[i][k] / fit->seconds[i];
            }
            const double to = fmax(0, prices[k] + slope / norm[k]), by = to - prices[k];
            prices[k] = to;
            for (uint32_t i = 0; i < fit->times; i++) {
                left[i] -= by * fit->units[i][k] / fit->seconds[i];
            }
        }
    }
    double worst = 0;
    for (uint32_t i = 0; i < fit->times; i++) {
        worst = fmax(worst, fabs(left[i]));
    }
    return worst;
}
