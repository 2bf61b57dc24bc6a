/* Several figures of one thing. */
#ifndef TRIM3R_TOOLS_SPREAD_H
#define TRIM3R_TOOLS_SPREAD_H

#include <stdint.h>

typedef struct spread {
    double median, least, most;
} spread;

/* Of `count` of them, at least one, which are sorted. */
spread spread_of(double *values, uint32_t count);

#endif
