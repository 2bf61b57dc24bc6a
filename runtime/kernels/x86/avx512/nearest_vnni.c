/* SPDX-License-Identifier: Apache-2.0 */
/* The nearest centre by comparing all of them, sixteen at a time: the largest p c - half norm. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "kernels/lanes/packed_centres.h"
#include "kernels/x86/intrinsics.h"

#define LANES 16u
#define POINTS 4u /* points that share a centre's loads */

_Static_assert(T3R_CENTRE_GROUP == LANES, "the packed centres come in whole vectors");

/* Not __m512i: if the largest so far changes its type, gcc 12 copies it in every iteration. */
typedef __v16si sixteen;

/* A point; in each lane the largest score so far, and the first centre of the sixteen among which the lane had it. */
typedef struct search {
    __m512i pair[T3R_PAIRS];
    sixteen most, first;
} search;

static inline T3R_VNNI __m512i load(const int32_t x[LANES])
{
    return _mm512_loadu_si512((const void *)x);
}

static inline T3R_VNNI search search_of(const int16_t p[T3R_DIMENSIONS])
{
    search s = {.most = (sixteen)_mm512_set1_epi32(INT32_MIN), .first = (sixteen)_mm512_setzero_si512()};
    for (uint32_t d = 0; d < T3R_PAIRS; d++) {
        s.pair[d] = _mm512_set1_epi32(t3r_pair_of(p, d));
    }
    return s;
}

/* Everything fits 32 bits (nearest.h). A lane keeps the earlier of equals. */
static inline T3R_VNNI void look(search *s, const __m512i pair[T3R_PAIRS], __m512i less_half_norm, sixteen here)
{
    __m512i score = _mm512_dpwssd_epi32(less_half_norm, s->pair[0], pair[0]);
    score = _mm512_dpwssd_epi32(score, s->pair[1], pair[1]);
    score = _mm512_dpwssd_epi32(score, s->pair[2], pair[2]);
    const __mmask16 more = _mm512_cmpgt_epi32_mask(score, (__m512i)s->most);
    s->first = (sixteen)_mm512_mask_mov_epi32((__m512i)s->first, more, (__m512i)here);
    s->most = (sixteen)_mm512_max_epi32(score, (__m512i)s->most);
}

/* Reduces four vectors to their largest (least) numbers, in order in each quarter. */
#define REDUCED(of, x)                                                                                                 \
    __m512i ab = of(_mm512_unpacklo_epi32((x)[0], (x)[1]), _mm512_unpackhi_epi32((x)[0], (x)[1]));                     \
    const __m512i cd = of(_mm512_unpacklo_epi32((x)[2], (x)[3]), _mm512_unpackhi_epi32((x)[2], (x)[3]));               \
    ab = of(_mm512_unpacklo_epi64(ab, cd), _mm512_unpackhi_epi64(ab, cd));                                             \
    ab = of(ab, _mm512_shuffle_i32x4(ab, ab, 0x4e));                                                                   \
    return of(ab, _mm512_shuffle_i32x4(ab, ab, 0xb1));

static T3R_VNNI __m512i largest_of(const __m512i x[POINTS])
{
    REDUCED(_mm512_max_epi32, x)
}

static T3R_VNNI __m512i least_of(const __m512i x[POINTS])
{
    REDUCED(_mm512_min_epi32, x)
}

/* Returns the lane numbers where a search has its largest score, elsewhere a larger number than any. */
static inline T3R_VNNI __m512i index_of(const search *s, __m512i most)
{
    const __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const __mmask16 equal = _mm512_cmpeq_epi32_mask((__m512i)s->most, most);
    return _mm512_mask_add_epi32(_mm512_set1_epi32(INT32_MAX), equal, (__m512i)s->first, lane);
}

/* Finds the least indices of the largest scores. */
static inline T3R_VNNI void nearest_of(const search s[POINTS], uint32_t nearest[POINTS])
{
    const __m512i all[POINTS] = {(__m512i)s[0].most, (__m512i)s[1].most, (__m512i)s[2].most, (__m512i)s[3].most};
    const __m512i most = largest_of(all);
    const __m512i index[POINTS] = {
        index_of(&s[0], _mm512_shuffle_epi32(most, 0x00)), index_of(&s[1], _mm512_shuffle_epi32(most, 0x55)),
        index_of(&s[2], _mm512_shuffle_epi32(most, 0xaa)), index_of(&s[3], _mm512_shuffle_epi32(most, 0xff))};
    _mm_storeu_si128((__m128i_u *)(void *)nearest, _mm512_castsi512_si128(least_of(index)));
}

T3R_VNNI void t3r_nearest_vnni(const t3r_centres *centres, const t3r_neighbours *neighbours, uint32_t points,
                               const int16_t (*feature_q11)[T3R_DIMENSIONS], uint16_t guess, uint16_t *nearest)
{
    (void)guess;
    for (uint32_t first = 0; first < points; first += POINTS) {
        uint32_t point[POINTS];
        search s[POINTS];
        for (uint32_t i = 0; i < POINTS; i++) { /* pads by repeating the last */
            point[i] = first + i < points ? first + i : points - 1;
            s[i] = search_of(feature_q11[point[i]]);
        }
        sixteen here = (sixteen)_mm512_setzero_si512();
        for (uint32_t k = 0; k < centres->count; k += LANES, here += (int32_t)LANES) {
            const t3r_packed_group *packed = t3r_packed_group_of(neighbours, k);
            const __m512i pair[T3R_PAIRS] = {load(packed->pair[0]), load(packed->pair[1]), load(packed->pair[2])};
            const __m512i less_half_norm = _mm512_sub_epi32(_mm512_setzero_si512(), load(packed->half_norm));
            look(&s[0], pair, less_half_norm, here);
            look(&s[1], pair, less_half_norm, here);
            look(&s[2], pair, less_half_norm, here);
            look(&s[3], pair, less_half_norm, here);
        }
        uint32_t label[POINTS];
        nearest_of(s, label);
        for (uint32_t i = 0; i < POINTS; i++) {
            nearest[point[i]] = (uint16_t)label[i];
        }
    }
}

#else
typedef int t3r_no_nearest_vnni; /* a file may not be empty */
#endif
