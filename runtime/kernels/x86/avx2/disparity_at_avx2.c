/* SPDX-License-Identifier: Apache-2.0 */
/* Disparities at eight places at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "core/fixed.h"
#include "places_avx2.h"

/* Numbers of four pixels: left and right, above and below. */
typedef struct square {
    lanes a, b, c, d;
} square;

static inline T3R_AVX2 lanes least_of(square s)
{
    return least(least(s.a, s.b), least(s.c, s.d));
}

static inline T3R_AVX2 lanes most_of(square s)
{
    return most(most(s.a, s.b), most(s.c, s.d));
}

static inline T3R_AVX2 lanes one_of(square s, lanes right, lanes below)
{
    return where(below, where(right, s.d, s.c), where(right, s.b, s.a));
}

/* Interpolates. The result is unused if a disparity is T3R_NO_DISPARITY. */
static inline T3R_AVX2 lanes between(square s, lanes fx, lanes fy)
{
    const ulanes upper = (ulanes)(s.a * 256 + fx * (s.b - s.a)), lower = (ulanes)(s.c * 256 + fx * (s.d - s.c));
    return (lanes)((upper * 256 + (ulanes)fy * (lower - upper) + 32768) >> 16);
}

static inline T3R_AVX2 lanes words_from(const uint16_t *plane, lanes at)
{
    return (lanes)_mm256_i32gather_epi32((const int *)(const void *)plane, (__m256i)at, 2);
}

/* Returns size reciprocal / 2^shift, its lower 32 bits. */
static inline T3R_AVX2 ulanes times_reciprocal(ulanes size, const t3r_divisor *by)
{
    const __m256i reciprocal = _mm256_set1_epi32((int)by->reciprocal);
    const __m128i shift = _mm_cvtsi32_si128((int)by->shift);
    const __m256i even = _mm256_srl_epi64(_mm256_mul_epu32((__m256i)size, reciprocal), shift);
    const __m256i odd = _mm256_srl_epi64(_mm256_mul_epu32(_mm256_srli_epi64((__m256i)size, 32), reciprocal), shift);
    return (ulanes)_mm256_blend_epi32(even, _mm256_slli_epi64(odd, 32), 0xaa);
}

/* Returns t3r_divide_q24() with a limit of 4, of numbers above -2^31. */
static inline T3R_AVX2 lanes divide_q24(const t3r_divisor *by, lanes x)
{
    const lanes sign = x >> 31, limited = (lanes)((ulanes)((x ^ sign) - sign) >> 2) >= (int32_t)by->d;
    const ulanes size = (ulanes)((x ^ sign) - sign);
    ulanes q = times_reciprocal(size, by);
    const ulanes rest = (size << 24) + ((by->d + (ulanes)sign) >> 1) - q * by->d;
    q -= (ulanes)(rest >= by->d);
    return (where(limited, (lanes){0} + (4 << 24), (lanes)q) ^ sign) - sign;
}

static inline T3R_AVX2 void store(int32_t *to, lanes x)
{
    _mm256_storeu_si256((__m256i *)to, (__m256i)x);
}

static inline T3R_AVX2 void eight(const t3r_disparity_plane *plane, const int32_t columns[2],
                                  const t3r_ray_places *places, uint32_t i, t3r_disparities *out)
{
    const int32_t width = (int32_t)plane->width, height = (int32_t)plane->height, last = width * height - 4;
    const lanes place = load(places->x_q16 + i);
    const lanes x = rounded(least(most(place, (lanes){0} + columns[0]), (lanes){0} + columns[1]) - plane->begin_q16, 8);
    const lanes y = rounded(load(places->y_q16 + i), 8);
    const lanes column = rounded(x, 8), row = rounded(y, 8);
    const lanes inside =
        (column == held(column, width - 1)) & (row == held(row, height - 1)) & (load(places->z_q24 + i) != 0);
    /* a square of pixels, the nearest among them, where all are in the plane that about the place */
    const lanes left = held(x >> 8, width - 2), top = held(y >> 8, height - 2), at = top * width + left;
    const lanes k_upper = words_from(plane->disparity, at), k_lower = words_from(plane->disparity, at + width);
    const lanes c_upper = bytes_from(plane->confidence, at, last);
    const lanes c_lower = bytes_from(plane->confidence, at + width, last);
    const square k = {k_upper & 65535, (lanes)((ulanes)k_upper >> 16), k_lower & 65535, (lanes)((ulanes)k_lower >> 16)};
    const square c = {c_upper & 255, (c_upper >> 8) & 255, c_lower & 255, (c_lower >> 8) & 255};
    const lanes right = column != left, below = row != top;
    const lanes own = one_of(k, right, below), confidence = one_of(c, right, below), matched = confidence != 0;
    const lanes any = inside & (own != T3R_NO_DISPARITY) & (matched | -(int32_t)plane->filled);
    const lanes smooth = (x >> 8 == left) & (y >> 8 == top) & ((least_of(c) != 0) | (most_of(c) == 0)) &
                         (most_of(k) - own <= 1 << T3R_DISPARITY_BITS) & (own - least_of(k) <= 1 << T3R_DISPARITY_BITS);
    const lanes here = where(smooth, between(k, x & 255, y & 255), own);
    const lanes disparity = (plane->first * 65536 + here * (1 << (16 - T3R_DISPARITY_BITS))) & any;
    const lanes mine = place & any;
    store(out->disparity_q16 + i, disparity);
    store(out->confidence + i, where(matched, most(confidence, (lanes){0} + 2), (lanes){0} + 1) & any);
    store(out->own_q24 + i, divide_q24(&plane->scale, mine));
    store(out->other_q24 + i, divide_q24(&plane->scale, plane->right ? mine + disparity : mine - disparity));
}

T3R_AVX2 void t3r_disparity_at_avx2(const t3r_disparity_plane *given, const t3r_ray_places *places, uint32_t count,
                                    t3r_disparities *out)
{
    const t3r_disparity_plane plane = *given; /* a copy, which vector writes cannot change */
    /* columns further out are clamped, so that differences from the first stay within 32 bits */
    const int64_t from = (int64_t)plane.begin_q16 - 2 * 65536,
                  to = plane.begin_q16 + ((int64_t)plane.width + 1) * 65536;
    const int32_t columns[2] = {(int32_t)T3R_MAX(from, INT32_MIN), (int32_t)T3R_MIN(to, INT32_MAX)};
    for (uint32_t i = 0; i < count; i += 8) {
        eight(&plane, columns, places, i, out);
    }
}

#else
typedef int t3r_no_disparity_at_avx2; /* a file may not be empty */
#endif
