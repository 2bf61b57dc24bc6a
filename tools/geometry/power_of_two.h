/* SPDX-License-Identifier: Apache-2.0 */
/* ldexp(1, exponent) for a page's module, which has no library of mathematics. */
#ifndef TRIM3R_TOOLS_POWER_OF_TWO_H
#define TRIM3R_TOOLS_POWER_OF_TWO_H

/* Returns 2^exponent, for -1,000 to 1,000. */
static inline double power_of_two(int exponent)
{
    double power = 1;
    for (; exponent > 0; exponent--) {
        power *= 2;
    }
    for (; exponent < 0; exponent++) {
        power /= 2;
    }
    return power;
}

#endif
