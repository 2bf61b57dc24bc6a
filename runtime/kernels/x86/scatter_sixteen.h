/* Scattering, sixteen pixels at a time: two rows of eight columns, or a row of the tile. Sums are modulo 2^32, so that
 * lanes do not show. A file of each instruction set includes this and names the function (T3R_SCATTER_NAME), its target
 * (T3R_SCATTER) and how products of pairs are added (T3R_SCATTER_ADD). */
#ifndef T3R_KERNELS_X86_SCATTER_SIXTEEN_H
#define T3R_KERNELS_X86_SCATTER_SIXTEEN_H

#include <stdbool.h>

#include "sixteen.h"

#include "core/fixed.h"
#include "kernels/scatter_bits.h"

#define STEPS_MOST (T3R_BLENDED_ROWS_MOST / 2) /* of sixteen pixels, of a splat */

/* Squares and products of sixteen pixels: the first four columns of both halves, then the last four, as packing takes
 * them. */
typedef struct step_terms {
    __m256i square[2], product[2];
} step_terms;

static inline T3R_SCATTER void accumulate(__m256i *sum, __m256i a, __m256i b)
{
    *sum = T3R_SCATTER_ADD(*sum, a, b);
}

static inline T3R_SCATTER __m256i size_bits(__m256i x)
{
    return _mm256_xor_si256(x, _mm256_srai_epi32(x, 31));
}

/* The sums of the lanes of four vectors. */
static inline T3R_SCATTER __m128i sums_of_four(__m256i x0, __m256i x1, __m256i x2, __m256i x3)
{
    const __m256i a = _mm256_add_epi32(_mm256_unpacklo_epi32(x0, x1), _mm256_unpackhi_epi32(x0, x1));
    const __m256i b = _mm256_add_epi32(_mm256_unpacklo_epi32(x2, x3), _mm256_unpackhi_epi32(x2, x3));
    const __m256i c = _mm256_add_epi32(_mm256_unpacklo_epi64(a, b), _mm256_unpackhi_epi64(a, b));
    return _mm_add_epi32(_mm256_castsi256_si128(c), _mm256_extracti128_si256(c, 1));
}

/* What taking a splat off needs at each step. */
typedef struct off_job {
    t3r_wanted *tile;
    __m256i colour[3];
    __m128i scale, less;
    __m256i squares, products, squares_sum, products_sum; /* as terms_of() in scatter.c has them */
    __m256i lacking[3], weight;
} off_job;

/* How sixteen pixels weigh, how far the splat moves their colours, and what these lack. */
typedef struct sixteen {
    __m256i w, moves[3], lacks[3];
} sixteen;

/* Takes sixteen pixels off, of which these are the rows of the low and the high half; fills `out` unless it is NULL. */
T3R_X86_INLINE T3R_SCATTER void take_off(const off_job *job, const t3r_blended_row *low_row,
                                         const t3r_blended_row *high_row, uint32_t place, t3r_sixteen pixels,
                                         sixteen *out)
{
    const __m256i low = _mm256_loadu_si256((const __m256i *)(const void *)low_row);
    const __m256i high =
        pixels == T3R_ONE_ROW ? _mm256_setzero_si256() : _mm256_loadu_si256((const __m256i *)(const void *)high_row);
    const __m256i alpha = _mm256_permute2x128_si256(low, high, 0x31);
    if (out != NULL) {
        const __m256i w = _mm256_permute2x128_si256(low, high, 0x20);
        const __m256i counted = _mm256_and_si256(w, t3r_load_sixteen(job->tile->counts[0] + place, pixels));
        out->w = _mm256_srli_epi16(_mm256_sll_epi16(counted, job->scale), 1);
    }
    for (int c = 0; c < 3; c++) {
        uint16_t *colour = job->tile->pixels.colour_q7[c][0] + place;
        const __m256i behind = t3r_load_sixteen(colour, pixels);
        const __m256i step = _mm256_sub_epi16(job->colour[c], behind);
        t3r_store_sixteen(colour, pixels, _mm256_add_epi16(behind, _mm256_mulhrs_epi16(alpha, step)));
        if (out != NULL) {
            out->moves[c] = _mm256_mulhrs_epi16(out->w, step);
            out->lacks[c] = t3r_load_sixteen(job->tile->residual_q4[c][0] + place, pixels);
        }
    }
}

