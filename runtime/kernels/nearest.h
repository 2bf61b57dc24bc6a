/* SPDX-License-Identifier: Apache-2.0 */
/* The innermost loop of the K-means: finds the nearest of K centres for each of a run of points. */
#ifndef T3R_KERNEL_NEAREST_H
#define T3R_KERNEL_NEAREST_H

#include <stdint.h>

#include "trim3r.h"

#define T3R_DIMENSIONS 6
/* Bound of features, Q11. Scores are half |c|^2 - p c: at most 9 x 15000^2 < 2^31. */
#define T3R_FEATURE_MOST 15000
#define T3R_NEIGHBOURS 12u

/* Centres by dimension, with half_norm = floor(|c|^2 / 2). The nearest centre of a point has the least score half_norm
 * - p c, the lowest index among equals. At most T3R_MAX_CLUSTERS. */
typedef struct t3r_centres {
    int16_t *feature_q11[T3R_DIMENSIONS];
    int32_t *half_norm;
    uint32_t count;
} t3r_centres;

/* The nearest others of each centre, nearest first. There is room for whole groups of T3R_CENTRE_GROUP centres, aligned
 * to 4 bytes. */
typedef struct t3r_neighbours {
    uint16_t (*index)[T3R_NEIGHBOURS];
} t3r_neighbours;

/* Prepares `nearest` of the same table for new centres: the part for the centres first..end - 1, so that workers can
 * share it. `first` is a multiple of T3R_CENTRE_GROUP, and so is `end` unless it is the number of centres. Plain C
 * computes the list of neighbours, with one distance for each pair of centres. A variant that compares all centres may
 * leave the list unset. */
#define T3R_CENTRE_GROUP 16u
typedef void t3r_nearest_begin_kernel(const t3r_centres *centres, uint32_t first, uint32_t end,
                                      const t3r_neighbours *neighbours);

/* Finds the index of the nearest centre for each of `points` consecutive points, aligned to 2 bytes. `guess`, below
 * the number of centres, is the start of the search; it changes no result. Plain C first compares a point with the
 * neighbours of its predecessor's centre, which the triangle inequality often shows to be enough; otherwise with all.
 */
typedef void t3r_nearest_kernel(const t3r_centres *centres, const t3r_neighbours *neighbours, uint32_t points,
                                const int16_t (*feature_q11)[T3R_DIMENSIONS], uint16_t guess, uint16_t *nearest);

t3r_nearest_begin_kernel t3r_nearest_begin_c;
t3r_nearest_kernel t3r_nearest_c;

#endif
