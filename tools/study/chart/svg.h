/* SPDX-License-Identifier: Apache-2.0 */
/* Charts as one SVG picture: one panel per view, the legend below, settings as tooltips. */
#ifndef TRIM3R_TOOLS_CHART_SVG_H
#define TRIM3R_TOOLS_CHART_SVG_H

#include <stdint.h>
#include <stdio.h>

#include "study/chart/names.h"
#include "study/chart/view.h"

typedef enum chart_ground { CHART_GROUND_READER, CHART_GROUND_LIGHT, CHART_GROUND_DARK } chart_ground;

/* Writes `count` views of one quality and one choice of scenes, each with something to show. CHART_GROUND_READER
 * follows the reader's light or dark setting. The caller checks `out` for write errors. */
void chart_svg_write(FILE *out, const chart_points *points, const chart_names *names, const chart_view *views,
                     uint32_t count, chart_ground ground);

#endif