/* Half of them: squares and products of four columns of both halves. */
T3R_X86_INLINE T3R_SCATTER void note_half(off_job *job, __m256i two_moves, __m256i last_move, __m256i two_lacks,
                                          __m256i last_lack, __m256i *square_out, __m256i *product_out)
{
    __m256i square = _mm256_madd_epi16(two_moves, two_moves);
    __m256i product = _mm256_madd_epi16(two_moves, two_lacks);
    accumulate(&square, last_move, last_move);
    accumulate(&product, last_move, last_lack);
    *square_out = square;
    *product_out = product;
    job->squares = _mm256_or_si256(job->squares, square);
    job->squares_sum = _mm256_add_epi32(job->squares_sum, _mm256_srli_epi32(square, 8));
    const __m256i size = size_bits(product);
    job->products = _mm256_or_si256(job->products, size);
    job->products_sum = _mm256_add_epi32(job->products_sum, _mm256_srli_epi32(size, 8));
}

T3R_X86_INLINE T3R_SCATTER void note_terms(off_job *job, const sixteen *x, step_terms *terms)
{
    const __m256i zero = _mm256_setzero_si256(), share = _mm256_sra_epi16(x->w, job->less);
    const __m256i *moves = x->moves, *lacks = x->lacks;
    for (int c = 0; c < 3; c++) {
        accumulate(&job->lacking[c], share, lacks[c]);
    }
    accumulate(&job->weight, share, _mm256_set1_epi16(1));
    note_half(job, _mm256_unpacklo_epi16(moves[0], moves[1]), _mm256_unpacklo_epi16(moves[2], zero),
              _mm256_unpacklo_epi16(lacks[0], lacks[1]), _mm256_unpacklo_epi16(lacks[2], zero), &terms->square[0],
              &terms->product[0]);
    note_half(job, _mm256_unpackhi_epi16(moves[0], moves[1]), _mm256_unpackhi_epi16(moves[2], zero),
              _mm256_unpackhi_epi16(lacks[0], lacks[1]), _mm256_unpackhi_epi16(lacks[2], zero), &terms->square[1],
              &terms->product[1]);
}

/* Both; without `terms` it is taken off alone. */
T3R_X86_INLINE T3R_SCATTER void step(off_job *job, const t3r_blended_row *low_row, const t3r_blended_row *high_row,
                                     uint32_t place, t3r_sixteen pixels, step_terms *terms)
{
    sixteen x;
    take_off(job, low_row, high_row, place, pixels, terms == NULL ? NULL : &x);
    if (terms != NULL) {
        note_terms(job, &x, terms);
    }
}

/* A rounding right shift: squares are below 3 x 2^30, products' sizes below 3 x 2^27, so that halves fit. */
typedef struct rounding {
    __m256i half;
    __m128i shift;
} rounding;

static inline T3R_SCATTER rounding rounding_of(uint32_t shift)
{
    return (rounding){_mm256_set1_epi32((int32_t)((1u << shift) >> 1)), _mm_cvtsi32_si128((int)shift)};
}

static inline T3R_SCATTER __m256i packed_squares(const __m256i square[2], const rounding *by)
{
    return _mm256_packs_epi32(_mm256_srl_epi32(_mm256_add_epi32(square[0], by->half), by->shift),
                              _mm256_srl_epi32(_mm256_add_epi32(square[1], by->half), by->shift));
}

static inline T3R_SCATTER __m256i packed_products(const __m256i product[2], const rounding *by)
{
    return _mm256_packs_epi32(_mm256_sra_epi32(_mm256_add_epi32(product[0], by->half), by->shift),
                              _mm256_sra_epi32(_mm256_add_epi32(product[1], by->half), by->shift));
}

