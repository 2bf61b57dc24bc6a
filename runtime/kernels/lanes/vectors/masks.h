/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by instruction sets without mask registers: a mask has all bits of a lane, or none. Included after
 * operations.h. */
#ifndef T3R_KERNELS_LANES_MASKS_H
#define T3R_KERNELS_LANES_MASKS_H

/* Return all bits set where a is greater, or equal. */
static inline T3R_LANES_TARGET lanes greater(lanes a, lanes b)
{
    return OF_LANES(cmpgt_epi32)(a, b);
}

static inline T3R_LANES_TARGET lanes equal(lanes a, lanes b)
{
    return OF_LANES(cmpeq_epi32)(a, b);
}

/* Returns a >= b for unsigned numbers. */
static inline T3R_LANES_TARGET lanes at_least(lanes a, lanes b)
{
    return equal(OF_LANES(max_epu32)(a, b), a);
}

/* Returns b where the mask has all bits, else a. */
static inline T3R_LANES_TARGET lanes chosen(lanes mask, lanes b, lanes a)
{
    return OF_LANES(blendv_epi8)(a, b, mask);
}

#endif
