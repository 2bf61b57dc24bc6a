/* Sixteen pixels of a tile in a vector, eight in each half: blending and scattering. */
#ifndef T3R_KERNELS_X86_SIXTEEN_H
#define T3R_KERNELS_X86_SIXTEEN_H

#include "intrinsics.h"
#include "variants.h"

/* Where they lie. */
typedef enum t3r_sixteen {
    T3R_ONE_ROW, /* eight columns; the high half is nothing */
    T3R_TWO_ROWS,
    T3R_WHOLE_ROW /* sixteen columns */
} t3r_sixteen;

static inline T3R_AVX2 __m256i t3r_load_sixteen(const void *from, t3r_sixteen pixels)
{
    const uint16_t *at = from;
    if (pixels == T3R_WHOLE_ROW) {
        return _mm256_loadu_si256((const __m256i *)(const void *)at);
    }
    const __m128i first = _mm_loadu_si128((const __m128i *)(const void *)at);
    if (pixels == T3R_ONE_ROW) {
        return _mm256_zextsi128_si256(first);
    }
    const __m128i second = _mm_loadu_si128((const __m128i *)(const void *)(at + T3R_TILE_SIDE));
    return _mm256_inserti128_si256(_mm256_castsi128_si256(first), second, 1);
}

static inline T3R_AVX2 void t3r_store_sixteen(uint16_t *at, t3r_sixteen pixels, __m256i x)
{
    if (pixels == T3R_WHOLE_ROW) {
        _mm256_storeu_si256((__m256i *)(void *)at, x);
        return;
    }
    _mm_storeu_si128((__m128i *)(void *)at, _mm256_castsi256_si128(x));
    if (pixels == T3R_TWO_ROWS) {
        _mm_storeu_si128((__m128i *)(void *)(at + T3R_TILE_SIDE), _mm256_extracti128_si256(x, 1));
    }
}

#endif
