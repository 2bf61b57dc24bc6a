/* SPDX-License-Identifier: Apache-2.0 */
/* The Pareto front: what nothing else beats in cost and quality at once. */
#ifndef TRIM3R_TOOLS_CHART_FRONT_H
#define TRIM3R_TOOLS_CHART_FRONT_H

#include <stdbool.h>
#include <stdint.h>

typedef struct chart_place {
    double cost, quality; /* less cost and more quality are better; NaN: takes no part */
    uint32_t index;       /* of the caller's */
} chart_place;

/* Moves the front to the beginning, from the cheapest to the best, and returns its size. On the front is a place where
 * none has less cost and at least as much quality, or more quality and at most as much cost: equals are on it
 * together. */
uint32_t chart_front(chart_place *places, uint32_t count);

#endif
