/* SPDX-License-Identifier: Apache-2.0 */
/* A picture's luma at eight places at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "places_avx2.h"

/* A row's pixel x and the next one, and the weight between them. */
typedef struct row_part {
    lanes here, next, between_q8;
} row_part;

static inline T3R_AVX2 row_part row_of(lanes four, lanes at_end, lanes fraction)
{
    const lanes here = four & 255, next = where(at_end, here, (four >> 8) & 255);
    return (row_part){here, next, here * 256 + fraction * (next - here)};
}

static inline T3R_AVX2 void eight(const t3r_luma_picture *picture, const t3r_ray_places *places, uint32_t i,
                                  uint8_t *out)
{
    const int32_t width = (int32_t)picture->width, height = (int32_t)picture->height, last = width * height - 4;
    const lanes u = load(places->x_q16 + i), v = load(places->y_q16 + i), z = load(places->z_q24 + i);
    const lanes nearest_x = rounded(u, 16), nearest_y = rounded(v, 16);
    const lanes inside = (nearest_x == held(nearest_x, width - 1)) & (nearest_y == held(nearest_y, height - 1));
    const lanes u_q8 = held(rounded(u, 8), (width - 1) << 8), v_q8 = held(rounded(v, 8), (height - 1) << 8);
    const lanes x = u_q8 >> 8, y = v_q8 >> 8, at = y * width + x, below = at + ((y != height - 1) & width);
    const row_part top = row_of(bytes_from(picture->luma, at, last), x == width - 1, u_q8 & 255);
    const row_part bottom = row_of(bytes_from(picture->luma, below, last), x == width - 1, u_q8 & 255);
    const lanes nearest = where(nearest_y == y, where(nearest_x == x, top.here, top.next),
                                where(nearest_x == x, bottom.here, bottom.next));
    const lanes sum = top.between_q8 * 256 + (v_q8 & 255) * (bottom.between_q8 - top.between_q8);
    const lanes seen = most((sum + 32768) >> 16, (lanes){0} + 1) & inside & (z != 0) & (nearest != 0);
    const __m256i words = _mm256_packus_epi32((__m256i)seen, (__m256i)seen);
    const __m256i bytes = _mm256_packus_epi16(words, words); /* four in each half */
    const __m256i all = _mm256_permutevar8x32_epi32(bytes, _mm256_setr_epi32(0, 4, 0, 4, 0, 4, 0, 4));
    _mm_storel_epi64((__m128i *)out, _mm256_castsi256_si128(all));
}

T3R_AVX2 void t3r_luma_at_avx2(const t3r_luma_picture *given, const t3r_ray_places *places, uint32_t count,
                               uint8_t *out)
{
    const t3r_luma_picture picture = *given; /* a copy, which byte writes cannot change */
    const uint32_t whole = count & ~7u;
    for (uint32_t i = 0; i < whole; i += 8) {
        eight(&picture, places, i, out + i);
    }
    if (whole < count) {
        uint8_t rest[8] = {0};
        eight(&picture, places, whole, rest);
        for (uint32_t i = whole; i < count; i++) {
            out[i] = rest[i - whole];
        }
    }
}

#else
typedef int t3r_no_luma_at_avx2; /* a file may not be empty */
#endif
