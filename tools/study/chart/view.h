/* SPDX-License-Identifier: Apache-2.0 */
/* One chart, ready to draw: quality against one cost, over all scenes or for one scene. */
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
    bool shown;    /* has both measures */
    bool complete; /* has both on as many cases as any point; only complete points can be on the front */
    bool front;
} chart_spot;

typedef struct chart_view {
    chart_choice choice;
    chart_axis x, y;   /* cost, quality */
    chart_spot *spots; /* one per point */
    uint32_t shown;
    uint32_t *front; /* points on the front, from the cheapest to the best */
    uint32_t front_count;
    uint32_t cases; /* number of cases of a complete point */
} chart_view;

/* Returns 0, or -1 if out of memory. An empty chart is no error: `shown` is 0, and the axes are undefined. */
int chart_view_make(chart_view *view, const chart_points *points, chart_choice choice);
void chart_view_free(chart_view *view);

/* Whether any cell has the measure. */
bool chart_points_have(const chart_points *points, chart_measure measure);

#endif
