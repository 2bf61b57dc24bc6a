/* SPDX-License-Identifier: Apache-2.0 */
/* Comparison of a view's pixels with another view, and the derivatives by both poses. */
#ifndef T3R_MISALIGNMENT_H
#define T3R_MISALIGNMENT_H

#include "pointmap.h"

/* The unknowns: a rotation about the camera's centre, radians, and a shift, scene units, in the axes of the scene. */
#define T3R_ALIGN_UNKNOWNS 6u
#define T3R_ALIGN_PRODUCTS 21u
#define T3R_ALIGN_BINS 512u /* for differences of -256..255 levels */

/* Luma of a view at a level of the pyramid: the green plane, or its means over 2^level x 2^level pixels. */
typedef struct t3r_luma_level {
    const uint8_t *pixels;
    uint32_t width, height;
    uint32_t level;
} t3r_luma_level;

/* A view as input of alignment. */
typedef struct t3r_aligned_view {
    t3r_pointmap map;
    t3r_luma_level luma;
} t3r_aligned_view;

/* Statistics of a pair's differences in the last round. Differences are taken relative to `middle`; beyond `spread`,
 * weights fall (Huber). */
typedef struct t3r_pair_levels {
    int16_t middle, spread; /* levels; spread 0: unknown so far */
} t3r_pair_levels;

/* The normal equations of one view's six unknowns. */
typedef struct t3r_align_sums {
    int64_t products[T3R_ALIGN_PRODUCTS]; /* of derivatives: upper triangle, row by row */
    int64_t gradient_q4[T3R_ALIGN_UNKNOWNS];
    int64_t squares_q8; /* weighted, of differences */
} t3r_align_sums;

/* Compares every `stride`-th measured pixel of `from` with `to`. Counts the differences in `bins` and, where the pair's
 * levels are known, adds to the sums of both views. Returns the number of compared pixels. */
uint32_t t3r_compare_pair(const t3r_aligned_view *from, const t3r_aligned_view *to, uint32_t stride,
                          const t3r_pair_levels *levels, uint32_t bins[T3R_ALIGN_BINS], t3r_align_sums *of_from,
                          t3r_align_sums *of_to);

/* Returns the median of the counted differences, and as their spread twice the median distance from it, plus 2. */
t3r_pair_levels t3r_levels_of(const uint32_t bins[T3R_ALIGN_BINS], uint32_t count);

#endif
