/* SPDX-License-Identifier: Apache-2.0 */
#include "trim3r/scene/scene_quality.h"

#include <stdlib.h>

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Returns the lower median PSNR of the pictures that are chosen, or that are not; `none` without any. */
static double median_of(const drawn_picture *pictures, uint32_t count, bool chosen, double none)
{
    double psnr[DRAWN_MOST];
    uint32_t found = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (pictures[i].used == chosen) {
            psnr[found++] = pictures[i].psnr;
        }
    }
    qsort(psnr, found, sizeof *psnr, ascending);
    return found > 0 ? psnr[(found - 1) / 2] : none;
}

scene_quality scene_quality_of(const drawn_picture *pictures, uint32_t count)
{
    uint32_t chosen = 0, poor = 0;
    for (uint32_t i = 0; i < count; i++) {
        chosen += pictures[i].used;
        poor += pictures[i].used && pictures[i].psnr < SCENE_POOR_DB;
    }
    if (4 * poor > chosen) {
        return SCENE_POOR;
    }
    const bool is_good = poor == 0 && median_of(pictures, count, true, 0) >= SCENE_GOOD_DB &&
                         median_of(pictures, count, false, SCENE_GOOD_DB) >= SCENE_POOR_DB;
    return is_good ? SCENE_GOOD : SCENE_FAIR;
}

const char *scene_quality_name(scene_quality quality)
{
    static const char *const names[] = {"poor", "fair", "good"};
    return names[quality];
}
