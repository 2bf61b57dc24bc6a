/* SPDX-License-Identifier: Apache-2.0 */
/* The points of a chart: one for each way of building a scene, over the cases measured. */
#ifndef TRIM3R_TOOLS_CHART_POINTS_H
#define TRIM3R_TOOLS_CHART_POINTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "study/chart/table.h"

#define CHART_POINTS_MOST 2000u
#define CHART_ALL_SCENES UINT32_MAX

/* One case of one point. Rows with equal settings and case are repeated measurements; the cell is their mean. */
typedef struct chart_cell {
    uint32_t point, scene_case;
    uint32_t picture, file; /* of the first such row that has a picture */
    double value[CHART_MEASURES];
} chart_cell;

typedef struct chart_point {
    uint32_t setting[CHART_SETTINGS]; /* numbers in the table's texts */
    uint32_t series;
    uint32_t first_cell, cell_count; /* in the order of the table's cases */
} chart_point;

/* Points that differ only in the budget. */
typedef struct chart_series {
    uint32_t first_point, point_count; /* by falling budget; budgets that are not numbers come last */
} chart_series;

typedef struct chart_points {
    const chart_table *table;
    chart_point *points; /* series after series, series in order of first appearance */
    uint32_t count;
    chart_series *series;
    uint32_t series_count;
    chart_cell *cells;
    uint32_t cell_count;
    struct chart_measured *measured; /* scratch of chart_points_spread(), one per cell of a point */
    double *ascending;
} chart_points;

typedef struct chart_spread {
    double mean;              /* over scenes, each the mean over its cases; NaN without any */
    double low, median, high; /* quartiles over all cases, interpolated */
    uint32_t cases;           /* cases with a value */
} chart_spread;

/* Returns 0, or -1 with a reason in error[]: more than CHART_POINTS_MOST points, or out of memory. `table` must
 * outlive `points`. */
int chart_points_make(chart_points *points, const chart_table *table, char *error, size_t error_bytes);
void chart_points_free(chart_points *points);

/* Returns the spread of a measure over all scenes (CHART_ALL_SCENES) or for one. */
chart_spread chart_points_spread(const chart_points *points, uint32_t point, chart_measure measure, uint32_t scene);

/* Returns the quantile q (0..1) of `count` >= 1 ascending values. */
double chart_quantile(const double *ascending, uint32_t count, double q);

#endif
