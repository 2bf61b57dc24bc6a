/* Prices that explain times: each time is a sum of units times the price of their kind. */
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

/* Prices of at least 0 with which the sum of the squared relative errors of the times is least. A kind without any unit
 * gets 0. Returns the largest of these errors. */
double price_fit_solve(const price_fit *fit, double prices[PRICE_FIT_KINDS]);

#endif
