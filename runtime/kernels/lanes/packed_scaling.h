/* SPDX-License-Identifier: Apache-2.0 */
/* Scaling of outputs' sums to activations (kernels/requantize.h) without 64-bit shifts.
 *
 * A sum is scaled by multiplier / 2^n, n = 31 - shift. For n above 32, floor(sum x multiplier / 2^32) is the high half
 * of the product, and rounding this by the remaining n - 32 bits is the only rounding: the low half is less than one of
 * its steps. For a smaller n the sum is shifted left until n is 33. Before that it is clamped to 2^(n - 13): sums
 * outside are at least 2^17 when scaled, far beyond any zero and activation. */
#ifndef T3R_KERNELS_LANES_PACKED_SCALING_H
#define T3R_KERNELS_LANES_PACKED_SCALING_H

#include <stdbool.h>

#include "core/fixed.h"
#include "kernels/convolve.h"

/* Scaling of a packed layer's sums: for each of these a run of int32 for all outputs. */
typedef enum t3r_packed_scaling {
    T3R_SCALING_BIAS,
    T3R_SCALING_MULTIPLIER,
    T3R_SCALING_LIMIT, /* bound of a sum that is shifted left */
    T3R_SCALING_LEFT,
    T3R_SCALING_HALF, /* half of the last bit shifted out to the right */
    T3R_SCALING_RIGHT,
    T3R_SCALINGS
} t3r_packed_scaling;

_Static_assert(T3R_SCALINGS * sizeof(int32_t) == T3R_PACKED_SCALING_BYTES, "packed layers have room for them");

/* Returns the outputs of a packed layer, including padding. */
static inline uint32_t t3r_packed_outputs(uint32_t outputs)
{
    return (outputs + T3R_PACKED_OUTPUTS - 1) / T3R_PACKED_OUTPUTS * T3R_PACKED_OUTPUTS;
}

/* Packs a layer: first the scaling, then the weights, [run][group of taps][output][tap of the group]. `offset` is what
 * convolve_packed adds to every activation: each bias is reduced by that times the output's weights. factors: stores
 * 2^n and 2^(31 - n) instead of the left and right shifts n. */
void t3r_pack_layer_with(const t3r_convolution *layer, uint32_t rows, uint32_t taps_a_group, int32_t offset,
                         bool factors, void *packed);

#endif
