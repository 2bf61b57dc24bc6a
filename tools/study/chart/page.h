/* SPDX-License-Identifier: Apache-2.0 */
/* The report: one HTML file that loads nothing, with every axis, scene and point, and the pictures of the points. */
#ifndef TRIM3R_TOOLS_CHART_PAGE_H
#define TRIM3R_TOOLS_CHART_PAGE_H

#include <stdio.h>

#include "study/chart/names.h"
#include "study/chart/pictures.h"
#include "study/chart/view.h"

/* Starts with the view `first`, which must show something. Returns 0, or -1 when memory ran out midway. The caller
 * checks `out` for write errors. */
int chart_page_write(FILE *out, const chart_points *points, const chart_names *names, const chart_pictures *pictures,
                     const chart_view *first);

#endif
