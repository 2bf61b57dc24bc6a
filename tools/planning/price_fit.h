/* Fits prices to times: each time is the sum over all kinds of units times price. */
#ifndef TRIM3R_TOOLS_PRICE_FIT_H
#define TRIM3R_TOOLS_PRICE_FIT_H

#include <stdint.h>

#define PRICE_FIT_KINDS 10u /* most */
#define PRICE_FIT_TIMES 32u /* most */

typedef struct price_fit {
    uint32_t kinds, times;
    double units[PRICE_FIT_TIMES][PRICE_FIT_KINDS]; /* at least 0 */
    double seconds[PRICE_FIT_TIMES];                /* above 0 */
} price_fit;

/* Finds prices of at least 0 that minimise the sum of the squared relative errors of the times. A kind without any unit
 * gets 0. Returns the largest of these errors. */
double price_fit_solve(const price_fit *fit, double prices[PRICE_FIT_KINDS]);

#endif
