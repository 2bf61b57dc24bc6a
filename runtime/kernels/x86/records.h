/* Eight Gaussians read, or eight splats written, a vector a word. */
#ifndef T3R_KERNELS_X86_RECORDS_H
#define T3R_KERNELS_X86_RECORDS_H

#include <stddef.h>

#include "intrinsics.h"
#include "kernels/project.h"
#include "variants.h"

/* Words 0..7 of eight records to a vector a word, or back. */
static inline T3R_AVX2 void transpose(__m256i v[8])
{
    __m256i t[8], u[8];
    for (int i = 0; i < 8; i += 2) {
        t[i] = _mm256_unpacklo_epi32(v[i], v[i + 1]);
        t[i + 1] = _mm256_unpackhi_epi32(v[i], v[i + 1]);
    }
    for (int i = 0; i < 8; i += 4) {
        u[i] = _mm256_unpacklo_epi64(t[i], t[i + 2]);
        u[i + 1] = _mm256_unpackhi_epi64(t[i], t[i + 2]);
        u[i + 2] = _mm256_unpacklo_epi64(t[i + 1], t[i + 3]);
        u[i + 3] = _mm256_unpackhi_epi64(t[i + 1], t[i + 3]);
    }
    for (int i = 0; i < 4; i++) {
        v[i] = _mm256_permute2x128_si256(u[i], u[i + 4], 0x20);
        v[i + 4] = _mm256_permute2x128_si256(u[i], u[i + 4], 0x31);
    }
}

_Static_assert(offsetof(t3r_gaussian, factor) == 12 && offsetof(t3r_gaussian, factor_exponent) == 30 &&
                   offsetof(t3r_gaussian, colour_q7) == 32 && offsetof(t3r_gaussian, opacity_q15) == 38,
               "a Gaussian's first ten words");

/* The first ten words: position, factor and exponent, colours and opacity. */
static inline T3R_AVX2 void read_eight(const t3r_gaussian *gaussians, __m256i word[10])
{
    __m256i pair[4];
    for (int i = 0; i < 8; i++) {
        word[i] = _mm256_loadu_si256((const __m256i *)(const void *)&gaussians[i]);
    }
    transpose(word);
    for (int i = 0; i < 4; i++) { /* 0 and 4, 1 and 5, 2 and 6, 3 and 7 */
        const __m128i lower = _mm_loadl_epi64((const __m128i *)(const void *)gaussians[i].colour_q7);
        const __m128i upper = _mm_loadl_epi64((const __m128i *)(const void *)gaussians[i + 4].colour_q7);
        pair[i] = _mm256_inserti128_si256(_mm256_castsi128_si256(lower), upper, 1);
    }
    const __m256i a = _mm256_unpacklo_epi32(pair[0], pair[1]), b = _mm256_unpacklo_epi32(pair[2], pair[3]);
    word[8] = _mm256_unpacklo_epi64(a, b);
    word[9] = _mm256_unpackhi_epi64(a, b);
}

_Static_assert(offsetof(t3r_splat, a_q30) == 8 && offsetof(t3r_splat, z_q20) == 20 &&
                   offsetof(t3r_splat, colour_q7) == 24 && offsetof(t3r_splat, opacity_q15) == 30 &&
                   offsetof(t3r_splat, x0) == 32 && offsetof(t3r_splat, y0) == 34 && offsetof(t3r_splat, x1) == 36,
               "a splat's ten words");

/* Ten words: centre, conic, depth, colours and opacity, box. */
static inline T3R_AVX2 void write_eight(__m256i word[10], t3r_splat *splats)
{
    const __m256i boxes[2] = {_mm256_unpacklo_epi32(word[8], word[9]), _mm256_unpackhi_epi32(word[8], word[9])};
    transpose(word);
    for (int i = 0; i < 8; i++) {
        _mm256_storeu_si256((__m256i *)(void *)&splats[i], word[i]);
    }
    for (int half = 0; half < 2; half++) { /* 0, 1 and 4, 5; 2, 3 and 6, 7 */
        const __m128i lower = _mm256_castsi256_si128(boxes[half]), upper = _mm256_extracti128_si256(boxes[half], 1);
        t3r_splat *s = splats + 2 * half;
        _mm_storel_epi64((__m128i *)(void *)&s[0].x0, lower);
        _mm_storel_epi64((__m128i *)(void *)&s[1].x0, _mm_unpackhi_epi64(lower, lower));
        _mm_storel_epi64((__m128i *)(void *)&s[4].x0, upper);
        _mm_storel_epi64((__m128i *)(void *)&s[5].x0, _mm_unpackhi_epi64(upper, upper));
    }
}

#endif
