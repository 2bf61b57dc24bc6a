/* SPDX-License-Identifier: Apache-2.0 */
/* Centres that nearest_begin stores in place of the neighbours, group after group: features by pairs of dimensions,
 * for pmaddwd, and half norms; after the last centre, padding centres that never win. */
#ifndef T3R_KERNELS_LANES_PACKED_CENTRES_H
#define T3R_KERNELS_LANES_PACKED_CENTRES_H

#include <stddef.h>

#include "kernels/nearest.h"

#define T3R_PAIRS (T3R_DIMENSIONS / 2)

typedef struct t3r_packed_group {
    int32_t pair[T3R_PAIRS][T3R_CENTRE_GROUP];
    int32_t half_norm[T3R_CENTRE_GROUP];
} t3r_packed_group;

_Static_assert(sizeof(t3r_packed_group) <= sizeof(uint16_t[T3R_CENTRE_GROUP][T3R_NEIGHBOURS]),
               "they lie where plain C has neighbours");

/* Returns the group of centre k, a multiple of T3R_CENTRE_GROUP. */
static inline t3r_packed_group *t3r_packed_group_of(const t3r_neighbours *packed, uint32_t k)
{
    return (t3r_packed_group *)(void *)packed->index + k / T3R_CENTRE_GROUP;
}

/* Returns pair d of a point's features, packed like the centres'. */
static inline int32_t t3r_pair_of(const int16_t *p, uint32_t d)
{
    return (int32_t)((uint16_t)p[2 * d] | (uint32_t)(uint16_t)p[2 * d + 1] << 16);
}

#endif
