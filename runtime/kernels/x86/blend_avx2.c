/* Blending, two rows of eight columns at a time. */
#include "variants.h"

#ifdef T3R_X86

#include "intrinsics.h"

#include "core/memory.h"
#include "kernels/alpha.h"

/* (a b + 2^15) / 2^16 of 16 unsigned bits: the high half and the top bit of the low one. */
static inline T3R_AVX2 __m256i mulr_q16(__m256i a, __m256i b)
{
    return _mm256_add_epi16(_mm256_mulhi_epu16(a, b), _mm256_srli_epi16(_mm256_mullo_epi16(a, b), 15));
}

static inline T3R_AVX2 __m256i constant(uint32_t x)
{
    return _mm256_set1_epi16((int16_t)x);
}

/* All bits where a >= b, of 16 unsigned bits. */
static inline T3R_AVX2 __m256i at_least(__m256i a, __m256i b)
{
    return _mm256_cmpeq_epi16(_mm256_max_epu16(a, b), a);
}

/* T3R_ALPHA_RANGE less q / 8, of a row. */
static inline T3R_AVX2 __m256i range_left(__m256i q_q17)
{
    __m256i t = _mm256_srai_epi32(_mm256_add_epi32(q_q17, _mm256_set1_epi32(8)), 4);
    t = _mm256_max_epi32(t, _mm256_setzero_si256());
    t = _mm256_min_epi32(t, _mm256_set1_epi32(T3R_ALPHA_RANGE));
    return _mm256_sub_epi32(_mm256_set1_epi32(T3R_ALPHA_RANGE), t);
}

static inline T3R_AVX2 __m256i alpha_of(__m256i upper_q17, __m256i lower_q17, __m256i opacity_q16)
{
    __m256i s = _mm256_packus_epi32(range_left(upper_q17), range_left(lower_q17));
    s = _mm256_permute4x64_epi64(s, 0xd8); /* packing goes by halves of vectors */
    __m256i p = _mm256_add_epi16(constant(T3R_ALPHA_C3), _mm256_mulhi_epu16(s, constant(T3R_ALPHA_C4)));
    p = _mm256_add_epi16(constant(T3R_ALPHA_C2), _mm256_mulhi_epu16(s, p));
    p = _mm256_add_epi16(constant(T3R_ALPHA_C1), _mm256_mulhi_epu16(s, p));
    p = _mm256_add_epi16(constant(T3R_ALPHA_C0), _mm256_mulhi_epu16(s, p));
    p = _mm256_mulhi_epu16(p, p);
    p = _mm256_mulhi_epu16(p, p);
    p = _mm256_mulhi_epu16(p, p);
    __m256i alpha = _mm256_min_epu16(_mm256_mulhi_epu16(p, opacity_q16), constant(T3R_ALPHA_MOST_Q16));
    return _mm256_and_si256(alpha, at_least(alpha, constant(T3R_ALPHA_LEAST_Q16)));
}

/* Eight columns of two rows, or of one, whose neighbour is then not touched. */
static inline T3R_AVX2 __m256i load_rows(const uint16_t *upper, bool two)
{
    __m128i first = _mm_loadu_si128((const __m128i *)(const void *)upper);
    __m128i second = two ? _mm_loadu_si128((const __m128i *)(const void *)(upper + T3R_TILE_SIDE)) : first;
    return _mm256_inserti128_si256(_mm256_castsi128_si256(first), second, 1);
}

static inline T3R_AVX2 void store_rows(uint16_t *upper, size_t pitch, bool two, __m256i x)
{
    _mm_storeu_si128((__m128i *)(void *)upper, _mm256_castsi256_si128(x));
    if (two) {
        _mm_storeu_si128((__m128i *)(void *)(upper + pitch), _mm256_extracti128_si256(x, 1));
    }
}

static inline T3R_AVX2 void add_colour(uint16_t *upper, bool two, __m256i w, __m256i colour_q7)
{
    __m256i sum = _mm256_add_epi16(load_rows(upper, two), mulr_q16(w, colour_q7));
    store_rows(upper, T3R_TILE_SIDE, two, sum);
}

