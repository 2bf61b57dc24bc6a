/* SPDX-License-Identifier: Apache-2.0 */
/* Widths of the Gaussians of a scene: order statistics and bins of a logarithm (a histogram as in GaussianTrim3R's
 * Figure 6). Scale here means the root of the product of a Gaussian's two largest standard deviations: the radius of a
 * disc that covers as much of a surface, whatever the thickness along the normal. */
#ifndef TRIM3R_TOOLS_SPLAT_SCALES_H
#define TRIM3R_TOOLS_SPLAT_SCALES_H

#include <stdbool.h>
#include <stdint.h>

#include "scene/scene_file.h"

#define SCALE_BINS_AN_OCTAVE 4
#define SCALE_BINS_MOST 96u

typedef struct splat_scales {
    double *scale;  /* world units, ascending; heap */
    uint32_t count; /* at least 1 */
} splat_scales;

/* Computes the scales of a non-empty scene. False without memory; splat_scales_free() is due in any case. */
bool splat_scales_of(splat_scales *scales, const scene_file *scene);
void splat_scales_free(splat_scales *scales);

/* Returns the quantile at share 0..1, linear between neighbours. */
double splat_scales_quantile(const splat_scales *scales, double share);

/* Bin i holds scales from 2^((first + i) / 4) to below 2^((first + i + 1) / 4) world units; the first also holds
 * smaller ones, the last larger ones. */
typedef struct scale_bins {
    int first;
    uint32_t count; /* 1..SCALE_BINS_MOST */
} scale_bins;

/* Returns bins for all of `list` (count at least 1): from the least of their quantiles at 0.001 to the largest at
 * 0.999, limited to the upper 24 octaves. */
scale_bins scale_bins_of(const splat_scales *list, uint32_t count);
double scale_bins_edge(const scale_bins *bins, uint32_t index);
void scale_bins_fill(const scale_bins *bins, const splat_scales *scales, uint32_t counts[SCALE_BINS_MOST]);

#endif
