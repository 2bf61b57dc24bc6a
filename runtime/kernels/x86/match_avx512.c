/* Stereo matching, sixty-four disparities at a time. */
#include "variants.h"

#ifdef T3R_X86

#include "intrinsics.h"

#define TARGET T3R_AVX512
#define BYTES 64
#include "path_lanes.h"

#include "census_lanes.h"
#include "winner_lanes.h"

/* Lanes below `count`. */
static inline TARGET __mmask64 lanes(uint32_t count)
{
    return count >= BYTES ? ~UINT64_C(0) : (UINT64_C(1) << count) - 1;
}

static inline TARGET bytes load(const uint8_t *from, uint32_t count)
{
    return (bytes)_mm512_maskz_loadu_epi8(lanes(count), from);
}

static inline TARGET void store(uint8_t *to, bytes x, uint32_t count)
{
    _mm512_mask_storeu_epi8(to, lanes(count), (__m512i)x);
}

static inline TARGET bytes held(bytes x, bytes other, uint32_t count)
{
    return (bytes)_mm512_mask_blend_epi8(lanes(count), (__m512i)other, (__m512i)x);
}

static inline TARGET bytes minimum(bytes a, bytes b)
{
    return (bytes)_mm512_min_epu8((__m512i)a, (__m512i)b);
}

static inline TARGET bytes all_of(uint8_t x)
{
    return (bytes)_mm512_set1_epi8((char)x);
}

static inline TARGET bytes below(bytes x, bytes next)
{
    const __m512i crossing = _mm512_alignr_epi64((__m512i)x, (__m512i)next, 6);
    return (bytes)_mm512_alignr_epi8((__m512i)x, crossing, 15);
}

static inline TARGET bytes above(bytes x, bytes next)
{
    const __m512i crossing = _mm512_alignr_epi64((__m512i)next, (__m512i)x, 2);
    return (bytes)_mm512_alignr_epi8(crossing, (__m512i)x, 1);
}

static inline TARGET bytes least_of(bytes x)
{
    const __m256i half = _mm256_min_epu8(_mm512_castsi512_si256((__m512i)x), _mm512_extracti64x4_epi64((__m512i)x, 1));
    const __m128i quarter = _mm_min_epu8(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
    const __m128i pairs = _mm_min_epu8(quarter, _mm_srli_epi16(quarter, 8)); /* the upper bytes are 0 */
    return (bytes)_mm512_broadcastb_epi8(_mm_minpos_epu16(pairs));
}

static inline TARGET uint8_t first_of(bytes x)
{
    return (uint8_t)_mm_cvtsi128_si32(_mm512_castsi512_si128((__m512i)x));
}

/* Thirty-two of them. */
static inline TARGET void sum_half(int16_t *sums, const bytes values[T3R_PATH_LINKS], uint32_t paths, bool upper,
                                   uint32_t count, bool add)
{
    const __mmask32 mask = (__mmask32)lanes(count);
    __m512i all = add ? _mm512_maskz_loadu_epi16(mask, sums) : _mm512_setzero_si512();
    for (uint32_t path = 0; path < paths; path++) {
        const __m512i x = (__m512i)values[path];
        const __m256i half = upper ? _mm512_extracti64x4_epi64(x, 1) : _mm512_castsi512_si256(x);
        all = _mm512_add_epi16(all, _mm512_cvtepu8_epi16(half));
    }
    _mm512_mask_storeu_epi16(sums, mask, all);
}

static inline TARGET void sum(int16_t *sums, const bytes values[T3R_PATH_LINKS], uint32_t paths, uint32_t count,
                              bool add)
{
    sum_half(sums, values, paths, false, count, add);
    if (count > BYTES / 2) {
        sum_half(sums + BYTES / 2, values, paths, true, count - BYTES / 2, add);
    }
}

/* ---- census ---- */

static inline TARGET bytes larger(bytes a, bytes b)
{
    return (bytes)_mm512_max_epu8((__m512i)a, (__m512i)b);
}

static inline TARGET bytes look_up(const uint8_t table[16], bytes x)
{
    const __m512i all = _mm512_broadcast_i32x4(_mm_loadu_si128((const __m128i *)table));
    return (bytes)_mm512_shuffle_epi8(all, (__m512i)x);
}

static inline TARGET bytes fourth(bytes x)
{
    return (bytes)_mm512_srli_epi16((__m512i)x, 4);
}

/* ---- winners ---- */

static inline TARGET words load_words(const int16_t *from, uint32_t count)
{
    return (words)_mm512_mask_loadu_epi16(_mm512_set1_epi16(INT16_MAX), (__mmask32)lanes(count), from);
}

static inline TARGET void store_words(int16_t *to, words x, uint32_t count)
{
    _mm512_mask_storeu_epi16(to, (__mmask32)lanes(count), (__m512i)x);
}

static inline TARGET words lesser(words a, words b)
{
    return (words)_mm512_min_epi16((__m512i)a, (__m512i)b);
}

static inline TARGET words where_less(words x, words y, words a, words b)
{
    const __mmask32 less = _mm512_cmplt_epi16_mask((__m512i)x, (__m512i)y);
    return (words)_mm512_mask_blend_epi16(less, (__m512i)b, (__m512i)a);
}

static inline TARGET words word_below(words x, words next)
{
    const __m512i crossing = _mm512_alignr_epi64((__m512i)x, (__m512i)next, 6);
    return (words)_mm512_alignr_epi8((__m512i)x, crossing, 14);
}

static inline TARGET int16_t least_word(words x)
{
    const __m256i half = _mm256_min_epi16(_mm512_castsi512_si256((__m512i)x), _mm512_extracti64x4_epi64((__m512i)x, 1));
    const __m128i quarter = _mm_min_epi16(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
    return (int16_t)_mm_cvtsi128_si32(_mm_minpos_epu16(quarter)); /* no sum is negative */
}

static inline TARGET uint32_t first_equal(words x, int16_t value)
{
    const uint32_t mask = _mm512_cmpeq_epi16_mask((__m512i)x, _mm512_set1_epi16(value));
    return mask == 0 ? WORDS : (uint32_t)__builtin_ctz(mask);
}

TARGET void t3r_path_row_avx512(const t3r_path_row *row)
{
    switch ((row->disparities + BYTES - 1) / BYTES) {
    case 1:
        one(row);
        break;
    case 2:
        two(row);
        break;
    case 3:
        three(row);
        break;
    default:
        four(row);
    }
}

TARGET void t3r_census_costs_avx512(const t3r_census_costs *row)
{
    mirror(row);
    costs(row);
}

TARGET void t3r_winner_row_avx512(const t3r_winner_row *row)
{
    winners(row);
}

#else
typedef int t3r_no_path_row_avx512; /* a file may not be empty */
#endif
