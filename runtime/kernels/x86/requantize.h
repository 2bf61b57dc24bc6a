/* Sums of four outputs at a time to activations (kernels/requantize.h), without shifts of 64 bits.
 *
 * A sum is scaled by multiplier / 2^n, n = 31 - shift. For n above 32, floor(sum x multiplier / 2^32) is the high half
 * of the product, and rounding that by the n - 32 bits left is the one rounding: what the low half holds is less than
 * one of its steps. For a smaller n the sum is shifted left until n is 33. Before that it is held within 2^(n - 13):
 * what lies outside is at least 2^17 when scaled, far beyond any zero and activation. */
#ifndef T3R_KERNELS_X86_REQUANTIZE_H
#define T3R_KERNELS_X86_REQUANTIZE_H

#include "intrinsics.h"
#include "variants.h"

#define T3R_FOUR 4u /* outputs */

/* How four outputs are scaled; sums without their bias come in. */
typedef struct t3r_x86_scaling {
    __m128i bias, multiplier, limit, left, half, right;
} t3r_x86_scaling;

/* Four little-endian numbers of outputs from `first` on; behind the last output, it again. */
static inline T3R_AVX2 __m128i t3r_x86_four(const uint8_t *numbers, uint32_t first, uint32_t outputs)
{
    const __m128i_u *at = (const __m128i_u *)(const void *)(numbers + (size_t)first * 4);
    if (first + T3R_FOUR <= outputs) {
        return _mm_loadu_si128(at);
    }
    const uint32_t last = outputs - 1 - first; /* 0..2 */
    const __m128i index = _mm_min_epu32(_mm_setr_epi32(0, 1, 2, 3), _mm_set1_epi32((int32_t)last));
    const __m128i there = _mm_cmpgt_epi32(_mm_set1_epi32((int32_t)last + 1), _mm_setr_epi32(0, 1, 2, 3));
    const __m128i loaded = _mm_maskload_epi32((const int *)(const void *)at, there);
    return _mm_castps_si128(_mm_permutevar_ps(_mm_castsi128_ps(loaded), index));
}

static inline T3R_AVX2 __m128i t3r_x86_four_shifts(const uint8_t *shift, uint32_t first, uint32_t outputs)
{
    int32_t four[T3R_FOUR];
    for (uint32_t i = 0; i < T3R_FOUR; i++) {
        const uint32_t output = first + i < outputs ? first + i : outputs - 1;
        four[i] = (int8_t)shift[output];
    }
    return _mm_setr_epi32(four[0], four[1], four[2], four[3]);
}

static inline T3R_AVX2 t3r_x86_scaling t3r_x86_scaling_of(const t3r_convolution *layer, uint32_t first)
{
    const __m128i one = _mm_set1_epi32(1), shift = t3r_x86_four_shifts(layer->shift, first, layer->outputs);
    t3r_x86_scaling s = {.bias = t3r_x86_four(layer->bias, first, layer->outputs),
                         .multiplier = t3r_x86_four(layer->multiplier, first, layer->outputs)};
    s.left = _mm_max_epi32(_mm_add_epi32(shift, _mm_set1_epi32(2)), _mm_setzero_si128()); /* 33 - n */
    s.right = _mm_max_epi32(_mm_sub_epi32(_mm_set1_epi32(-1), shift), one);               /* n - 32 */
    s.half = _mm_sllv_epi32(one, _mm_sub_epi32(s.right, one));
    const __m128i most = _mm_sllv_epi32(one, _mm_sub_epi32(_mm_set1_epi32(18), shift)); /* of no use beyond 2^31 */
    s.limit = _mm_blendv_epi8(_mm_set1_epi32(INT32_MAX), most, _mm_cmpgt_epi32(s.left, _mm_setzero_si128()));
    return s;
}

/* The scaled sums of four outputs at two pixels, below 2^30, and the zero added. */
static inline T3R_AVX2 __m256i t3r_x86_scaled(__m256i sum, const t3r_x86_scaling *s, int16_t zero)
{
    const __m256i limit = _mm256_broadcastsi128_si256(s->limit);
    const __m256i multiplier = _mm256_broadcastsi128_si256(s->multiplier);
    sum = _mm256_add_epi32(sum, _mm256_broadcastsi128_si256(s->bias));
    sum = _mm256_max_epi32(_mm256_min_epi32(sum, limit), _mm256_sub_epi32(_mm256_setzero_si256(), limit));
    sum = _mm256_sllv_epi32(sum, _mm256_broadcastsi128_si256(s->left));
    const __m256i even = _mm256_mul_epi32(sum, multiplier);
    const __m256i odd = _mm256_mul_epi32(_mm256_srli_epi64(sum, 32), _mm256_srli_epi64(multiplier, 32));
    const __m256i high = _mm256_blend_epi32(_mm256_srli_epi64(even, 32), odd, 0xaa);
    const __m256i rounded = _mm256_srav_epi32(_mm256_add_epi32(high, _mm256_broadcastsi128_si256(s->half)),
                                              _mm256_broadcastsi128_si256(s->right));
    return _mm256_add_epi32(rounded, _mm256_set1_epi32(zero));
}

/* Writes the activations of `count` (1..4) outputs at one pixel: x, held within 8 or 16 bits. */
static inline T3R_AVX2 void t3r_x86_write(__m128i x, uint32_t output_bits, uint32_t count, void *out, size_t at)
{
    const __m128i held = _mm_packs_epi32(x, x);
    if (output_bits == 8) {
        int8_t *to = (int8_t *)out + at;
        const __m128i bytes = _mm_packs_epi16(held, held);
        if (count == T3R_FOUR) {
            _mm_storeu_si32(to, bytes);
            return;
        }
        const uint32_t four = (uint32_t)_mm_cvtsi128_si32(bytes);
        for (uint32_t i = 0; i < count; i++) {
            to[i] = (int8_t)(four >> (8 * i));
        }
        return;
    }
    int16_t *to = (int16_t *)out + at;
    if (count == T3R_FOUR) {
        _mm_storel_epi64((__m128i_u *)(void *)to, held);
        return;
    }
    const uint64_t four = (uint64_t)_mm_cvtsi128_si64(held);
    for (uint32_t i = 0; i < count; i++) {
        to[i] = (int16_t)(four >> (16 * i));
    }
}

#endif
