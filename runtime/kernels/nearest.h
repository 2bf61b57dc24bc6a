/* The innermost loop of the K-means: the nearest of K centres to each of a run of points. */
#ifndef T3R_KERNEL_NEAREST_H
#define T3R_KERNEL_NEAREST_H

#include <stdint.h>

#include "trim3r.h"

#define T3R_DIMENSIONS 6
/* Features are Q11 within this. Scores are half |c|^2 - p c: at most 9 x 15000^2 < 2^31. */
#define T3R_FEATURE_MOST 15000
#define T3R_NEIGHBOURS 12u

/* Centres by dimension, with half_norm = floor(|c|^2 / 2). A point's nearest centre is the one with the least score
 * half_norm - p c, the lowest index among equals. At most T3R_MAX_CLUSTERS. */
typedef struct t3r_centres {
    int16_t *feature_q11[T3R_DIMENSIONS];
    int32_t *half_norm;
    uint32_t count;
} t3r_centres;

/* Of each centre the nearest others, nearest first. There is room for whole groups of T3R_CENTRE_GROUP centres, aligned
 * to 4 bytes. */
typedef struct t3r_neighbours {
    uint16_t (*index)[T3R_NEIGHBOURS];
} t3r_neighbours;

/* What `nearest` of the same table asks for before it is first called with these centres: the part of the centres
 * first..end - 1, so that workers can share it. `first` is a multiple of T3R_CENTRE_GROUP, and so is `end`, unless it
 * is the number of centres. In plain C that is the list of neighbours: count distances a centre. A variant that looks
 * at all centres needs none and may leave it as it is. */
#define T3R_CENTRE_GROUP 16u
typedef void t3r_nearest_begin_kernel(const t3r_centres *centres, uint32_t first, uint32_t end,
                                      const t3r_neighbours *neighbours);

/* Index of the nearest centre of each of `points` points, which lie one behind the other, aligned to 2 bytes. `guess`,
 * below the number of centres, is where to start; it changes no result. In plain C a point is first compared with the
 * neighbours of the centre its predecessor had, which the triangle inequality often shows to be enough; else with all.
 */
typedef void t3r_nearest_kernel(const t3r_centres *centres, const t3r_neighbours *neighbours, uint32_t points,
                                const int16_t (*feature_q11)[T3R_DIMENSIONS], uint16_t guess, uint16_t *nearest);

t3r_nearest_begin_kernel t3r_nearest_begin_c;
t3r_nearest_kernel t3r_nearest_c;

#endif
