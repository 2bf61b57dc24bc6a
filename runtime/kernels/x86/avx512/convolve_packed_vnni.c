/* SPDX-License-Identifier: Apache-2.0 */
/* A packed layer, eight or sixteen outputs a vector: four activations, in all lanes, times four weights of each. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "kernels/x86/avx2/lanes_avx2.h"

#include "kernels/lanes/requantize_lanes.h"

#define INLINE T3R_LANES_INLINE T3R_VNNI
#define EACH(i, count) T3R_LANES_UNROLL for (uint32_t i = 0; i < (count); i++)
#define OUTPUTS 16u
#define TAPS T3R_PACKED_TAPS
#define PIXELS 8u
#define MOST_VECTORS 2u

/* The instruction takes one unsigned factor: activations + 128, the format of byte strips. */
T3R_AVX2 void t3r_pack_layer_vnni(const t3r_convolution *layer, uint32_t rows, void *packed)
{
    t3r_pack_layer_with(layer, rows, TAPS, 128, false, packed);
}

/* The parts of a packed layer for the outputs from `first` on. */
typedef struct place {
    const uint8_t *scaling, *weights;
    uint32_t whole, first;
} place;

/* For each pixel: `vectors` vectors of sixteen outputs, then eight, in a vector whose upper half may be unused. */
typedef struct sums {
    __m512i sixteen[PIXELS][MOST_VECTORS];
    __m256i eight[PIXELS];
} sums;

INLINE __m512i sixteen(const place *at, t3r_packed_scaling which, uint32_t first)
{
    return _mm512_loadu_si512((const int32_t *)(const void *)at->scaling + which * at->whole + first);
}

/* Sums are modulo 2^32. */
INLINE void add_up(sums *s, const t3r_block *block, const size_t offset[PIXELS], const place *at, uint32_t vectors,
                   bool half)
{
    const uint32_t groups = (block->run + TAPS - 1) / TAPS;
    const uint8_t *w = at->weights + (size_t)at->first * TAPS;
    EACH(p, PIXELS)
    {
        EACH(v, vectors)
        {
            s->sixteen[p][v] = sixteen(at, T3R_SCALING_BIAS, at->first + v * OUTPUTS);
        }
        if (half) {
            s->eight[p] =
                t3r_packed_scaling_at(at->scaling, T3R_SCALING_BIAS, at->whole, at->first + vectors * OUTPUTS);
        }
    }
    for (uint32_t row = 0; row < block->rows; row++) {
        const uint8_t *x = (const uint8_t *)block->x + (size_t)row * block->pitch;
        for (uint32_t group = 0; group < groups; group++, x += TAPS, w += (size_t)at->whole * TAPS) {
            __m512i weights[MOST_VECTORS];
            __m256i weights_half = _mm256_setzero_si256();
            EACH(v, vectors)
            {
                weights[v] = _mm512_loadu_si512(w + v * OUTPUTS * TAPS);
            }
            if (half) {
                weights_half = _mm256_loadu_si256((const __m256i_u *)(const void *)(w + vectors * OUTPUTS * TAPS));
            }
            EACH(p, PIXELS)
            {
                const __m512i four = _mm512_broadcastd_epi32(_mm_loadu_si32(x + offset[p]));
                EACH(v, vectors)
                {
                    s->sixteen[p][v] = _mm512_dpbusd_epi32(s->sixteen[p][v], four, weights[v]);
                }
                if (half) {
                    s->eight[p] = _mm256_dpbusd_epi32(s->eight[p], _mm512_castsi512_si256(four), weights_half);
                }
            }
        }
    }
}

/* Returns t3r_packed_scaled() of sixteen. Uses operators, because without optimisation intrinsics take stack for each
 * operand. */
