/* What nearest_begin leaves in the place of the neighbours: features by pairs of dimensions, as pmaddwd takes
 * them, and half norms; up to a multiple of sixteen, centres that are nearest to nothing. */
#ifndef T3R_KERNELS_LANES_PACKED_CENTRES_H
#define T3R_KERNELS_LANES_PACKED_CENTRES_H

#include <stddef.h>

#include "kernels/nearest.h"

#define T3R_PAIRS (T3R_DIMENSIONS / 2)

typedef struct t3r_packed_centres {
    int32_t pair[T3R_PAIRS][T3R_MAX_CLUSTERS];
    int32_t half_norm[T3R_MAX_CLUSTERS];
} t3r_packed_centres;

_Static_assert(sizeof(t3r_packed_centres) <= sizeof(t3r_neighbours), "they lie where plain C has neighbours");
_Static_assert(T3R_MAX_CLUSTERS % T3R_CENTRE_GROUP == 0, "whole vectors");

/* Where the number of centre k lies in a row of them that begins at `offset`. Vectors may be read there as they are. */
static inline const uint8_t *t3r_packed_at(const t3r_neighbours *packed, size_t offset, uint32_t k)
{
    return (const uint8_t *)packed + offset + (size_t)k * sizeof(int32_t);
}

#define T3R_PACKED_PAIR(d) (offsetof(t3r_packed_centres, pair) + (d) * sizeof(int32_t) * T3R_MAX_CLUSTERS)
#define T3R_PACKED_HALF_NORM offsetof(t3r_packed_centres, half_norm)

/* Pair d of a point's features, as its centres have it. */
static inline int32_t t3r_pair_of(const int16_t *p, uint32_t d)
{
    return (int32_t)((uint16_t)p[2 * d] | (uint32_t)(uint16_t)p[2 * d + 1] << 16);
}

#endif
