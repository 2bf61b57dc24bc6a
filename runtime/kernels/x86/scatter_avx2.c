/* Scattering, two rows of eight columns at a time. Sums are modulo 2^32, so that lanes do not show. */
#include "variants.h"

#ifdef T3R_X86

#include <stdbool.h>

#include "intrinsics.h"

#include "core/fixed.h"
#include "kernels/scatter_bits.h"

#define STEPS_MOST (T3R_BLENDED_ROWS_MOST / 2) /* pairs of rows, of all groups */

/* Squares and products of 16 pixels: the first four columns of both rows, then the last four, as packing takes them. */
typedef struct step_terms {
    __m256i square[2], product[2];
} step_terms;

/* What is summed, in the order of t3r_refine_sums. */
enum { COLOUR, WEIGHT = 3, GRADIENT, CURVATURE = GRADIENT + T3R_REFINE_MOMENTS_2 };
#define SUMS (CURVATURE + T3R_REFINE_MOMENTS_4)

static inline T3R_AVX2 __m256i load_rows(const void *upper, size_t pitch_bytes, bool two)
{
    const uint8_t *at = upper;
    const __m128i first = _mm_loadu_si128((const __m128i *)(const void *)at);
    const __m128i second =
        two ? _mm_loadu_si128((const __m128i *)(const void *)(at + pitch_bytes)) : _mm_setzero_si128();
    return _mm256_inserti128_si256(_mm256_castsi128_si256(first), second, 1);
}

static inline T3R_AVX2 void store_rows(uint16_t *upper, bool two, __m256i x)
{
    _mm_storeu_si128((__m128i *)(void *)upper, _mm256_castsi256_si128(x));
    if (two) {
        _mm_storeu_si128((__m128i *)(void *)(upper + T3R_TILE_SIDE), _mm256_extracti128_si256(x, 1));
    }
}

static inline T3R_AVX2 void accumulate(__m256i *sum, __m256i a, __m256i b)
{
    *sum = _mm256_add_epi32(*sum, _mm256_madd_epi16(a, b));
}

static inline T3R_AVX2 __m256i size_bits(__m256i x)
{
    return _mm256_xor_si256(x, _mm256_srai_epi32(x, 31));
}

/* The bits of all lanes. */
static inline T3R_AVX2 uint32_t any_of(__m256i x)
{
    __m128i bits = _mm_or_si128(_mm256_castsi256_si128(x), _mm256_extracti128_si256(x, 1));
    bits = _mm_or_si128(bits, _mm_srli_si128(bits, 8));
    bits = _mm_or_si128(bits, _mm_srli_si128(bits, 4));
    return (uint32_t)_mm_cvtsi128_si32(bits);
}

/* The sums of the lanes of four vectors. */
static inline T3R_AVX2 __m128i sums_of_four(const __m256i *x)
{
    const __m256i a = _mm256_add_epi32(_mm256_unpacklo_epi32(x[0], x[1]), _mm256_unpackhi_epi32(x[0], x[1]));
    const __m256i b = _mm256_add_epi32(_mm256_unpacklo_epi32(x[2], x[3]), _mm256_unpackhi_epi32(x[2], x[3]));
    const __m256i c = _mm256_add_epi32(_mm256_unpacklo_epi64(a, b), _mm256_unpackhi_epi64(a, b));
    return _mm_add_epi32(_mm256_castsi256_si128(c), _mm256_extracti128_si256(c, 1));
}

static inline T3R_AVX2 __m256i sums_of_eight(const __m256i *x)
{
    return _mm256_inserti128_si256(_mm256_castsi128_si256(sums_of_four(x)), sums_of_four(x + 4), 1);
}

/* One pair of rows: takes the splat off the tile; without `terms` that is all. */
typedef struct off_job {
    t3r_wanted *tile;
    const t3r_tile_splat *span;
    __m256i colour[3];
    __m128i scale, less;
    __m256i squares, products, squares_sum, products_sum; /* as terms_of() in scatter.c has them */
} off_job;

