/* The innermost loop of the K-means: the nearest of K centres to each of a block of points. */
#ifndef T3R_KERNEL_NEAREST_H
#define T3R_KERNEL_NEAREST_H

#include <stdint.h>

#include "trim3r.h"

#define T3R_DIMENSIONS 6
/* Features are Q11 within this. Scores are half |c|^2 - p c: at most 9 x 15000^2 < 2^31. */
#define T3R_FEATURE_MOST 15000
#define T3R_NEAREST_BLOCK 8u /* centres are padded to a multiple of this */

/* Centres by dimension; half_norm = |c|^2 / 2, of padding INT32_MAX / 2. */
typedef struct t3r_centres {
    int16_t feature_q11[T3R_DIMENSIONS][T3R_MAX_CLUSTERS];
    int32_t half_norm[T3R_MAX_CLUSTERS];
    uint32_t count;
} t3r_centres;

/* Index of the nearest centre of each point, the lowest among equals. */
void t3r_nearest(const t3r_centres *centres, uint32_t points, const int16_t (*feature_q11)[T3R_DIMENSIONS],
                 uint16_t *nearest);

#endif
