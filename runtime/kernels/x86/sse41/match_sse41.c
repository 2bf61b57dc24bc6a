/* SPDX-License-Identifier: Apache-2.0 */
/* Stereo matching, sixteen disparities at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "kernels/x86/intrinsics.h"

#define TARGET T3R_SSE41
#define BYTES 16
#define MOST_VECTORS (T3R_PATH_MOST / BYTES)
#define OF(instruction) _mm_##instruction
#include "kernels/lanes/path_lanes.h"

#include "kernels/lanes/census_lanes.h"
#include "kernels/lanes/winner_lanes.h"

/* Every count is a multiple of 16. */
static inline TARGET bytes load(const uint8_t *from, uint32_t count)
{
    (void)count;
    return (bytes)_mm_loadu_si128((const __m128i *)from);
}

static inline TARGET void store(uint8_t *to, bytes x, uint32_t count)
{
    (void)count;
    _mm_storeu_si128((__m128i *)to, (__m128i)x);
}

static inline TARGET bytes held(bytes x, bytes other, uint32_t count)
{
    (void)other;
    (void)count;
    return x;
}

static inline TARGET bytes below(bytes x, bytes next)
{
    return (bytes)_mm_alignr_epi8((__m128i)x, (__m128i)next, 15);
}

static inline TARGET bytes above(bytes x, bytes next)
{
    return (bytes)_mm_alignr_epi8((__m128i)next, (__m128i)x, 1);
}

static inline TARGET bytes least_of(bytes x)
{
    const __m128i pairs = _mm_min_epu8((__m128i)x, _mm_srli_epi16((__m128i)x, 8)); /* the upper bytes are 0 */
    return (bytes)_mm_shuffle_epi8(_mm_minpos_epu16(pairs), _mm_setzero_si128());
}

static inline TARGET uint8_t first_of(bytes x)
{
    return (uint8_t)_mm_cvtsi128_si32((__m128i)x);
}

static inline TARGET void sum(int16_t *sums, const bytes values[T3R_PATH_LINKS], uint32_t paths, uint32_t count,
                              bool add)
{
    (void)count;
    const __m128i none = _mm_setzero_si128();
    __m128i low = none, high = none;
    for (uint32_t path = 0; path < paths; path++) {
        low = _mm_add_epi16(low, _mm_unpacklo_epi8((__m128i)values[path], none));
        high = _mm_add_epi16(high, _mm_unpackhi_epi8((__m128i)values[path], none));
    }
    __m128i *to = (__m128i *)sums;
    _mm_storeu_si128(to, add ? _mm_add_epi16(low, _mm_loadu_si128(to)) : low);
    _mm_storeu_si128(to + 1, add ? _mm_add_epi16(high, _mm_loadu_si128(to + 1)) : high);
}

static inline TARGET bytes look_up(const uint8_t table[16], bytes x)
{
    return (bytes)_mm_shuffle_epi8(_mm_loadu_si128((const __m128i *)table), (__m128i)x);
}

static inline TARGET words load_words(const int16_t *from, uint32_t count)
{
    (void)count;
    return (words)_mm_loadu_si128((const __m128i *)from);
}

static inline TARGET void store_words(int16_t *to, words x, uint32_t count)
{
    (void)count;
    _mm_storeu_si128((__m128i *)to, (__m128i)x);
}

static inline TARGET words word_below(words x, words next)
{
    return (words)_mm_alignr_epi8((__m128i)x, (__m128i)next, 14);
}

static inline TARGET int16_t least_word(words x)
{
    return (int16_t)_mm_cvtsi128_si32(_mm_minpos_epu16((__m128i)x)); /* no sum is negative */
}

static inline TARGET uint32_t first_equal(words x, int16_t value)
{
    const uint32_t mask = (uint32_t)_mm_movemask_epi8(_mm_cmpeq_epi16((__m128i)x, _mm_set1_epi16(value)));
    return mask == 0 ? WORDS : (uint32_t)__builtin_ctz(mask) / 2;
}

TARGET void t3r_path_row_sse41(const t3r_path_row *row)
{
    if (row->diagonals) {
        follow(row, row->disparities, 3, row->sums != NULL);
    } else {
        follow(row, row->disparities, 1, row->sums != NULL);
    }
}

TARGET void t3r_census_costs_sse41(const t3r_census_costs *row)
{
    mirror(row);
    costs(row, row->disparities);
}

TARGET void t3r_winner_row_sse41(const t3r_winner_row *row)
{
    winners(row, row->disparities);
}

#else
typedef int t3r_no_match_sse41; /* a file may not be empty */
#endif
