/* The innermost loops of k-means++: what a new centre changes in the distances of the sample (SPEC.md,
 * "SuperClusters").
 */
#ifndef T3R_KERNEL_SEED_H
#define T3R_KERNEL_SEED_H

#include <stdint.h>

#include "nearest.h"

#define T3R_CLUSTER_SAMPLE 2560u /* most points of the seeding subsample */

/* Points by dimension, and of each the squared distance to its nearest centre, in Q20: the sum over the dimensions of
 * floor(e^2 / 4), at most 6 x 30000^2 / 4 < 2^31. Before the first centre it is INT32_MAX. */
typedef struct t3r_sample {
    int16_t *feature_q11[T3R_DIMENSIONS];
    int32_t *distance_q20;
} t3r_sample;

/* The sum of the first `count` points' distances if there were a centre more. Centre and points are within
 * T3R_FEATURE_MOST; nothing is aligned to more than its type. What other points have is not used. */
typedef uint64_t t3r_sample_potential_kernel(const t3r_sample *sample, uint32_t count,
                                             const int16_t centre_q11[T3R_DIMENSIONS]);

/* Adds the centre: the distances of the points first..end - 1 become the least of what they were and those to it.
 * Returns their sum. Those of other points are not changed. */
typedef uint64_t t3r_sample_approach_kernel(const t3r_sample *sample, uint32_t first, uint32_t end,
                                            const int16_t centre_q11[T3R_DIMENSIONS]);

t3r_sample_potential_kernel t3r_sample_potential_c;
t3r_sample_approach_kernel t3r_sample_approach_c;

#endif
