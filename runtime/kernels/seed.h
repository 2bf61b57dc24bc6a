/* The innermost loops of k-means++: the distances of the sample with a new centre (SPEC.md, "SuperClusters"). */
#ifndef T3R_KERNEL_SEED_H
#define T3R_KERNEL_SEED_H

#include <stdint.h>

#include "nearest.h"

#define T3R_CLUSTER_SAMPLE 2560u /* maximum points of the seeding sample */

/* Points by dimension, and the squared distance of each to its nearest centre, in Q20: the sum over the dimensions of
 * floor(e^2 / 4), at most 6 x 30000^2 / 4 < 2^31. Before the first centre it is INT32_MAX. */
typedef struct t3r_sample {
    int16_t *feature_q11[T3R_DIMENSIONS];
    int32_t *distance_q20;
} t3r_sample;

/* Returns the sum of the first `count` points' distances as if there were one more centre. Centre and points are within
 * T3R_FEATURE_MOST; nothing needs more alignment than its type. Other points are not used. */
typedef uint64_t t3r_sample_potential_kernel(const t3r_sample *sample, uint32_t count,
                                             const int16_t centre_q11[T3R_DIMENSIONS]);

/* Adds the centre: lowers the distances of the points first..end - 1 to those from it where it is nearer. Returns the
 * sum of their distances. Other points are not changed. */
typedef uint64_t t3r_sample_approach_kernel(const t3r_sample *sample, uint32_t first, uint32_t end,
                                            const int16_t centre_q11[T3R_DIMENSIONS]);

t3r_sample_potential_kernel t3r_sample_potential_c;
t3r_sample_approach_kernel t3r_sample_approach_c;

#endif
