/* Order statistics of repeated figures. */
#ifndef TRIM3R_TOOLS_SPREAD_H
#define TRIM3R_TOOLS_SPREAD_H

#include <stdint.h>

typedef struct spread {
    double median, least, most;
} spread;

/* Sorts `count` figures, at least one, and returns their spread. */
spread spread_of(double *values, uint32_t count);

#endif
