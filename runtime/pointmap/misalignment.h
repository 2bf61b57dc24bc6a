/* How pixels of one view look in another, and how that changes with both poses. */
#ifndef T3R_MISALIGNMENT_H
#define T3R_MISALIGNMENT_H

#include "pointmap.h"

/* A rotation about the camera's centre, radians, and a shift, scene units, in the axes of the scene. */
#define T3R_ALIGN_UNKNOWNS 6u
#define T3R_ALIGN_PRODUCTS 21u
#define T3R_ALIGN_BINS 512u /* of differences of -256..255 levels */

/* A view's luma at a level of the pyramid: the green plane, or means of 2^level x 2^level of its pixels. */
typedef struct t3r_luma_level {
    const uint8_t *pixels;
    uint32_t width, height;
    uint32_t level;
} t3r_luma_level;

/* What a view is compared by. */
typedef struct t3r_aligned_view {
    t3r_pointmap map;
    t3r_luma_level luma;
} t3r_aligned_view;

/* What the differences of a pair are like, from the round before: differences are counted from `middle`, and beyond
 * `spread` of them with less and less weight (Huber). */
typedef struct t3r_pair_levels {
    int16_t middle, spread; /* levels; a spread of 0: not known yet */
} t3r_pair_levels;

/* The normal equations of one view's six unknowns. */
typedef struct t3r_align_sums {
    int64_t products[T3R_ALIGN_PRODUCTS]; /* of derivatives: the upper triangle, row after row */
    int64_t gradient_q4[T3R_ALIGN_UNKNOWNS];
    int64_t squares_q8; /* of differences, weighted */
} t3r_align_sums;

/* Follows every `stride`-th measured pixel of `from` into `to`. Counts the differences in `bins`, and where the pair's
 * levels are known adds to the sums of both views. Returns the pixels that could be compared. */
uint32_t t3r_compare_pair(const t3r_aligned_view *from, const t3r_aligned_view *to, uint32_t stride,
                          const t3r_pair_levels *levels, uint32_t bins[T3R_ALIGN_BINS], t3r_align_sums *of_from,
                          t3r_align_sums *of_to);

/* The median of the counted differences, and their spread: twice the median distance from it, and 2. */
t3r_pair_levels t3r_levels_of(const uint32_t bins[T3R_ALIGN_BINS], uint32_t count);

#endif
