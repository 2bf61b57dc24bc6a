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

/* A point, and in each lane the least score so far and the first centre of the eight that had it. */
typedef struct search {
    __m256i pair[T3R_PAIRS];
    __m256i least, first;
} search;

static T3R_AVX2 search search_of(const int16_t p[T3R_DIMENSIONS])
{
    search s = {.least = _mm256_set1_epi32(INT32_MAX), .first = _mm256_setzero_si256()};
    for (uint32_t d = 0; d < T3R_PAIRS; d++) {
        s.pair[d] = _mm256_set1_epi32(t3r_pair_of(p, d));
    }
    return s;
}

/* Scores are below 2^31 in size, as are their parts: |p c| is at most 6 x 15000^2. A lane keeps the earlier of equals.
 */
static inline T3R_AVX2 void look(search *s, const __m256i pair[T3R_PAIRS], __m256i half_norm, __m256i here)
{
    __m256i dot = _mm256_madd_epi16(s->pair[0], pair[0]);
    dot = _mm256_add_epi32(dot, _mm256_madd_epi16(s->pair[1], pair[1]));
    dot = _mm256_add_epi32(dot, _mm256_madd_epi16(s->pair[2], pair[2]));
    __m256i score = _mm256_sub_epi32(half_norm, dot), less = _mm256_cmpgt_epi32(s->least, score);
    s->least = _mm256_min_epi32(s->least, score);
    s->first = _mm256_blendv_epi8(s->first, here, less);
}

/* The least index of the least score. */
static T3R_AVX2 uint16_t nearest_of(const search *s)
{
    int32_t least[LANES], first[LANES];
    _mm256_storeu_si256((__m256i *)(void *)least, s->least);
    _mm256_storeu_si256((__m256i *)(void *)first, s->first);
    uint32_t best = 0;
    for (uint32_t i = 1; i < LANES; i++) {
        uint32_t index = (uint32_t)first[i] + i, best_index = (uint32_t)first[best] + best;
        if (least[i] < least[best] || (least[i] == least[best] && index < best_index)) {
            best = i;
        }
    }
    return (uint16_t)((uint32_t)first[best] + best);
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
