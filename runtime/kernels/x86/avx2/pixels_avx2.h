/* SPDX-License-Identifier: Apache-2.0 */
/* Sixteen pixels of a tile in a vector, eight in each half, for blending and scattering. */
#ifndef T3R_KERNELS_X86_PIXELS_AVX2_H
#define T3R_KERNELS_X86_PIXELS_AVX2_H

#include "kernels/blend.h"
#include "kernels/lanes/vectors/tile_planes.h"
#include "lanes_avx2.h"

#define PIXELS 16
#define PIXELS_USUAL T3R_TWO_ROWS

/* Shapes of a vector's pixels. */
typedef enum shape {
    T3R_ONE_ROW, /* eight columns; the high half is unused */
    T3R_TWO_ROWS,
    T3R_WHOLE_ROW /* sixteen columns */
} shape;

static inline T3R_AVX2 lanes load_pixels(const void *from, shape which)
{
    const uint16_t *at = from;
    if (which == T3R_WHOLE_ROW) {
        return load(at);
    }
    const __m128i first = _mm_loadu_si128((const __m128i *)(const void *)at);
    if (which == T3R_ONE_ROW) {
        return _mm256_zextsi128_si256(first);
    }
    const __m128i second = _mm_loadu_si128((const __m128i *)(const void *)(at + T3R_TILE_SIDE));
    return _mm256_inserti128_si256(_mm256_castsi128_si256(first), second, 1);
}

static inline T3R_AVX2 void store_pixels(uint16_t *at, shape which, lanes x)
{
    if (which == T3R_WHOLE_ROW) {
        store(at, x);
        return;
    }
    _mm_storeu_si128((__m128i *)(void *)at, part(x, 0));
    if (which == T3R_TWO_ROWS) {
        _mm_storeu_si128((__m128i *)(void *)(at + T3R_TILE_SIDE), part(x, 1));
    }
}

/* Loads the kept weights and alphas of the low and the high half. */
static inline T3R_AVX2 void load_kept(const t3r_blended_row *low, const t3r_blended_row *high, shape which,
                                      lanes *weights, lanes *alphas)
{
    const lanes first = load(low), second = which == T3R_ONE_ROW ? all(0) : load(high);
    *weights = _mm256_permute2x128_si256(first, second, 0x20);
    *alphas = _mm256_permute2x128_si256(first, second, 0x31);
}

static inline T3R_AVX2 void store_kept(t3r_blended_row *low, t3r_blended_row *high, shape which, lanes weights,
                                       lanes alphas)
{
    store(low, _mm256_permute2x128_si256(weights, alphas, 0x20));
    if (which != T3R_ONE_ROW) {
        store(high, _mm256_permute2x128_si256(weights, alphas, 0x31));
    }
}

#endif
