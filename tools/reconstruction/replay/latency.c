/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/replay/latency.h"

#include <stdlib.h>

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

latency latency_of(double *milliseconds, uint32_t count)
{
    double sum = 0;
    qsort(milliseconds, count, sizeof *milliseconds, compare_doubles);
    for (uint32_t i = 0; i < count; i++) {
        sum += milliseconds[i];
    }
    return (latency){
        .median = (milliseconds[(count - 1) / 2] + milliseconds[count / 2]) / 2,
        .most = milliseconds[(uint32_t)(((uint64_t)count * 95 + 99) / 100) - 1],
        .worst = milliseconds[count - 1],
        .rate = 1000 * count / sum,
    };
}
