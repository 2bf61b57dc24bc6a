/* Sums of outputs to activations (kernels/requantize.h), without shifts of 64 bits.
 *
 * A sum is scaled by multiplier / 2^n, n = 31 - shift. For n above 32, floor(sum x multiplier / 2^32) is the high half
 * of the product, and rounding that by the n - 32 bits left is the one rounding: what the low half holds is less than
 * one of its steps. For a smaller n the sum is shifted left until n is 33. Before that it is held within 2^(n - 13):
 * what lies outside is at least 2^17 when scaled, far beyond any zero and activation. */
#ifndef T3R_KERNELS_X86_REQUANTIZE_H
#define T3R_KERNELS_X86_REQUANTIZE_H

#include "core/fixed.h"
#include "intrinsics.h"
#include "variants.h"

/* How the sums of a packed layer's outputs are scaled: a run of int32 of all outputs for each of these. */
typedef enum t3r_x86_scaling {
    T3R_X86_BIAS,
    T3R_X86_MULTIPLIER,
    T3R_X86_LIMIT, /* of a sum that is shifted left */
    T3R_X86_LEFT,
    T3R_X86_HALF, /* of what is shifted out to the right */
    T3R_X86_RIGHT,
    T3R_X86_SCALINGS
} t3r_x86_scaling;

_Static_assert(T3R_X86_SCALINGS * sizeof(int32_t) == T3R_PACKED_SCALING_BYTES, "packed layers have room for them");

/* Outputs of a packed layer: filled up. */
static inline uint32_t t3r_x86_whole(uint32_t outputs)
{
    return (outputs + T3R_PACKED_OUTPUTS - 1) / T3R_PACKED_OUTPUTS * T3R_PACKED_OUTPUTS;
}

static inline T3R_AVX2 __m256i t3r_x86_eight(const void *scaling, t3r_x86_scaling which, uint32_t whole, uint32_t first)
{
    return _mm256_loadu_si256((const __m256i_u *)((const int32_t *)scaling + which * whole + first));
}

/* The activations of eight outputs at a pixel, from sums that began with the bias, before they are held within their
 * bits: below 2^31 in size. */
T3R_X86_INLINE T3R_AVX2 __m256i t3r_x86_scaled(__m256i sum, const void *scaling, uint32_t whole, uint32_t first,
                                               int16_t zero)
{
    const __m256i limit = t3r_x86_eight(scaling, T3R_X86_LIMIT, whole, first);
    const __m256i multiplier = t3r_x86_eight(scaling, T3R_X86_MULTIPLIER, whole, first);
    sum = _mm256_max_epi32(_mm256_min_epi32(sum, limit), _mm256_sub_epi32(_mm256_setzero_si256(), limit));
    sum = _mm256_sllv_epi32(sum, t3r_x86_eight(scaling, T3R_X86_LEFT, whole, first));
    const __m256i even = _mm256_mul_epi32(sum, multiplier);
    const __m256i odd = _mm256_mul_epi32(_mm256_srli_epi64(sum, 32), _mm256_srli_epi64(multiplier, 32));
    const __m256i high = _mm256_blend_epi32(_mm256_srli_epi64(even, 32), odd, 0xaa);
    const __m256i rounded =
        _mm256_srav_epi32(_mm256_add_epi32(high, t3r_x86_eight(scaling, T3R_X86_HALF, whole, first)),
                          t3r_x86_eight(scaling, T3R_X86_RIGHT, whole, first));
    return _mm256_add_epi32(rounded, _mm256_set1_epi32(zero));
}

/* Packs a layer: first how sums are scaled, then the weights, [run][group of taps][output][tap of the group]. `offset`
 * is what convolve_packed adds to every activation: each bias is less by that times the output's weights. */
void t3r_x86_pack_layer(const t3r_convolution *layer, uint32_t rows, uint32_t taps_a_group, int32_t offset,
                        void *packed);

#endif
