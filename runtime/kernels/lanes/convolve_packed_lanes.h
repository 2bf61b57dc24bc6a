/* SPDX-License-Identifier: Apache-2.0 */
/* A packed layer, LANES outputs a vector: TAPS activations, in all lanes, times TAPS weights of each output. Included
 * after a header of lanes and one that multiplies, such as pairs_of_taps.h, in a file that names the functions
 * PACK_LAYER and CONVOLVE_PACKED. */
#ifndef T3R_KERNELS_LANES_CONVOLVE_PACKED_LANES_H
#define T3R_KERNELS_LANES_CONVOLVE_PACKED_LANES_H

#include "requantize_lanes.h"

#define INLINE T3R_LANES_INLINE T3R_LANES_TARGET
#define EACH(i, count) T3R_LANES_UNROLL for (uint32_t i = 0; i < (count); i++)
#ifndef MOST_SUMS
#define MOST_SUMS 8u /* vectors */
#endif

T3R_LANES_TARGET void PACK_LAYER(const t3r_convolution *layer, uint32_t rows, void *packed)
{
    t3r_pack_layer_with(layer, rows, TAPS, 0, BY_FACTORS, packed);
}

/* The parts of a packed layer for the outputs from `first` on. */
typedef struct place {
    const uint8_t *scaling, *weights;
    uint32_t whole, first;
} place;

/* Adds up `vectors` vectors of outputs at `pixels` pixels. */
INLINE void add_up(ints sum[MOST_SUMS], const t3r_block *block, const size_t *offset, const place *at, uint32_t vectors,
                   uint32_t pixels)
{
    const uint32_t groups = (block->run + T3R_PACKED_TAPS - 1) / T3R_PACKED_TAPS * T3R_PACKED_TAPS / TAPS;
    const uint8_t *w = at->weights + (size_t)at->first * TAPS;
    EACH(s, vectors * pixels)
    {
        sum[s] = (ints)t3r_packed_scaling_at(at->scaling, T3R_SCALING_BIAS, at->whole, at->first + s % vectors * LANES);
    }
    for (uint32_t row = 0; row < block->rows; row++) {
        const activation *x = (const activation *)block->x + (size_t)row * block->pitch;
        for (uint32_t group = 0; group < groups; group++, x += TAPS, w += (size_t)at->whole * TAPS) {
            lanes weights[MOST_SUMS];
            EACH(v, vectors)
            {
                weights[v] = load_weights(w + v * LANES * TAPS);
            }
            EACH(p, pixels)
            {
                const lanes repeated_taps = taps_at(x + offset[p]);
                EACH(v, vectors)
                {
                    add_products(&sum[p * vectors + v], repeated_taps, weights[v]);
                }
            }
        }
    }
}

/* Writes the first `count` activations of x, clamped to 8 or 16 bits. */
INLINE void write(lanes x, uint32_t output_bits, uint32_t count, void *out, size_t at)
{
    const quad held = OF_QUAD(packs_epi32)(part(x, 0), part(x, LANES / 4 - 1));
    const uint32_t bytes = output_bits / 8;
    quad left = output_bits == 8 ? OF_QUAD(packs_epi16)(held, held) : held;
    uint8_t *to = (uint8_t *)out + at * bytes;
    if (count * bytes >= 16) {
        store_quad(to, left);
    } else if (count * bytes == 8) {
        store_half_quad(to, left);
    } else {
        for (uint32_t i = 0; i < count * bytes / 4; i++, to += 4, left = OF_QUAD(srli_si128)(left, 4)) {
            store_quarter_quad(to, left);
        }
        const uint32_t rest = (uint32_t)OF_QUAD(cvtsi128_si32)(left);
        for (uint32_t i = 0; i < count * bytes % 4; i++) {
            to[i] = (uint8_t)(rest >> (8 * i));
        }
    }
}

/* Convolves all pixels, `pixels` at a time; pads by repeating the last. */
INLINE void convolve(const t3r_convolution *layer, const t3r_block *block, const place *at, uint32_t vectors,
                     uint32_t pixels, void *out, uint32_t out_pitch)
{
    for (uint32_t i = 0; i < block->pixels; i += pixels) {
        size_t offset[MOST_SUMS], pixel[MOST_SUMS];
        ints sum[MOST_SUMS];
        for (uint32_t p = 0; p < pixels; p++) {
            pixel[p] = i + p < block->pixels ? i + p : block->pixels - 1;
            offset[p] = pixel[p] * block->step;
        }
        add_up(sum, block, offset, at, vectors, pixels);
        EACH(p, pixels)
        {
            EACH(v, vectors)
            {
                const uint32_t first = at->first + v * LANES, left = layer->outputs - T3R_MIN(first, layer->outputs);
                write(t3r_packed_scaled((lanes)sum[p * vectors + v], at->scaling, at->whole, first, layer->zero),
                      layer->output_bits, T3R_MIN(left, LANES), out, pixel[p] * out_pitch + first);
            }
        }
    }
}

static __attribute__((noinline)) T3R_LANES_TARGET void
convolve_eight(const t3r_convolution *layer, const t3r_block *block, const place *at, void *out, uint32_t out_pitch)
{
    convolve(layer, block, at, 8 / LANES, MOST_SUMS * LANES / 8, out, out_pitch);
}

static __attribute__((noinline)) T3R_LANES_TARGET void
convolve_sixteen(const t3r_convolution *layer, const t3r_block *block, const place *at, void *out, uint32_t out_pitch)
{
    convolve(layer, block, at, 16 / LANES, MOST_SUMS * LANES / 16, out, out_pitch);
}

T3R_LANES_TARGET void CONVOLVE_PACKED(const t3r_convolution *layer, const void *packed, const t3r_block *block,
                                      void *out, uint32_t out_pitch)
{
    const uint32_t whole = t3r_packed_outputs(layer->outputs);
    place at = {packed, (const uint8_t *)packed + (size_t)whole * T3R_PACKED_SCALING_BYTES, whole, 0};
    for (; at.first + 16 <= whole; at.first += 16) {
        convolve_sixteen(layer, block, &at, out, out_pitch);
    }
    if (at.first < whole) {
        convolve_eight(layer, block, &at, out, out_pitch);
    }
}

#endif
