/* A packed layer, eight outputs a vector: a pair of activations, in all lanes, times a pair of weights of each. */
#include "variants.h"

#ifdef T3R_X86

#include "requantize.h"

#define INLINE T3R_X86_INLINE T3R_AVX2
#define EACH(i, count) T3R_X86_UNROLL for (uint32_t i = 0; i < (count); i++)
#define LANES T3R_PACKED_OUTPUTS
#define TAPS 2u
#define MOST_SUMS 8u /* vectors */

T3R_AVX2 void t3r_pack_layer_avx2(const t3r_convolution *layer, uint32_t rows, void *packed)
{
    t3r_x86_pack_layer(layer, rows, TAPS, 0, packed);
}

/* Where the outputs from `first` on lie in a packed layer. */
typedef struct place {
    const uint8_t *scaling, *weights;
    uint32_t whole, first;
} place;

typedef __v8si eight; /* not __m256i: where sums change their type, gcc 12 copies them in every turn of a loop */

/* Two activations in all lanes. */
INLINE __m256i pair_at(const int16_t *x)
{
    return _mm256_broadcastd_epi32(_mm_loadu_si32(x));
}

/* The sums of `vectors` vectors of outputs at `pixels` pixels. A sum of two products is at most 2^15. */
INLINE void add_up(eight sum[MOST_SUMS], const t3r_block *block, const size_t *offset, const place *at,
                   uint32_t vectors, uint32_t pixels)
{
    const uint32_t pairs = (block->run + T3R_PACKED_TAPS - 1) / T3R_PACKED_TAPS * T3R_PACKED_TAPS / TAPS;
    const uint8_t *w = at->weights + (size_t)at->first * TAPS;
    EACH(s, vectors * pixels)
    {
        sum[s] = (eight)t3r_x86_eight(at->scaling, T3R_X86_BIAS, at->whole, at->first + s % vectors * LANES);
    }
    for (uint32_t row = 0; row < block->rows; row++) {
        const int16_t *x = (const int16_t *)block->x + (size_t)row * block->pitch;
        for (uint32_t pair = 0; pair < pairs; pair++, x += TAPS, w += (size_t)at->whole * TAPS) {
            __m256i weights[MOST_SUMS];
            EACH(v, vectors)
            {
                weights[v] =
                    _mm256_cvtepi8_epi16(_mm_loadu_si128((const __m128i_u *)(const void *)(w + v * LANES * TAPS)));
            }
            EACH(p, pixels)
            {
                const __m256i two = pair_at(x + offset[p]);
                EACH(v, vectors)
                {
                    sum[p * vectors + v] += (eight)_mm256_madd_epi16(two, weights[v]);
                }
            }
        }
    }
}

/* Writes the first `count` activations, at most eight: x, held within 8 or 16 bits. */
INLINE void write(__m256i x, uint32_t output_bits, uint32_t count, void *out, size_t at)
{
    const __m128i held = _mm_packs_epi32(_mm256_castsi256_si128(x), _mm256_extracti128_si256(x, 1));
    const uint32_t bytes = output_bits / 8;
    __m128i left = output_bits == 8 ? _mm_packs_epi16(held, held) : held;
    uint8_t *to = (uint8_t *)out + at * bytes;
    if (count * bytes >= 16) {
        _mm_storeu_si128((__m128i_u *)(void *)to, left);
    } else if (count >= LANES) {
        _mm_storel_epi64((__m128i_u *)(void *)to, left);
    } else {
        for (uint32_t i = 0; i < count * bytes / 4; i++, to += 4, left = _mm_srli_si128(left, 4)) {
            _mm_storeu_si32(to, left);
        }
        const uint32_t rest = (uint32_t)_mm_cvtsi128_si32(left);
        for (uint32_t i = 0; i < count * bytes % 4; i++) {
            to[i] = (uint8_t)(rest >> (8 * i));
        }
    }
}

/* All pixels, `pixels` at a time; behind the last, it again. */
INLINE void convolve(const t3r_convolution *layer, const t3r_block *block, const place *at, uint32_t vectors,
                     uint32_t pixels, void *out, uint32_t out_pitch)
{
    for (uint32_t i = 0; i < block->pixels; i += pixels) {
        size_t offset[MOST_SUMS], pixel[MOST_SUMS];
        eight sum[MOST_SUMS];
        for (uint32_t p = 0; p < pixels; p++) {
            pixel[p] = i + p < block->pixels ? i + p : block->pixels - 1;
            offset[p] = pixel[p] * block->step;
        }
        add_up(sum, block, offset, at, vectors, pixels);
        EACH(p, pixels)
        {
            EACH(v, vectors)
            {
                const uint32_t first = at->first + v * LANES;
                write(t3r_x86_scaled((__m256i)sum[p * vectors + v], at->scaling, at->whole, first, layer->zero),
                      layer->output_bits, T3R_MIN(layer->outputs - first, LANES), out, pixel[p] * out_pitch + first);
            }
        }
    }
}

static __attribute__((noinline)) T3R_AVX2 void convolve_two(const t3r_convolution *layer, const t3r_block *block,
                                                            const place *at, void *out, uint32_t out_pitch)
{
    convolve(layer, block, at, 2, 4, out, out_pitch);
}

static __attribute__((noinline)) T3R_AVX2 void convolve_one(const t3r_convolution *layer, const t3r_block *block,
                                                            const place *at, void *out, uint32_t out_pitch)
{
    convolve(layer, block, at, 1, 8, out, out_pitch);
}

T3R_AVX2 void t3r_convolve_packed_avx2(const t3r_convolution *layer, const void *packed, const t3r_block *block,
                                       void *out, uint32_t out_pitch)
{
    const uint32_t whole = t3r_x86_whole(layer->outputs);
    place at = {packed, (const uint8_t *)packed + (size_t)whole * T3R_PACKED_SCALING_BYTES, whole, 0};
    for (; at.first + LANES < whole; at.first += 2 * LANES) {
        convolve_two(layer, block, &at, out, out_pitch);
    }
    if (at.first < whole) {
        convolve_one(layer, block, &at, out, out_pitch);
    }
}

#else
typedef int t3r_no_convolve_packed_avx2; /* a file may not be empty */
#endif
