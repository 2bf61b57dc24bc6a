/* SPDX-License-Identifier: Apache-2.0 */
/* The Pareto front: the places that no other place beats in both cost and quality. */
#ifndef TRIM3R_TOOLS_CHART_FRONT_H
#define TRIM3R_TOOLS_CHART_FRONT_H

#include <stdbool.h>
#include <stdint.h>

typedef struct chart_place {
    double cost, quality; /* less cost and more quality are better; NaN: excluded */
    uint32_t index;       /* set by the caller */
} chart_place;

/* Moves the front to the beginning, from the cheapest to the best, and returns its size. A place is on the front if
 * no other has less cost and at least as much quality, or more quality and at most as much cost. Equal places are on
 * it together. */
uint32_t chart_front(chart_place *places, uint32_t count);

#endif
