/* A depthwise layer, eight channels at a time. */
#include "variants.h"

#ifdef T3R_X86

#include "requantize.h"

#define LANES 8u /* channels: two fours */

/* Eight numbers of 8 or 16 bits, widened; behind `count`, zeros. */
static inline __attribute__((always_inline)) T3R_AVX2 __m256i load(const uint8_t *from, uint32_t bytes, uint32_t count)
{
    uint8_t few[LANES * 2];
    if (count < LANES) {
        for (uint32_t i = 0; i < LANES * bytes; i++) {
            few[i] = i < count * bytes ? from[i] : 0;
        }
        from = few;
    }
    return bytes == 1 ? _mm256_cvtepi8_epi32(_mm_loadl_epi64((const __m128i_u *)(const void *)from))
                      : _mm256_cvtepi16_epi32(_mm_loadu_si128((const __m128i_u *)(const void *)from));
}

/* The sums of `count` channels from `first` on at one pixel. */
static inline __attribute__((always_inline)) T3R_AVX2 __m256i sum_of(const t3r_convolution *layer,
                                                                     const t3r_block *block, uint32_t pixel,
                                                                     uint32_t first, uint32_t count, uint32_t bytes)
{
    const uint8_t *w = layer->weights + (size_t)first * bytes;
    __m256i sum = _mm256_setzero_si256();
    for (uint32_t r = 0; r < block->rows; r++) {
        const uint8_t *x = block->row[r] + block->first + (size_t)pixel * block->step;
        for (uint32_t at = first; at < block->run; at += layer->outputs, w += (size_t)layer->outputs * bytes) {
            sum = _mm256_add_epi32(sum, _mm256_mullo_epi32(load(x + at, 1, count), load(w, bytes, count)));
        }
    }
    return sum;
}

static inline __attribute__((always_inline)) T3R_AVX2 void
depthwise(const t3r_convolution *layer, const t3r_block *block, uint32_t bytes, void *out, uint32_t out_pitch)
{
    for (uint32_t first = 0; first < layer->outputs; first += LANES) {
        const uint32_t count = layer->outputs - first < LANES ? layer->outputs - first : LANES;
        const uint32_t low = count < T3R_FOUR ? count : T3R_FOUR;
        const t3r_x86_scaling scaling[2] = {t3r_x86_scaling_of(layer, first),
                                            t3r_x86_scaling_of(layer, first + (count > low ? T3R_FOUR : 0))};
        for (uint32_t i = 0; i < block->pixels; i++) {
            const size_t at = (size_t)i * out_pitch + first;
            const __m256i sum = sum_of(layer, block, i, first, count, bytes);
            const __m256i upper = _mm256_permute2x128_si256(sum, sum, 0x11);
            t3r_x86_write(_mm256_castsi256_si128(t3r_x86_scaled(sum, &scaling[0], layer->zero)), layer->output_bits,
                          low, out, at);
            if (count > low) {
                t3r_x86_write(_mm256_castsi256_si128(t3r_x86_scaled(upper, &scaling[1], layer->zero)),
                              layer->output_bits, count - low, out, at + T3R_FOUR);
            }
        }
    }
}

T3R_AVX2 void t3r_depthwise_avx2(const t3r_convolution *layer, const t3r_block *block, void *out, uint32_t out_pitch)
{
    if (layer->activation_bits == 16) {
        t3r_depthwise_c(layer, block, out, out_pitch);
    } else if (layer->weight_bits == 16) {
        depthwise(layer, block, 2, out, out_pitch);
    } else {
        depthwise(layer, block, 1, out, out_pitch);
    }
}

#else
typedef int t3r_no_depthwise_avx2; /* a file may not be empty */
#endif
