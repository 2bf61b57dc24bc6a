/* SPDX-License-Identifier: Apache-2.0 */
/* SVG to PNG, by the program rsvg-convert. */
#ifndef TRIM3R_TOOLS_CHART_RASTER_H
#define TRIM3R_TOOLS_CHART_RASTER_H

#include <stddef.h>

/* Draws the SVG text at `scale` times its stated size and writes it to `path`. Returns 0, or -1 with a reason in
 * error[]. */
int chart_raster_png(const char *path, const char *svg, size_t bytes, double scale, char *error, size_t error_bytes);

#endif
