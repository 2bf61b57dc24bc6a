/* SPDX-License-Identifier: Apache-2.0 */
/* Sums of outputs to activations (kernels/requantize.h), without shifts of 64 bits.
 *
 * A sum is scaled by multiplier / 2^n, n = 31 - shift. For n above 32, floor(sum x multiplier / 2^32) is the high half
 * of the product, and rounding that by the n - 32 bits left is the one rounding: what the low half holds is less than
 * one of its steps. For a smaller n the sum is shifted left until n is 33. Before that it is held within 2^(n - 13):
 * what lies outside is at least 2^17 when scaled, far beyond any zero and activation. */
#ifndef T3R_KERNELS_LANES_PACKED_SCALING_H
#define T3R_KERNELS_LANES_PACKED_SCALING_H

#include <stdbool.h>

#include "core/fixed.h"
#include "kernels/convolve.h"

/* How the sums of a packed layer's outputs are scaled: a run of int32 of all outputs for each of these. */
typedef enum t3r_packed_scaling {
    T3R_SCALING_BIAS,
    T3R_SCALING_MULTIPLIER,
    T3R_SCALING_LIMIT, /* of a sum that is shifted left */
    T3R_SCALING_LEFT,
    T3R_SCALING_HALF, /* of what is shifted out to the right */
    T3R_SCALING_RIGHT,
    T3R_SCALINGS
} t3r_packed_scaling;

_Static_assert(T3R_SCALINGS * sizeof(int32_t) == T3R_PACKED_SCALING_BYTES, "packed layers have room for them");

/* Outputs of a packed layer: filled up. */
static inline uint32_t t3r_packed_outputs(uint32_t outputs)
{
    return (outputs + T3R_PACKED_OUTPUTS - 1) / T3R_PACKED_OUTPUTS * T3R_PACKED_OUTPUTS;
}

/* Packs a layer: first how sums are scaled, then the weights, [run][group of taps][output][tap of the group]. `offset`
 * is what convolve_packed adds to every activation: each bias is less by that times the output's weights. factors: in
 * the place of n to the left and to the right 2^n and 2^(31 - n). */
void t3r_pack_layer_with(const t3r_convolution *layer, uint32_t rows, uint32_t taps_a_group, int32_t offset,
                         bool factors, void *packed);

#endif
