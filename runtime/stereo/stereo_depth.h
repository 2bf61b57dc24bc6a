/* From disparities in rectified planes to depth at a view's pixels. */
#ifndef T3R_STEREO_DEPTH_H
#define T3R_STEREO_DEPTH_H

#include <stdint.h>

#include "core/workers.h"
#include "rectify.h"
#include "state/views.h"

/* A matched pair of planes. */
typedef struct t3r_stereo_planes {
    const t3r_rectification *rect;
    int32_t first; /* the disparity of k = 0, pixels */
    uint32_t disparities;
    int32_t begin_q16[2];   /* where the planes' columns begin, as t3r_rectified_column() counts */
    uint32_t columns[2];    /* their widths */
    uint16_t *disparity[2]; /* as match.h has them */
    uint8_t *confidence[2];
    bool filled;    /* disparities of confidence 0 are those of their surroundings; else they mean nothing */
    uint32_t steps; /* depth steps a baseline */
} t3r_stereo_planes;

/* The depth unit with which 63 of 64 surely matched pixels are nearer than 60,000 steps. T3R_PAIR_OVERLAP: less than
 * 1/25 matched surely; T3R_PAIR_PARALLAX: three of four of these less than half a pixel from where infinity is;
 * T3R_PAIR_SCALE. */
t3r_pair t3r_stereo_unit(const t3r_kernels *kernels, t3r_stereo_planes *planes, const t3r_view views[2],
                         uint64_t *depth_unit_q40);

/* Fills depth and match confidence of a view, whose rows the workers share; after t3r_stereo_unit(). */
void t3r_stereo_to_view(const t3r_kernels *kernels, const t3r_stereo_planes *planes, uint32_t side,
                        const t3r_view *view, const t3r_workers *workers);

#endif
