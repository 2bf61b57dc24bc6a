/* SPDX-License-Identifier: Apache-2.0 */
/* Products of a packed layer for instructions that multiply pairs of 16 bits. Included after a header of lanes. */
#ifndef T3R_KERNELS_LANES_PAIRS_OF_TAPS_H
#define T3R_KERNELS_LANES_PAIRS_OF_TAPS_H

#define TAPS 2u

typedef int16_t activation;

/* Not `lanes`: if sums change their type, gcc 12 copies them in every iteration. */
typedef int32_t ints __attribute__((vector_size(LANES * sizeof(int32_t))));

/* Loads two activations into all lanes. */
T3R_LANES_INLINE T3R_LANES_TARGET lanes taps_at(const activation *x)
{
    return first_of(load_quarter_quad(x));
}

/* Loads two weights for each lane's output. */
T3R_LANES_INLINE T3R_LANES_TARGET lanes load_weights(const uint8_t *from)
{
    return load_8(from);
}

/* Both products of a lane sum to at most 2^15. */
T3R_LANES_INLINE T3R_LANES_TARGET void add_products(ints *sum, lanes taps, lanes weights)
{
    *sum += (ints)OF_LANES(madd_epi16)(taps, weights);
}

#endif