static inline __attribute__((always_inline)) T3R_AVX2 void take_off(off_job *job, const t3r_blended_row *row,
                                                                    uint32_t j, uint32_t column, bool two,
                                                                    step_terms *terms, __m256i sums[GRADIENT])
{
    const __m256i zero = _mm256_setzero_si256();
    const __m256i alpha = load_rows(row->alpha_q15, sizeof *row, two);
    __m256i w = zero, moves[3], lacks[3];
    if (terms != NULL) {
        w = load_rows(row->weight_q16, sizeof *row, two);
        w = _mm256_and_si256(w, load_rows(job->tile->counts[j] + column, sizeof job->tile->counts[0], two));
        w = _mm256_srli_epi16(_mm256_sll_epi16(w, job->scale), 1);
    }
    for (int c = 0; c < 3; c++) {
        uint16_t *place = job->tile->pixels.colour_q7[c][j] + column;
        const __m256i behind = load_rows(place, sizeof job->tile->counts[0], two);
        const __m256i step = _mm256_sub_epi16(job->colour[c], behind);
        store_rows(place, two, _mm256_add_epi16(behind, _mm256_mulhrs_epi16(alpha, step)));
        if (terms != NULL) {
            moves[c] = _mm256_mulhrs_epi16(w, step);
            lacks[c] = load_rows(job->tile->residual_q4[c][j] + column, sizeof job->tile->counts[0], two);
        }
    }
    if (terms == NULL) {
        return;
    }
    const __m256i share = _mm256_sra_epi16(w, job->less);
    for (int c = 0; c < 3; c++) {
        accumulate(&sums[COLOUR + c], share, lacks[c]);
    }
    accumulate(&sums[WEIGHT], share, _mm256_set1_epi16(1));
    for (int half = 0; half < 2; half++) {
        const __m256i two_moves =
            half == 0 ? _mm256_unpacklo_epi16(moves[0], moves[1]) : _mm256_unpackhi_epi16(moves[0], moves[1]);
        const __m256i last_moves =
            half == 0 ? _mm256_unpacklo_epi16(moves[2], zero) : _mm256_unpackhi_epi16(moves[2], zero);
        const __m256i two_lacks =
            half == 0 ? _mm256_unpacklo_epi16(lacks[0], lacks[1]) : _mm256_unpackhi_epi16(lacks[0], lacks[1]);
        const __m256i last_lacks =
            half == 0 ? _mm256_unpacklo_epi16(lacks[2], zero) : _mm256_unpackhi_epi16(lacks[2], zero);
        const __m256i square =
            _mm256_add_epi32(_mm256_madd_epi16(two_moves, two_moves), _mm256_madd_epi16(last_moves, last_moves));
        const __m256i product =
            _mm256_add_epi32(_mm256_madd_epi16(two_moves, two_lacks), _mm256_madd_epi16(last_moves, last_lacks));
        terms->square[half] = square;
        terms->product[half] = product;
        job->squares = _mm256_or_si256(job->squares, square);
        job->squares_sum = _mm256_add_epi32(job->squares_sum, _mm256_srli_epi32(square, 8));
        const __m256i size = size_bits(product);
        job->products = _mm256_or_si256(job->products, size);
        job->products_sum = _mm256_add_epi32(job->products_sum, _mm256_srli_epi32(size, 8));
    }
}

/* A rounding right shift in the two steps of t3r_shift_steps. */
static inline T3R_AVX2 __m256i packed_squares(const __m256i square[2], __m128i first, __m128i half)
{
    const __m256i one = _mm256_broadcastd_epi32(half);
    const __m256i a = _mm256_srl_epi32(_mm256_add_epi32(_mm256_srl_epi32(square[0], first), one), half);
    const __m256i b = _mm256_srl_epi32(_mm256_add_epi32(_mm256_srl_epi32(square[1], first), one), half);
    return _mm256_packs_epi32(a, b);
}

static inline T3R_AVX2 __m256i packed_products(const __m256i product[2], __m128i first, __m128i half)
{
    const __m256i one = _mm256_broadcastd_epi32(half);
    const __m256i a = _mm256_sra_epi32(_mm256_add_epi32(_mm256_sra_epi32(product[0], first), one), half);
    const __m256i b = _mm256_sra_epi32(_mm256_add_epi32(_mm256_sra_epi32(product[1], first), one), half);
    return _mm256_packs_epi32(a, b);
}

/* x (or y) of the first two rows of a group; modulo 2^16. */
static inline T3R_AVX2 __m256i first_rows(int16_t origin, int16_t right, int16_t down, uint32_t column)
{
    const __m256i across = _mm256_add_epi16(_mm256_setr_epi16(0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7),
                                            _mm256_set1_epi16((int16_t)column));
    const __m256i row = _mm256_inserti128_si256(_mm256_setzero_si256(), _mm_set1_epi16(down), 1);
    return _mm256_add_epi16(_mm256_add_epi16(_mm256_set1_epi16(origin), row),
                            _mm256_mullo_epi16(across, _mm256_set1_epi16(right)));
}

