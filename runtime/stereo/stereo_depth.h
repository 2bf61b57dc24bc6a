/* SPDX-License-Identifier: Apache-2.0 */
/* Depth at a view's pixels from disparities in rectified planes. */
#ifndef T3R_STEREO_DEPTH_H
#define T3R_STEREO_DEPTH_H

#include <stdint.h>

#include "core/workers.h"
#include "rectify.h"
#include "state/views.h"

/* A matched pair of planes. */
typedef struct t3r_stereo_planes {
    const t3r_rectification *rect;
    int32_t first; /* disparity of k = 0, pixels */
    uint32_t disparities;
    int32_t begin_q16[2];   /* start of the planes' columns, in the coordinates of t3r_rectified_column() */
    uint32_t columns[2];    /* widths */
    uint16_t *disparity[2]; /* see match.h */
    uint8_t *confidence[2];
    bool filled;    /* disparities of confidence 0 come from the surroundings; otherwise they are undefined */
    uint32_t steps; /* depth steps a baseline */
} t3r_stereo_planes;

/* Chooses the depth unit so that 63 of 64 surely matched pixels are nearer than 60,000 steps. Returns T3R_PAIR_OVERLAP
 * if less than 1/25 matched surely, T3R_PAIR_PARALLAX if three of four of these are less than half a pixel from
 * infinity, or T3R_PAIR_SCALE. */
t3r_pair t3r_stereo_unit(const t3r_kernels *kernels, t3r_stereo_planes *planes, const t3r_view views[2],
                         uint64_t *depth_unit_q40);

/* Fills depth and match confidence of a view; workers share its rows. Call it after t3r_stereo_unit(). */
void t3r_stereo_to_view(const t3r_kernels *kernels, const t3r_stereo_planes *planes, uint32_t side,
                        const t3r_view *view, const t3r_workers *workers);

#endif
