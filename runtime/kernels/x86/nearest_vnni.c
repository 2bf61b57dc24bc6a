/* The nearest centre by looking at all of them, sixteen at a time: the largest p c - half norm. */
#include "variants.h"

#ifdef T3R_X86

#include "intrinsics.h"
#include "packed_centres.h"

#define LANES 16u
#define POINTS 4u /* that share a centre's loads */

_Static_assert(T3R_CENTRE_GROUP == LANES, "the packed centres come in whole vectors");

/* A point, and in each lane the largest so far and the first centre of the sixteen that had it. */
typedef struct search {
    __m512i pair[T3R_PAIRS];
    __m512i most, first;
} search;

static inline T3R_VNNI __m512i load(const t3r_neighbours *packed, size_t offset, uint32_t k)
{
    return _mm512_loadu_si512((const void *)t3r_packed_at(packed, offset, k));
}

static inline T3R_VNNI search search_of(const int16_t p[T3R_DIMENSIONS])
{
    search s = {.most = _mm512_set1_epi32(INT32_MIN), .first = _mm512_setzero_si512()};
    for (uint32_t d = 0; d < T3R_PAIRS; d++) {
        s.pair[d] = _mm512_set1_epi32(t3r_pair_of(p, d));
    }
    return s;
}

/* Nothing leaves 32 bits: nearest.h. A lane keeps the earlier of equals. */
static inline T3R_VNNI void look(search *s, const __m512i pair[T3R_PAIRS], __m512i less_half_norm, __m512i here)
{
    __m512i score = _mm512_dpwssd_epi32(less_half_norm, s->pair[0], pair[0]);
    score = _mm512_dpwssd_epi32(score, s->pair[1], pair[1]);
    score = _mm512_dpwssd_epi32(score, s->pair[2], pair[2]);
    s->first = _mm512_mask_mov_epi32(s->first, _mm512_cmpgt_epi32_mask(score, s->most), here);
    s->most = _mm512_max_epi32(s->most, score);
}

/* The least index of the largest. */
static inline T3R_VNNI uint16_t nearest_of(const search *s)
{
    const __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const __m512i most = _mm512_set1_epi32(_mm512_reduce_max_epi32(s->most));
    const __mmask16 equal = _mm512_cmpeq_epi32_mask(s->most, most);
    return (uint16_t)_mm512_mask_reduce_min_epu32(equal, _mm512_add_epi32(s->first, lane));
}

T3R_VNNI void t3r_nearest_vnni(const t3r_centres *centres, const t3r_neighbours *neighbours, uint32_t points,
                               const int16_t (*feature_q11)[T3R_DIMENSIONS], uint16_t guess, uint16_t *nearest)
{
    (void)guess;
    for (uint32_t first = 0; first < points; first += POINTS) {
        uint32_t point[POINTS];
        search s[POINTS];
        for (uint32_t i = 0; i < POINTS; i++) { /* behind the last, it again */
            point[i] = first + i < points ? first + i : points - 1;
            s[i] = search_of(feature_q11[point[i]]);
        }
        for (uint32_t k = 0; k < centres->count; k += LANES) {
            const __m512i pair[T3R_PAIRS] = {load(neighbours, T3R_PACKED_PAIR(0), k),
                                             load(neighbours, T3R_PACKED_PAIR(1), k),
                                             load(neighbours, T3R_PACKED_PAIR(2), k)};
            const __m512i less_half_norm =
                _mm512_sub_epi32(_mm512_setzero_si512(), load(neighbours, T3R_PACKED_HALF_NORM, k));
            const __m512i here = _mm512_set1_epi32((int32_t)k);
            look(&s[0], pair, less_half_norm, here);
            look(&s[1], pair, less_half_norm, here);
            look(&s[2], pair, less_half_norm, here);
            look(&s[3], pair, less_half_norm, here);
        }
        for (uint32_t i = 0; i < POINTS; i++) {
            nearest[point[i]] = nearest_of(&s[i]);
        }
    }
}

#else
typedef int t3r_no_nearest_vnni; /* a file may not be empty */
#endif
