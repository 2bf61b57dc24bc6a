/* SPDX-License-Identifier: Apache-2.0 */
/* The scaling of a packed layer's sums, LANES outputs at a time (requantize.h). Included after a header of lanes. */
#ifndef T3R_KERNELS_LANES_REQUANTIZE_LANES_H
#define T3R_KERNELS_LANES_REQUANTIZE_LANES_H

#include "packed_scaling.h"

/* SSE4.1 cannot shift each lane by its own count, so the layer stores factors instead. */
enum { BY_FACTORS = T3R_LANES_BY_FACTORS };

static inline T3R_LANES_TARGET lanes raised(lanes x, lanes left)
{
    return BY_FACTORS ? multiply(x, left) : left_each(x, left);
}

static inline T3R_LANES_TARGET lanes lowered(lanes x, lanes by)
{
    return BY_FACTORS ? low_of(right(product(x, by), 31)) : signed_right_each(x, by);
}

/* Loads one kind of scaling for LANES outputs from the first on. */
static inline T3R_LANES_TARGET lanes t3r_packed_scaling_at(const void *scaling, t3r_packed_scaling which,
                                                           uint32_t whole, uint32_t first)
{
    return load((const int32_t *)scaling + which * whole + first);
}

/* Returns the activations of LANES outputs at a pixel, from sums that began with the bias, before clamping to their
 * bits: below 2^31 in size. */
T3R_LANES_INLINE T3R_LANES_TARGET lanes t3r_packed_scaled(lanes sum, const void *scaling, uint32_t whole,
                                                          uint32_t first, int16_t zero)
{
    const lanes limit = t3r_packed_scaling_at(scaling, T3R_SCALING_LIMIT, whole, first);
    const lanes multiplier = t3r_packed_scaling_at(scaling, T3R_SCALING_MULTIPLIER, whole, first);
    const lanes left = t3r_packed_scaling_at(scaling, T3R_SCALING_LEFT, whole, first);
    const lanes half = t3r_packed_scaling_at(scaling, T3R_SCALING_HALF, whole, first);
    sum = OF_LANES(max_epi32)(OF_LANES(min_epi32)(sum, limit), subtract(all(0), limit));
    const lanes high = high_of(product(raised(sum, left), multiplier));
    return add(lowered(add(high, half), t3r_packed_scaling_at(scaling, T3R_SCALING_RIGHT, whole, first)), all(zero));
}

#endif
