/* SPDX-License-Identifier: Apache-2.0 */
/* The report: one HTML file that fetches nothing, with every axis, scene and point, and the pictures behind them. */
#ifndef TRIM3R_TOOLS_CHART_PAGE_H
#define TRIM3R_TOOLS_CHART_PAGE_H

#include <stdio.h>

#include "study/chart/names.h"
#include "study/chart/pictures.h"
#include "study/chart/view.h"

/* Begins with `first`, which has something to show. 0, or -1 when memory ran out on the way; whether `out` took it all
 * is the caller's to ask. */
int chart_page_write(FILE *out, const chart_points *points, const chart_names *names, const chart_pictures *pictures,
                     const chart_view *first);

#endif
