/* The nearest centre by looking at all of them, eight at a time. */
#include "variants.h"

#ifdef T3R_X86

#include "intrinsics.h"
#include "packed_centres.h"

#define LANES 8u

static T3R_AVX2 __m256i load(const t3r_neighbours *packed, size_t offset, uint32_t k)
{
    return _mm256_loadu_si256((const __m256i_u *)(const void *)t3r_packed_at(packed, offset, k));
}

static T3R_AVX2 void store(t3r_neighbours *packed, size_t offset, uint32_t k, const int32_t from[LANES])
{
    _mm256_storeu_si256((__m256i_u *)(void *)((uint8_t *)packed + offset + (size_t)k * sizeof(int32_t)),
                        _mm256_loadu_si256((const __m256i_u *)(const void *)from));
}

T3R_AVX2 void t3r_nearest_begin_avx2(const t3r_centres *centres, uint32_t first, uint32_t end,
                                     t3r_neighbours *neighbours)
{
    const uint32_t whole = (end + T3R_CENTRE_GROUP - 1) / T3R_CENTRE_GROUP * T3R_CENTRE_GROUP;
    for (uint32_t at = first; at < whole; at += LANES) {
        int32_t pair[T3R_PAIRS][LANES], half_norm[LANES];
        for (uint32_t i = 0; i < LANES; i++) {
            const uint32_t k = at + i;
            const bool is_centre = k < centres->count;
            for (uint32_t d = 0; d < T3R_PAIRS; d++) {
                const int16_t two[2] = {is_centre ? centres->feature_q11[2 * d][k] : 0,
                                        is_centre ? centres->feature_q11[2 * d + 1][k] : 0};
                pair[d][i] = t3r_pair_of(two, 0);
            }
            half_norm[i] = is_centre ? centres->half_norm[k] : INT32_MAX; /* no centre's score is so large */
        }
        for (uint32_t d = 0; d < T3R_PAIRS; d++) {
            store(neighbours, T3R_PACKED_PAIR(d), at, pair[d]);
        }
        store(neighbours, T3R_PACKED_HALF_NORM, at, half_norm);
    }
}

/* Not __m256i: where the least so far changes its type, gcc 12 copies it in every turn of a loop. */
typedef __v8si eight;

/* A point, and in each lane the least score so far and the first centre of the eight that had it. */
typedef struct search {
    __m256i pair[T3R_PAIRS];
    eight least, first;
} search;

static T3R_AVX2 search search_of(const int16_t p[T3R_DIMENSIONS])
{
    search s = {.least = (eight)_mm256_set1_epi32(INT32_MAX), .first = (eight)_mm256_setzero_si256()};
    for (uint32_t d = 0; d < T3R_PAIRS; d++) {
        s.pair[d] = _mm256_set1_epi32(t3r_pair_of(p, d));
    }
    return s;
}

/* Scores are below 2^31 in size, as are their parts: |p c| is at most 6 x 15000^2. A lane keeps the earlier of equals.
 */
static inline T3R_AVX2 void look(search *s, const __m256i pair[T3R_PAIRS], __m256i half_norm, __m256i here)
{
    const eight score = (eight)half_norm - (eight)_mm256_madd_epi16(s->pair[0], pair[0]) -
                        (eight)_mm256_madd_epi16(s->pair[1], pair[1]) - (eight)_mm256_madd_epi16(s->pair[2], pair[2]);
    const __m256i less = _mm256_cmpgt_epi32((__m256i)s->least, (__m256i)score);
    s->least = (eight)_mm256_min_epi32((__m256i)s->least, (__m256i)score);
    s->first = (eight)_mm256_blendv_epi8((__m256i)s->first, here, less);
}

/* The least number of eight, in all lanes. */
static inline T3R_AVX2 __m256i least_of(__m256i x)
{
    x = _mm256_min_epi32(x, _mm256_permute2x128_si256(x, x, 0x01));
    x = _mm256_min_epi32(x, _mm256_shuffle_epi32(x, 0x4e));
    return _mm256_min_epi32(x, _mm256_shuffle_epi32(x, 0xb1));
}

/* The least index of the least score. */
static inline T3R_AVX2 uint16_t nearest_of(const search *s)
{
    const eight index = s->first + (eight){0, 1, 2, 3, 4, 5, 6, 7};
    const __m256i equal = _mm256_cmpeq_epi32((__m256i)s->least, least_of((__m256i)s->least));
    const __m256i others = _mm256_set1_epi32(INT32_MAX);
    const __m256i nearest = least_of(_mm256_blendv_epi8(others, (__m256i)index, equal));
    return (uint16_t)_mm_cvtsi128_si32(_mm256_castsi256_si128(nearest));
}

T3R_AVX2 void t3r_nearest_avx2(const t3r_centres *centres, const t3r_neighbours *neighbours, uint32_t points,
                               const int16_t (*feature_q11)[T3R_DIMENSIONS], uint16_t guess, uint16_t *nearest)
{
    (void)guess;
    for (uint32_t point = 0; point < points; point += 2) { /* two share the loads; behind the last, the last again */
        const uint32_t other = point + 1 < points ? point + 1 : point;
        search a = search_of(feature_q11[point]), b = search_of(feature_q11[other]);
        for (uint32_t k = 0; k < centres->count; k += LANES) {
            __m256i pair[T3R_PAIRS];
            for (uint32_t d = 0; d < T3R_PAIRS; d++) {
                pair[d] = load(neighbours, T3R_PACKED_PAIR(d), k);
            }
            const __m256i half_norm = load(neighbours, T3R_PACKED_HALF_NORM, k);
            const __m256i here = _mm256_set1_epi32((int32_t)k);
            look(&a, pair, half_norm, here);
            look(&b, pair, half_norm, here);
        }
        nearest[point] = nearest_of(&a);
        nearest[other] = nearest_of(&b);
    }
}

#else
typedef int t3r_no_nearest_avx2; /* a file may not be empty */
#endif
