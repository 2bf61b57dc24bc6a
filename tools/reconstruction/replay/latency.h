/* SPDX-License-Identifier: Apache-2.0 */
/* The times that frames take: how they are spread. */
#ifndef TRIM3R_TOOLS_LATENCY_H
#define TRIM3R_TOOLS_LATENCY_H

#include <stdint.h>

typedef struct latency {
    double median, most, worst; /* ms; `most`: 95 % of the frames take no longer */
    double rate;                /* frames a second, one after the other */
} latency;

/* Sorts `count` times in ms, at least one, and returns their spread. */
latency latency_of(double *milliseconds, uint32_t count);

#endif
