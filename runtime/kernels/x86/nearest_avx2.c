/* The nearest centre by looking at all of them, eight at a time. */
#include "variants.h"

#ifdef T3R_X86

#include "intrinsics.h"

#define LANES 8u

/* What nearest_begin leaves in the place of the neighbours: features by pairs of dimensions, as _mm256_madd_epi16()
 * takes them, and half norms; up to a multiple of 8 centres that are nearest to nothing. */
typedef struct packed_centres {
    int32_t pair[T3R_DIMENSIONS / 2][T3R_MAX_CLUSTERS];
    int32_t half_norm[T3R_MAX_CLUSTERS];
} packed_centres;

_Static_assert(sizeof(packed_centres) <= sizeof(t3r_neighbours), "the packed centres lie where plain C has neighbours");
_Static_assert(T3R_MAX_CLUSTERS % LANES == 0, "whole vectors");

static uint8_t *place_of(const void *packed, size_t offset, uint32_t k)
{
    return (uint8_t *)(uintptr_t)packed + offset + (size_t)k * sizeof(int32_t);
}

static T3R_AVX2 __m256i load(const void *packed, size_t offset, uint32_t k)
{
    return _mm256_loadu_si256((const __m256i *)(const void *)place_of(packed, offset, k));
}

static T3R_AVX2 void store(void *packed, size_t offset, uint32_t k, __m256i x)
{
    _mm256_storeu_si256((__m256i *)(void *)place_of(packed, offset, k), x);
}

T3R_AVX2 void t3r_nearest_begin_avx2(const t3r_centres *centres, uint32_t first, uint32_t end,
                                     t3r_neighbours *neighbours)
{
    for (uint32_t at = first; at < end; at += LANES) {
        int32_t pair[T3R_DIMENSIONS / 2][LANES], half_norm[LANES];
        for (uint32_t i = 0; i < LANES; i++) {
            const uint32_t k = at + i;
            const bool is_centre = k < centres->count;
            for (uint32_t d = 0; d < T3R_DIMENSIONS / 2; d++) {
                uint32_t low = is_centre ? (uint16_t)centres->feature_q11[2 * d][k] : 0;
                uint32_t high = is_centre ? (uint16_t)centres->feature_q11[2 * d + 1][k] : 0;
                pair[d][i] = (int32_t)(low | high << 16);
            }
            half_norm[i] = is_centre ? centres->half_norm[k] : INT32_MAX; /* no centre's score is so large */
        }
        for (uint32_t d = 0; d < T3R_DIMENSIONS / 2; d++) {
            store(neighbours, offsetof(packed_centres, pair) + d * sizeof(int32_t) * T3R_MAX_CLUSTERS, at,
                  _mm256_loadu_si256((const __m256i *)(const void *)pair[d]));
        }
        store(neighbours, offsetof(packed_centres, half_norm), at,
              _mm256_loadu_si256((const __m256i *)(const void *)half_norm));
    }
}

/* A point, and in each lane the least score so far and the first centre of the eight that had it. */
typedef struct search {
    __m256i pair[T3R_DIMENSIONS / 2];
    __m256i least, first;
} search;

static T3R_AVX2 search search_of(const int16_t p[T3R_DIMENSIONS])
{
    search s = {.least = _mm256_set1_epi32(INT32_MAX), .first = _mm256_setzero_si256()};
    for (int d = 0; d < T3R_DIMENSIONS / 2; d++) {
        s.pair[d] = _mm256_set1_epi32((int32_t)((uint16_t)p[2 * d] | (uint32_t)(uint16_t)p[2 * d + 1] << 16));
    }
    return s;
}

/* Scores are below 2^31 in size, as are their parts: |p c| is at most 6 x 15000^2. A lane keeps the earlier of equals.
 */
static inline T3R_AVX2 void look(search *s, const __m256i pair[T3R_DIMENSIONS / 2], __m256i half_norm, __m256i here)
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
            __m256i pair[T3R_DIMENSIONS / 2];
            for (uint32_t d = 0; d < T3R_DIMENSIONS / 2; d++) {
                pair[d] = load(neighbours, offsetof(packed_centres, pair) + d * sizeof(int32_t) * T3R_MAX_CLUSTERS, k);
            }
            const __m256i half_norm = load(neighbours, offsetof(packed_centres, half_norm), k);
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