static inline T3R_AVX2 void add_step(__m256i x, __m256i y, __m256i square, __m256i product, __m256i *gradient,
                                     __m256i *curvature)
{
    const __m256i one = _mm256_set1_epi16(1);
    const __m256i xx = _mm256_mulhrs_epi16(x, x), xy = _mm256_mulhrs_epi16(x, y), yy = _mm256_mulhrs_epi16(y, y);
    accumulate(&gradient[T3R_M_1], product, one);
    accumulate(&gradient[T3R_M_X], product, x);
    accumulate(&gradient[T3R_M_Y], product, y);
    accumulate(&gradient[T3R_M_X2], product, xx);
    accumulate(&gradient[T3R_M_XY], product, xy);
    accumulate(&gradient[T3R_M_Y2], product, yy);
    accumulate(&curvature[T3R_M_1], square, one);
    accumulate(&curvature[T3R_M_X], square, x);
    accumulate(&curvature[T3R_M_Y], square, y);
    accumulate(&curvature[T3R_M_X2], square, xx);
    accumulate(&curvature[T3R_M_XY], square, xy);
    accumulate(&curvature[T3R_M_Y2], square, yy);
    const __m256i square_x = _mm256_mulhrs_epi16(square, x), square_y = _mm256_mulhrs_epi16(square, y);
    accumulate(&curvature[T3R_M_X3], square_x, xx);
    accumulate(&curvature[T3R_M_X2Y], square_x, xy);
    accumulate(&curvature[T3R_M_XY2], square_x, yy);
    accumulate(&curvature[T3R_M_Y3], square_y, yy);
    const __m256i square_xx = _mm256_mulhrs_epi16(square, xx), square_xy = _mm256_mulhrs_epi16(square, xy);
    accumulate(&curvature[T3R_M_X4], square_xx, xx);
    accumulate(&curvature[T3R_M_X3Y], square_xx, xy);
    accumulate(&curvature[T3R_M_X2Y2], square_xx, yy);
    accumulate(&curvature[T3R_M_XY3], square_xy, yy);
    accumulate(&curvature[T3R_M_Y4], _mm256_mulhrs_epi16(square, yy), yy);
}

/* Eight sums, each shifted right (or left, below 0) as t3r_scale32() does, held to +-most and added. */
static inline T3R_AVX2 void add_scaled(const __m256i *lanes, __m256i right, __m256i most, int32_t *to)
{
    const __m256i one = _mm256_set1_epi32(1), x = sums_of_eight(lanes);
    const __m256i rounded =
        _mm256_srai_epi32(_mm256_add_epi32(_mm256_srav_epi32(x, _mm256_sub_epi32(right, one)), one), 1);
    const __m256i raised = _mm256_sllv_epi32(x, _mm256_sub_epi32(_mm256_setzero_si256(), right));
    __m256i sum = _mm256_blendv_epi8(raised, rounded, _mm256_cmpgt_epi32(right, _mm256_setzero_si256()));
    sum = _mm256_max_epi32(_mm256_min_epi32(sum, most), _mm256_sub_epi32(_mm256_setzero_si256(), most));
    __m256i *place = (__m256i *)(void *)to;
    _mm256_storeu_si256(place, _mm256_add_epi32(_mm256_loadu_si256(place), sum));
}

static T3R_AVX2 void take_all_off(off_job *job, const t3r_scatter_splat *splat)
{
    const t3r_tile_splat *span = splat->span;
    const t3r_blended_row *row = splat->rows;
    for (uint32_t group = 0; group < span->groups; group++) {
        for (uint32_t j = span->first; j <= span->last; j += 2) {
            const bool two = j < span->last;
            take_off(job, row, j, span->column + group * T3R_LANES, two, NULL, NULL);
            row += two ? 2 : 1;
        }
    }
}

/* The same, with the terms of every pair of rows; returns how many there are. */
static T3R_AVX2 uint32_t collect_terms(off_job *job, const t3r_scatter_splat *splat, step_terms *terms,
                                       __m256i sums[GRADIENT])
{
    const t3r_tile_splat *span = splat->span;
    const t3r_blended_row *row = splat->rows;
    uint32_t steps = 0;
    for (uint32_t group = 0; group < span->groups; group++) {
        for (uint32_t j = span->first; j <= span->last; j += 2) {
            const bool two = j < span->last;
            take_off(job, row, j, span->column + group * T3R_LANES, two, &terms[steps++], sums);
            row += two ? 2 : 1;
        }
    }
    return steps;
}

static T3R_AVX2 void sum_moments(const t3r_scatter_splat *splat, const step_terms *next, uint32_t steps,
                                 t3r_shift_steps square_by, t3r_shift_steps product_by, __m256i sums[SUMS])
{
    const uint32_t groups = splat->span->groups;
    const __m128i square_first = _mm_cvtsi32_si128((int)square_by.first);
    const __m128i square_half = _mm_cvtsi32_si128((int)square_by.half);
    const __m128i product_first = _mm_cvtsi32_si128((int)product_by.first);
    const __m128i product_half = _mm_cvtsi32_si128((int)product_by.half);
    const __m256i x_down = _mm256_set1_epi16((int16_t)(uint16_t)(2 * splat->down_q13[0]));
    const __m256i y_down = _mm256_set1_epi16((int16_t)(uint16_t)(2 * splat->down_q13[1]));
    for (uint32_t group = 0; group < groups; group++) {
        __m256i x = first_rows(splat->origin_q13[0], splat->right_q13[0], splat->down_q13[0], group * T3R_LANES);
        __m256i y = first_rows(splat->origin_q13[1], splat->right_q13[1], splat->down_q13[1], group * T3R_LANES);
        for (uint32_t at = 0; at < steps / groups; at++, next++) {
            add_step(x, y, packed_squares(next->square, square_first, square_half),
                     packed_products(next->product, product_first, product_half), sums + GRADIENT, sums + CURVATURE);
            x = _mm256_add_epi16(x, x_down);
            y = _mm256_add_epi16(y, y_down);
        }
    }
}

