/* SPDX-License-Identifier: Apache-2.0 */
/* Addresses a tile's pixels by one number, row by row. */
#ifndef T3R_KERNELS_LANES_TILE_PLANES_H
#define T3R_KERNELS_LANES_TILE_PLANES_H

#include "inline.h"
#include "kernels/blend.h"

/* Returns the address of pixel `place` of a plane. */
T3R_LANES_INLINE void *plane_at(void *plane, uint32_t place)
{
    return (uint16_t *)plane + place;
}

#endif
