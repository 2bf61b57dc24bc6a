/* SPDX-License-Identifier: Apache-2.0 */
/* Stereo matching, thirty-two disparities at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "kernels/x86/intrinsics.h"

#define TARGET T3R_AVX2
#define BYTES 32
#define MOST_VECTORS 4
#define OF(instruction) _mm256_##instruction
#include "kernels/lanes/path_lanes.h"

#include "kernels/lanes/census_lanes.h"
#include "kernels/lanes/winner_lanes.h"

static inline TARGET bytes load(const uint8_t *from, uint32_t count)
{
    return (bytes)(count >= BYTES ? _mm256_loadu_si256((const __m256i *)from)
                                  : _mm256_zextsi128_si256(_mm_loadu_si128((const __m128i *)from)));
}

static inline TARGET void store(uint8_t *to, bytes x, uint32_t count)
{
    if (count >= BYTES) {
        _mm256_storeu_si256((__m256i *)to, (__m256i)x);
    } else {
        _mm_storeu_si128((__m128i *)to, _mm256_castsi256_si128((__m256i)x));
    }
}

static inline TARGET bytes held(bytes x, bytes other, uint32_t count)
{
    return count >= BYTES ? x : (bytes)_mm256_blend_epi32((__m256i)x, (__m256i)other, 0xf0);
}

static inline TARGET bytes below(bytes x, bytes next)
{
    const __m256i crossing = _mm256_permute2x128_si256((__m256i)next, (__m256i)x, 0x21);
    return (bytes)_mm256_alignr_epi8((__m256i)x, crossing, 15);
}

static inline TARGET bytes above(bytes x, bytes next)
{
    const __m256i crossing = _mm256_permute2x128_si256((__m256i)x, (__m256i)next, 0x21);
    return (bytes)_mm256_alignr_epi8(crossing, (__m256i)x, 1);
}

static inline TARGET bytes least_of(bytes x)
{
    const __m128i half = _mm_min_epu8(_mm256_castsi256_si128((__m256i)x), _mm256_extracti128_si256((__m256i)x, 1));
    const __m128i pairs = _mm_min_epu8(half, _mm_srli_epi16(half, 8)); /* the upper bytes are 0 */
    return (bytes)_mm256_broadcastb_epi8(_mm_minpos_epu16(pairs));
}

static inline TARGET uint8_t first_of(bytes x)
{
    return (uint8_t)_mm_cvtsi128_si32(_mm256_castsi256_si128((__m256i)x));
}

/* Sums sixteen of them. */
static inline TARGET void sum_half(int16_t *sums, const bytes values[T3R_PATH_LINKS], uint32_t paths, bool upper,
                                   bool add)
{
    __m256i all = add ? _mm256_loadu_si256((const __m256i *)sums) : _mm256_setzero_si256();
    for (uint32_t path = 0; path < paths; path++) {
        const __m256i x = (__m256i)values[path];
        const __m128i half = upper ? _mm256_extracti128_si256(x, 1) : _mm256_castsi256_si128(x);
        all = _mm256_add_epi16(all, _mm256_cvtepu8_epi16(half));
    }
    _mm256_storeu_si256((__m256i *)sums, all);
}

static inline TARGET void sum(int16_t *sums, const bytes values[T3R_PATH_LINKS], uint32_t paths, uint32_t count,
                              bool add)
{
    sum_half(sums, values, paths, false, add);
    if (count >= BYTES) {
        sum_half(sums + 16, values, paths, true, add);
    }
}

static inline TARGET bytes look_up(const uint8_t table[16], bytes x)
{
    const __m256i both = _mm256_broadcastsi128_si256(_mm_loadu_si128((const __m128i *)table));
    return (bytes)_mm256_shuffle_epi8(both, (__m256i)x);
}

static inline TARGET words load_words(const int16_t *from, uint32_t count)
{
    (void)count; /* a multiple of 16 */
    return (words)_mm256_loadu_si256((const __m256i *)from);
}

static inline TARGET void store_words(int16_t *to, words x, uint32_t count)
{
    (void)count;
    _mm256_storeu_si256((__m256i *)to, (__m256i)x);
}

static inline TARGET words word_below(words x, words next)
{
    const __m256i crossing = _mm256_permute2x128_si256((__m256i)next, (__m256i)x, 0x21);
    return (words)_mm256_alignr_epi8((__m256i)x, crossing, 14);
}

static inline TARGET int16_t least_word(words x)
{
    const __m128i half = _mm_min_epi16(_mm256_castsi256_si128((__m256i)x), _mm256_extracti128_si256((__m256i)x, 1));
    return (int16_t)_mm_cvtsi128_si32(_mm_minpos_epu16(half)); /* no sum is negative */
}

static inline TARGET uint32_t first_equal(words x, int16_t value)
{
    const __m256i same = _mm256_cmpeq_epi16((__m256i)x, _mm256_set1_epi16(value));
    const uint32_t mask = (uint32_t)_mm256_movemask_epi8(same);
    return mask == 0 ? WORDS : (uint32_t)__builtin_ctz(mask) / 2;
}

/* A separate function for each number of disparities keeps everything in registers. */
#define FOLLOW(count)                                                                                                  \
    static TARGET void down_##count(const t3r_path_row *row)                                                           \
    {                                                                                                                  \
        follow(row, count, 1, false);                                                                                  \
    }                                                                                                                  \
    static TARGET void straight_##count(const t3r_path_row *row)                                                       \
    {                                                                                                                  \
        follow(row, count, 1, true);                                                                                   \
    }                                                                                                                  \
    static TARGET void diagonal_##count(const t3r_path_row *row)                                                       \
    {                                                                                                                  \
        follow(row, count, 3, row->sums != NULL);                                                                      \
    }                                                                                                                  \
    static TARGET void costs_##count(const t3r_census_costs *row)                                                      \
    {                                                                                                                  \
        costs(row, count);                                                                                             \
    }                                                                                                                  \
    static TARGET void winners_##count(const t3r_winner_row *row)                                                      \
    {                                                                                                                  \
        winners(row, count);                                                                                           \
    }
#define FOLLOWED(count)                                                                                                \
    case count:                                                                                                        \
        if (row->diagonals) {                                                                                          \
            diagonal_##count(row);                                                                                     \
        } else if (row->sums != NULL) {                                                                                \
            straight_##count(row);                                                                                     \
        } else {                                                                                                       \
            down_##count(row);                                                                                         \
        }                                                                                                              \
        break;
#define COSTED(count)                                                                                                  \
    case count:                                                                                                        \
        costs_##count(row);                                                                                            \
        break;
#define WON(count)                                                                                                     \
    case count:                                                                                                        \
        winners_##count(row);                                                                                          \
        break;

#define COUNTS(X) X(16) X(32) X(48) X(64) X(80) X(96) X(112) X(128)
COUNTS(FOLLOW)

TARGET void t3r_path_row_avx2(const t3r_path_row *row)
{
    switch (row->disparities) {
        COUNTS(FOLLOWED)
    default:
        t3r_path_row_c(row); /* only the coarse pass has other numbers */
    }
}

TARGET void t3r_census_costs_avx2(const t3r_census_costs *row)
{
    mirror(row);
    switch (row->disparities) {
        COUNTS(COSTED)
    default:
        costs(row, row->disparities);
    }
}

TARGET void t3r_winner_row_avx2(const t3r_winner_row *row)
{
    switch (row->disparities) {
        COUNTS(WON)
    default:
        winners(row, row->disparities);
    }
}

#else
typedef int t3r_no_path_row_avx2; /* a file may not be empty */
#endif