static T3R_AVX2 void add_sums(const __m256i *sums, const t3r_sum_shifts *by, int32_t most, t3r_refine_sums *to)
{
    const int32_t gradient = by->gradient, gradient_1 = gradient + T3R_X_FRACTION;
    const int32_t gradient_2 = gradient + T3R_XX_FRACTION, curvature = by->curvature;
    const int32_t curvature_1 = curvature + T3R_X_FRACTION, curvature_2 = curvature + T3R_XX_FRACTION;
    const int32_t curvature_3 = curvature + T3R_XXX_FRACTION, curvature_4 = curvature + T3R_XXXX_FRACTION;
    const __m256i held = _mm256_set1_epi32(most),
                  no_colours = _mm256_setr_epi32(INT32_MAX, INT32_MAX, INT32_MAX, INT32_MAX, most, most, most, most);
    int32_t *place = to->colour;
    add_scaled(
        sums,
        _mm256_setr_epi32(by->colour, by->colour, by->colour, by->weight, gradient, gradient_1, gradient_1, gradient_2),
        no_colours, place);
    add_scaled(sums + 8,
               _mm256_setr_epi32(gradient_2, gradient_2, curvature, curvature_1, curvature_1, curvature_2, curvature_2,
                                 curvature_2),
               held, place + 8);
    add_scaled(sums + 16,
               _mm256_setr_epi32(curvature_3, curvature_3, curvature_3, curvature_3, curvature_4, curvature_4,
                                 curvature_4, curvature_4),
               held, place + 16);
    const __m256i last[4] = {sums[24], _mm256_setzero_si256(), _mm256_setzero_si256(), _mm256_setzero_si256()};
    const int32_t sum = t3r_scale32(_mm_cvtsi128_si32(sums_of_four(last)), -curvature_4);
    to->curvature[T3R_M_Y4] += t3r_clamp32(sum, -most, most);
}

/* The right shift of terms whose bits and sums of sizes these are. */
static T3R_AVX2 uint32_t shift_of(__m256i bits, __m256i size_sums, uint32_t rows)
{
    const __m256i zero = _mm256_setzero_si256(), four[4] = {size_sums, zero, zero, zero};
    return t3r_term_shift(any_of(bits), (uint32_t)_mm_cvtsi128_si32(sums_of_four(four)), rows);
}

T3R_AVX2 void t3r_scatter_avx2(t3r_wanted *restrict tile, const t3r_scatter_splat *splat, t3r_refine_sums *restrict to)
{
    const t3r_tile_splat *span = splat->span;
    const uint32_t rows = t3r_rows_of(span), less = t3r_count_bits(rows);
    const __m256i zero = _mm256_setzero_si256();
    off_job job = {.tile = tile,
                   .span = span,
                   .scale = _mm_cvtsi32_si128((int)splat->scale),
                   .less = _mm_cvtsi32_si128((int)less),
                   .squares = zero,
                   .products = zero,
                   .squares_sum = zero,
                   .products_sum = zero};
    for (int c = 0; c < 3; c++) {
        job.colour[c] = _mm256_set1_epi16((int16_t)span->colour_q7[c]);
    }
    if (to == NULL) {
        take_all_off(&job, splat);
        return;
    }
    step_terms terms[STEPS_MOST];
    __m256i sums[SUMS];
    for (int k = 0; k < SUMS; k++) {
        sums[k] = zero;
    }
    const uint32_t steps = collect_terms(&job, splat, terms, sums);
    const uint32_t square_shift = shift_of(job.squares, job.squares_sum, rows);
    const uint32_t product_shift = shift_of(job.products, job.products_sum, rows);
    sum_moments(splat, terms, steps, t3r_shift_steps_of(square_shift), t3r_shift_steps_of(product_shift), sums);
    const t3r_sum_shifts by = t3r_sum_shifts_of(to->area, splat->scale, less, square_shift, product_shift);
    add_sums(sums, &by, t3r_moment_most(to->area, splat->pixels), to);
}

#else
typedef int t3r_no_scatter_avx2; /* a file may not be empty */
#endif
