/* SPDX-License-Identifier: Apache-2.0 */
/* One chart: quality against one cost, over all scenes or within one, ready to draw. */
#ifndef TRIM3R_TOOLS_CHART_VIEW_H
#define TRIM3R_TOOLS_CHART_VIEW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "study/chart/axis.h"
#include "study/chart/points.h"

typedef struct chart_choice {
    chart_measure quality, cost;
    uint32_t scene; /* or CHART_ALL_SCENES */
} chart_choice;

typedef struct chart_spot {
    chart_spread cost, quality;
    bool shown;    /* has both */
    bool complete; /* has both on as many cases as any point has: the front is among these alone */
    bool front;
} chart_spot;

typedef struct chart_view {
    chart_choice choice;
    chart_axis x, y;   /* cost, quality */
    chart_spot *spots; /* one a point */
    uint32_t shown;
    uint32_t *front; /* points, from the cheapest to the best */
    uint32_t front_count;
    uint32_t cases; /* that a complete point has */
} chart_view;

/* 0, or -1 without memory. Nothing to show is no failure: `shown` is 0, and the axes mean nothing. */
int chart_view_make(chart_view *view, const chart_points *points, chart_choice choice);
void chart_view_free(chart_view *view);

/* Whether any cell has the measure. */
bool chart_points_have(const chart_points *points, chart_measure measure);

#endif