INLINE __m512i scaled(__m512i sum, const place *at, uint32_t first, int16_t zero)
{
    const __m512i limit = sixteen(at, T3R_SCALING_LIMIT, first),
                  multiplier = sixteen(at, T3R_SCALING_MULTIPLIER, first);
    const __m512i held = _mm512_max_epi32(_mm512_min_epi32(sum, limit), (__m512i)(-(__v16si)limit));
    const __v16si shifted = (__v16si)held << (__v16si)sixteen(at, T3R_SCALING_LEFT, first);
    const __m512i even = _mm512_mul_epi32((__m512i)shifted, multiplier);
    const __m512i odd = _mm512_mul_epi32((__m512i)((__v8du)shifted >> 32), (__m512i)((__v8du)multiplier >> 32));
    const __m512i high = _mm512_mask_mov_epi32((__m512i)((__v8du)even >> 32), 0xaaaa, odd);
    const __v16si half = (__v16si)sixteen(at, T3R_SCALING_HALF, first),
                  right = (__v16si)sixteen(at, T3R_SCALING_RIGHT, first);
    return (__m512i)((((__v16si)high + half) >> right) + zero);
}

/* Writes the first `count` activations of x, clamped to 8 or 16 bits. */
INLINE void write(__m512i x, uint32_t output_bits, uint32_t count, void *out, size_t at)
{
    const unsigned there_bits = count >= OUTPUTS ? 0xffffu : (1u << count) - 1;
    const __mmask16 there = (__mmask16)there_bits;
    if (output_bits == 8) {
        _mm_mask_storeu_epi8((int8_t *)out + at, there, _mm512_cvtsepi32_epi8(x));
    } else {
        _mm256_mask_storeu_epi16((int16_t *)out + at, there, _mm512_cvtsepi32_epi16(x));
    }
}

/* Convolves all pixels, eight at a time; pads by repeating the last. */
INLINE void convolve(const t3r_convolution *layer, const t3r_block *block, const place *at, uint32_t vectors, bool half,
                     void *out, uint32_t out_pitch)
{
    for (uint32_t i = 0; i < block->pixels; i += PIXELS) {
        size_t offset[PIXELS], pixel[PIXELS];
        sums s;
        for (uint32_t p = 0; p < PIXELS; p++) {
            pixel[p] = i + p < block->pixels ? i + p : block->pixels - 1;
            offset[p] = pixel[p] * block->step;
        }
        add_up(&s, block, offset, at, vectors, half);
        EACH(p, PIXELS)
        {
            EACH(v, vectors)
            {
                const uint32_t first = at->first + v * OUTPUTS;
                write(scaled(s.sixteen[p][v], at, first, layer->zero), layer->output_bits, layer->outputs - first, out,
                      pixel[p] * out_pitch + first);
            }
            if (half) {
                const uint32_t first = at->first + vectors * OUTPUTS, left = layer->outputs - first;
                const __m256i x = t3r_packed_scaled(s.eight[p], at->scaling, at->whole, first, layer->zero);
                write(_mm512_castsi256_si512(x), layer->output_bits, left < OUTPUTS / 2 ? left : OUTPUTS / 2, out,
                      pixel[p] * out_pitch + first);
            }
        }
    }
}

#define CONVOLVE(name, vectors, half)                                                                                  \
    static __attribute__((noinline)) T3R_VNNI void name(const t3r_convolution *layer, const t3r_block *block,          \
                                                        const place *at, void *out, uint32_t out_pitch)                \
    {                                                                                                                  \
        convolve(layer, block, at, vectors, half, out, out_pitch);                                                     \
    }

CONVOLVE(convolve_8, 0, true)
CONVOLVE(convolve_16, 1, false)
CONVOLVE(convolve_24, 1, true)
CONVOLVE(convolve_32, 2, false)

T3R_VNNI void t3r_convolve_packed_vnni(const t3r_convolution *layer, const void *packed, const t3r_block *block,
                                       void *out, uint32_t out_pitch)
{
    const uint32_t whole = t3r_packed_outputs(layer->outputs);
    place at = {packed, (const uint8_t *)packed + (size_t)whole * T3R_PACKED_SCALING_BYTES, whole, 0};
    for (; at.first + 32 <= whole; at.first += 32) {
        convolve_32(layer, block, &at, out, out_pitch);
    }
    switch (whole - at.first) {
    case 8:
        convolve_8(layer, block, &at, out, out_pitch);
        break;
    case 16:
        convolve_16(layer, block, &at, out, out_pitch);
        break;
    case 24:
        convolve_24(layer, block, &at, out, out_pitch);
        break;
    default:
        break;
    }
}

#else
typedef int t3r_no_convolve_packed_vnni; /* a file may not be empty */
#endif
