/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/summary/splat_scales.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/gaussian_shape.h"

#define OUTLIERS 0.001 /* share at either end that does not extend the bins */

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double scale_of(const t3r_gaussian *gaussian)
{
    gaussian_shape shape = gaussian_shape_of(gaussian);
    double thinnest = fmin(shape.scale[0], fmin(shape.scale[1], shape.scale[2]));
    return sqrt(shape.scale[0] * shape.scale[1] * shape.scale[2] / thinnest); /* at least 2^-80, so never 0 */
}

bool splat_scales_of(splat_scales *scales, const scene_file *scene)
{
    *scales = (splat_scales){.scale = malloc(((size_t)scene->count + 1) * sizeof(double)), .count = scene->count};
    if (scales->scale == NULL) {
        return false;
    }
    for (uint32_t i = 0; i < scene->count; i++) {
        scales->scale[i] = ldexp(scale_of(&scene->gaussians[i]), scene->frame.exponent);
    }
    qsort(scales->scale, scales->count, sizeof *scales->scale, ascending);
    return true;
}

void splat_scales_free(splat_scales *scales)
{
    free(scales->scale);
    *scales = (splat_scales){0};
}

double splat_scales_quantile(const splat_scales *scales, double share)
{
    double place = share * (scales->count - 1), below = floor(place);
    uint32_t at = (uint32_t)below, next = at + 1 < scales->count ? at + 1 : at;
    return scales->scale[at] + (place - below) * (scales->scale[next] - scales->scale[at]);
}

static int bin_of(double scale)
{
    return (int)floor(log2(scale) * SCALE_BINS_AN_OCTAVE);
}

scale_bins scale_bins_of(const splat_scales *list, uint32_t count)
{
    int first = INT_MAX, last = INT_MIN;
    for (uint32_t i = 0; i < count; i++) {
        int low = bin_of(splat_scales_quantile(&list[i], OUTLIERS));
        int high = bin_of(splat_scales_quantile(&list[i], 1 - OUTLIERS));
        first = low < first ? low : first;
        last = high > last ? high : last;
    }
    first = last - first >= (int)SCALE_BINS_MOST ? last - (int)SCALE_BINS_MOST + 1 : first;
    return (scale_bins){.first = first, .count = (uint32_t)(last - first + 1)};
}

double scale_bins_edge(const scale_bins *bins, uint32_t index)
{
    return exp2((double)(bins->first + (int)index) / SCALE_BINS_AN_OCTAVE);
}

void scale_bins_fill(const scale_bins *bins, const splat_scales *scales, uint32_t counts[SCALE_BINS_MOST])
{
    memset(counts, 0, SCALE_BINS_MOST * sizeof *counts);
    for (uint32_t i = 0; i < scales->count; i++) {
        int bin = bin_of(scales->scale[i]) - bins->first;
        counts[bin < 0 ? 0 : bin >= (int)bins->count ? (int)bins->count - 1 : bin]++;
    }
}