/* x and y of sixteen pixels and their change from step to step; modulo 2^16. */
typedef struct places {
    __m256i at[2], down[2];
} places;

static inline T3R_SCATTER places places_of(const t3r_scatter_splat *splat)
{
    const bool whole = splat->span->groups == 2;
    const __m256i lane = _mm256_setr_epi16(0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7);
    const __m256i high = _mm256_setr_epi64x(0, 0, -1, -1);
    places p;
    for (int k = 0; k < 2; k++) {
        const int32_t right = splat->right_q13[k], down = splat->down_q13[k];
        /* what the high half is beside or below the low one */
        const __m256i beyond = _mm256_set1_epi16((int16_t)(uint16_t)(whole ? T3R_LANES * right : down));
        const __m256i first = _mm256_add_epi16(_mm256_set1_epi16(splat->origin_q13[k]), _mm256_and_si256(beyond, high));
        p.at[k] = _mm256_add_epi16(first, _mm256_mullo_epi16(lane, _mm256_set1_epi16((int16_t)right)));
        p.down[k] = _mm256_set1_epi16((int16_t)(uint16_t)(whole ? down : 2 * down));
    }
    return p;
}

/* Orders 0 to 2 */
static inline T3R_SCATTER void add_low(__m256i x, __m256i y, __m256i terms, __m256i *sums)
{
    accumulate(&sums[T3R_M_1], terms, _mm256_set1_epi16(1));
    accumulate(&sums[T3R_M_X], terms, x);
    accumulate(&sums[T3R_M_Y], terms, y);
    accumulate(&sums[T3R_M_X2], terms, _mm256_mulhrs_epi16(x, x));
    accumulate(&sums[T3R_M_XY], terms, _mm256_mulhrs_epi16(x, y));
    accumulate(&sums[T3R_M_Y2], terms, _mm256_mulhrs_epi16(y, y));
}

