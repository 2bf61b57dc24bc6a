/* SPDX-License-Identifier: Apache-2.0 */
#include "bench/spread.h"

#include <stdlib.h>

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

spread spread_of(double *values, uint32_t count)
{
    qsort(values, count, sizeof *values, compare_doubles);
    return (spread){(values[(count - 1) / 2] + values[count / 2]) / 2, values[0], values[count - 1]};
}