/* rows: where what is blended is kept, or NULL; known where this is inlined. Returns all bits of the weights kept. */
static inline __attribute__((always_inline)) T3R_AVX2 uint16_t blend_group(t3r_tile *restrict tile,
                                                                           const t3r_tile_splat *splat, uint32_t group,
                                                                           t3r_blended_row *restrict rows)
{
    const uint32_t column = splat->column + group * T3R_LANES;
    const int32_t gx = splat->group[group].gx, gy = splat->group[group].gy, row = splat->first;
    const __m256i i = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7), ii = _mm256_mullo_epi32(i, i);
    const __m256i bend = _mm256_set1_epi32(2 * splat->c), ib = _mm256_mullo_epi32(i, _mm256_set1_epi32(splat->b));
    /* sums modulo 2^32, as plain C's are without overflow */
    __m256i upper = _mm256_set1_epi32(splat->group[group].q + row * (gy + row * splat->c));
    upper = _mm256_add_epi32(upper, _mm256_mullo_epi32(i, _mm256_set1_epi32(gx + row * splat->b)));
    upper = _mm256_add_epi32(upper, _mm256_mullo_epi32(ii, _mm256_set1_epi32(splat->a)));
    __m256i step = _mm256_add_epi32(_mm256_set1_epi32(gy + (2 * row + 1) * splat->c), ib);
    const __m256i opacity = constant(splat->opacity_q16);
    const __m256i red = constant(splat->colour_q7[0]), green = constant(splat->colour_q7[1]);
    const __m256i blue = constant(splat->colour_q7[2]);
    __m256i any = _mm256_setzero_si256();
    for (uint32_t j = splat->first; j <= splat->last; j += 2) {
        const bool two = j < splat->last;
        const __m256i lower = _mm256_add_epi32(upper, step);
        uint16_t *transmittance = tile->transmittance_q16[j] + column;
        __m256i t = load_rows(transmittance, two);
        __m256i alpha = alpha_of(upper, lower, opacity);
        alpha = _mm256_and_si256(alpha, at_least(t, constant(T3R_STOP_Q16)));
        const __m256i w = mulr_q16(t, alpha);
        store_rows(transmittance, T3R_TILE_SIDE, two, _mm256_sub_epi16(t, w));
        add_colour(tile->colour_q7[0][j] + column, two, w, red);
        add_colour(tile->colour_q7[1][j] + column, two, w, green);
        add_colour(tile->colour_q7[2][j] + column, two, w, blue);
        if (rows != NULL) {
            t3r_blended_row *kept = rows + (j - splat->first);
            const __m256i still = _mm256_cmpeq_epi16(w, _mm256_setzero_si256());
            store_rows(kept->weight_q16, sizeof *kept / 2, two, w);
            store_rows((uint16_t *)(void *)kept->alpha_q15, sizeof *kept / 2, two,
                       _mm256_andnot_si256(still, _mm256_srli_epi16(alpha, 1)));
            any = _mm256_or_si256(any, two ? w : _mm256_zextsi128_si256(_mm256_castsi256_si128(w)));
        }
        step = _mm256_add_epi32(step, bend);
        upper = _mm256_add_epi32(lower, step);
        step = _mm256_add_epi32(step, bend);
    }
    __m128i bits = _mm_or_si128(_mm256_castsi256_si128(any), _mm256_extracti128_si256(any, 1));
    bits = _mm_or_si128(bits, _mm_srli_si128(bits, 8));
    bits = _mm_or_si128(bits, _mm_srli_si128(bits, 4));
    return (uint16_t)((uint32_t)_mm_cvtsi128_si32(bits) | (uint32_t)_mm_cvtsi128_si32(bits) >> 16);
}

T3R_AVX2 void t3r_blend_avx2(t3r_tile *tile, const t3r_tile_splat *splat)
{
    for (uint32_t group = 0; group < splat->groups; group++) {
        if ((splat->drawn >> group & 1) != 0) {
            (void)blend_group(tile, splat, group, NULL);
        }
    }
}

T3R_AVX2 uint16_t t3r_blend_keep_avx2(t3r_tile *restrict tile, const t3r_tile_splat *splat,
                                      t3r_blended_row *restrict rows)
{
    const uint32_t rows_a_group = splat->last - splat->first + 1u;
    uint16_t bits = 0;
    for (uint32_t group = 0; group < splat->groups; group++, rows += rows_a_group) {
        if ((splat->drawn >> group & 1) != 0) {
            bits |= blend_group(tile, splat, group, rows);
        } else {
            memset(rows, 0, rows_a_group * sizeof *rows);
        }
    }
    return bits;
}

#else
typedef int t3r_no_blend_avx2; /* a file may not be empty */
#endif
