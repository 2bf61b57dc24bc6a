/* SPDX-License-Identifier: Apache-2.0 */
/* Scales of a chart: map a range of values to 0..1, and choose round, named ticks. */
#ifndef TRIM3R_TOOLS_CHART_AXIS_H
#define TRIM3R_TOOLS_CHART_AXIS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "study/chart/table.h"

#define CHART_TICKS_MOST 12u
#define CHART_LABEL_BYTES 32u

typedef struct chart_tick {
    double value;
    char label[CHART_LABEL_BYTES];
} chart_tick;

typedef struct chart_axis {
    double low, high; /* low < high, both finite; above 0 where logarithmic */
    bool logarithmic; /* if all values are above 0 and the largest is more than five times the smallest */
    bool falling;     /* lower values are better: the axis turns so that better is up */
    chart_tick tick[CHART_TICKS_MOST];
    uint32_t tick_count; /* 2 to CHART_TICKS_MOST, ascending, within the range */
} chart_axis;

/* Returns the axis for finite values from `least` to `most`, with a margin at either end. Qualities are never
 * logarithmic. */
chart_axis chart_axis_make(chart_measure measure, double least, double most);
/* Returns 0 at `low`, 1 at `high`, and values beyond these outside the axis. */
double chart_axis_place(const chart_axis *axis, double value);

/* "31.20 dB", "85 ms", "1.2 s", "3.76 MiB", "0.912"; "-" of NaN. */
void chart_value_text(chart_measure measure, double value, char *text, size_t bytes);

#endif
