/* SPDX-License-Identifier: Apache-2.0 */
/* Histograms of splat scales as an SVG: a panel per scene, one below the other, with the same logarithmic axis. */
#ifndef TRIM3R_TOOLS_SCALE_PICTURE_H
#define TRIM3R_TOOLS_SCALE_PICTURE_H

#include <stdio.h>

#include "scene/summary/splat_scales.h"

typedef struct scale_panel {
    const char *name;
    const splat_scales *scales;
} scale_panel;

/* Writes the picture, readable on light and dark backgrounds. pixels: size of a world unit at the median depth, for a
 * second axis; 0 = none. Write errors stay in the stream (ferror). */
void scale_picture_write(FILE *file, const scale_panel *panels, uint32_t count, const scale_bins *bins, double pixels);

#endif