/* Orders 3 and 4 */
static inline T3R_SCATTER void add_high(__m256i x, __m256i y, __m256i square, __m256i *curvature)
{
    const __m256i xx = _mm256_mulhrs_epi16(x, x), xy = _mm256_mulhrs_epi16(x, y), yy = _mm256_mulhrs_epi16(y, y);
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

typedef struct moments {
    __m256i gradient[T3R_REFINE_MOMENTS_2], curvature[T3R_REFINE_MOMENTS_4];
} moments;

/* Adds the sums that are asked for, which is known where this is inlined. */
T3R_X86_INLINE T3R_SCATTER void sum_moments(places at, const step_terms *terms, uint32_t steps, rounding square_by,
                                            rounding product_by, bool low, bool high, moments *to)
{
    moments m = *to; /* in registers */
    for (uint32_t i = 0; i < steps; i++) {
        const __m256i square = packed_squares(terms[i].square, &square_by);
        if (low) {
            add_low(at.at[0], at.at[1], packed_products(terms[i].product, &product_by), m.gradient);
            add_low(at.at[0], at.at[1], square, m.curvature);
        }
        if (high) {
            add_high(at.at[0], at.at[1], square, m.curvature);
        }
        at.at[0] = _mm256_add_epi16(at.at[0], at.down[0]);
        at.at[1] = _mm256_add_epi16(at.at[1], at.down[1]);
    }
    *to = m;
}

/* Eight sums, each shifted right (or left, below 0) as t3r_scale32() does, held to +-most and added. */
static inline T3R_SCATTER void add_scaled(__m128i low, __m128i high, __m256i right, __m256i most, int32_t *to)
{
    const __m256i one = _mm256_set1_epi32(1), x = _mm256_inserti128_si256(_mm256_castsi128_si256(low), high, 1);
    const __m256i rounded =
        _mm256_srai_epi32(_mm256_add_epi32(_mm256_srav_epi32(x, _mm256_sub_epi32(right, one)), one), 1);
    const __m256i raised = _mm256_sllv_epi32(x, _mm256_sub_epi32(_mm256_setzero_si256(), right));
    __m256i sum = _mm256_blendv_epi8(raised, rounded, _mm256_cmpgt_epi32(right, _mm256_setzero_si256()));
    sum = _mm256_max_epi32(_mm256_min_epi32(sum, most), _mm256_sub_epi32(_mm256_setzero_si256(), most));
    __m256i *place = (__m256i *)(void *)to;
    _mm256_storeu_si256(place, _mm256_add_epi32(_mm256_loadu_si256(place), sum));
}

/* Takes the splat off, and notes the terms of every step unless `terms` is NULL; returns how many there are. */
T3R_X86_INLINE T3R_SCATTER uint32_t collect_terms(off_job *job, const t3r_scatter_splat *splat, step_terms *terms)
{
    const t3r_tile_splat *span = splat->span;
    const t3r_blended_row *row = splat->rows;
    const uint32_t rows = span->last - span->first + 1u;
    uint32_t place = (uint32_t)span->first * T3R_TILE_SIDE + span->column, steps = 0;
    if (span->groups == 2) {
        for (; steps < rows; steps++, row++, place += T3R_TILE_SIDE) {
            step(job, row, row + rows, place, T3R_WHOLE_ROW, terms == NULL ? NULL : &terms[steps]);
        }
        return steps;
    }
    for (; steps < rows / 2; steps++, row += 2, place += 2u * T3R_TILE_SIDE) {
        step(job, row, row + 1, place, T3R_TWO_ROWS, terms == NULL ? NULL : &terms[steps]);
    }
    if (rows % 2 != 0) {
        step(job, row, NULL, place, T3R_ONE_ROW, terms == NULL ? NULL : &terms[steps]);
        steps++;
    }
    return steps;
}

/* fine: what is lacking, and the weight. */
static inline T3R_SCATTER void add_sums(__m128i fine, const moments *m, const t3r_sum_shifts *by, int32_t most,
                                        t3r_refine_sums *to)
{
    enum { X = T3R_X_FRACTION, X2 = T3R_X2_FRACTION, X3 = T3R_X3_FRACTION, X4 = T3R_X4_FRACTION };
    const __m256i gradient = _mm256_set1_epi32(by->gradient), curvature = _mm256_set1_epi32(by->curvature);
    const __m256i held = _mm256_set1_epi32(most), *g = m->gradient, *c = m->curvature;
    const __m256i first = _mm256_blend_epi32(_mm256_set1_epi32(by->colour), _mm256_set1_epi32(by->weight), 1 << 3);
    add_scaled(fine, sums_of_four(g[0], g[1], g[2], g[3]),
               _mm256_add_epi32(_mm256_blend_epi32(first, gradient, 0xf0), _mm256_setr_epi32(0, 0, 0, 0, 0, X, X, X2)),
               _mm256_blend_epi32(_mm256_set1_epi32(INT32_MAX), held, 0xf0), to->colour);
    add_scaled(
        sums_of_four(g[4], g[5], c[0], c[1]), sums_of_four(c[2], c[3], c[4], c[5]),
        _mm256_add_epi32(_mm256_blend_epi32(gradient, curvature, 0xfc), _mm256_setr_epi32(X2, X2, 0, X, X, X2, X2, X2)),
        held, to->gradient + T3R_M_XY);
    add_scaled(sums_of_four(c[6], c[7], c[8], c[9]), sums_of_four(c[10], c[11], c[12], c[13]),
               _mm256_add_epi32(curvature, _mm256_setr_epi32(X3, X3, X3, X3, X4, X4, X4, X4)), held,
               to->curvature + T3R_M_X3);
    const __m256i zero = _mm256_setzero_si256();
    const int32_t last = t3r_scale32(_mm_cvtsi128_si32(sums_of_four(c[14], zero, zero, zero)), -(by->curvature + X4));
    to->curvature[T3R_M_Y4] += t3r_clamp32(last, -most, most);
}

/* Right shifts of the terms. */
typedef struct term_shifts {
    uint32_t square, product;
} term_shifts;

static inline T3R_SCATTER term_shifts shifts_of(const off_job *job, uint32_t rows)
{
    /* of squares and products side by side, all lanes folded into two */
    __m256i bits = _mm256_or_si256(_mm256_unpacklo_epi32(job->squares, job->products),
                                   _mm256_unpackhi_epi32(job->squares, job->products));
    __m256i sums = _mm256_add_epi32(_mm256_unpacklo_epi32(job->squares_sum, job->products_sum),
                                    _mm256_unpackhi_epi32(job->squares_sum, job->products_sum));
    __m128i bit = _mm_or_si128(_mm256_castsi256_si128(bits), _mm256_extracti128_si256(bits, 1));
    __m128i sum = _mm_add_epi32(_mm256_castsi256_si128(sums), _mm256_extracti128_si256(sums, 1));
    const uint64_t all = (uint64_t)_mm_cvtsi128_si64(_mm_or_si128(bit, _mm_srli_si128(bit, 8)));
    const uint64_t size = (uint64_t)_mm_cvtsi128_si64(_mm_add_epi32(sum, _mm_srli_si128(sum, 8)));
    return (term_shifts){t3r_term_shift((uint32_t)all, (uint32_t)size, rows),
                         t3r_term_shift((uint32_t)(all >> 32), (uint32_t)(size >> 32), rows)};
}

/* What the steps leave beside their terms. */
typedef struct taken {
    __m128i fine; /* what is lacking, and the weight */
    term_shifts shift;
    uint32_t steps;
} taken;

T3R_X86_INLINE T3R_SCATTER taken take_splat_off(t3r_wanted *restrict tile, const t3r_scatter_splat *splat,
                                                uint32_t less, step_terms *terms)
{
    off_job job;
    job.tile = tile;
    job.scale = _mm_cvtsi32_si128((int)splat->scale);
    job.less = _mm_cvtsi32_si128((int)less);
    job.squares = job.products = job.squares_sum = job.products_sum = job.weight = _mm256_setzero_si256();
    for (int c = 0; c < 3; c++) {
        job.colour[c] = _mm256_set1_epi16((int16_t)splat->span->colour_q7[c]);
        job.lacking[c] = _mm256_setzero_si256();
    }
    taken t = {.steps = collect_terms(&job, splat, terms)};
    if (terms != NULL) {
        t.fine = sums_of_four(job.lacking[0], job.lacking[1], job.lacking[2], job.weight);
        t.shift = shifts_of(&job, t3r_rows_of(splat->span));
    }
    return t;
}

T3R_X86_INLINE T3R_SCATTER void add_terms(const t3r_scatter_splat *splat, const step_terms *terms, const taken *t,
                                          uint32_t less, t3r_refine_sums *to)
{
    const rounding square_by = rounding_of(t->shift.square), product_by = rounding_of(t->shift.product);
    const places at = places_of(splat);
    const __m256i none = _mm256_setzero_si256();
    moments m = {{none, none, none, none, none, none},
                 {none, none, none, none, none, none, none, none, none, none, none, none, none, none, none}};
    /* twice, as no instruction set has registers for all sums at once */
    sum_moments(at, terms, t->steps, square_by, product_by, true, false, &m);
    sum_moments(at, terms, t->steps, square_by, product_by, false, true, &m);
    const t3r_sum_shifts by = t3r_sum_shifts_of(to->area, splat->scale, less, t->shift.square, t->shift.product);
    add_sums(t->fine, &m, &by, t3r_moment_most(to->area, splat->pixels), to);
}

T3R_SCATTER void T3R_SCATTER_NAME(t3r_wanted *restrict tile, const t3r_scatter_splat *splat,
                                  t3r_refine_sums *restrict to)
{
    const uint32_t less = t3r_count_bits(t3r_rows_of(splat->span));
    if (to == NULL) {
        (void)take_splat_off(tile, splat, less, NULL);
        return;
    }
    step_terms terms[STEPS_MOST];
    const taken t = take_splat_off(tile, splat, less, terms);
    add_terms(splat, terms, &t, less, to);
}

#endif
