/* SPDX-License-Identifier: Apache-2.0 */
/* Scattering, PIXELS at a time: two rows of eight columns or a row of the tile, or eight columns of a row. Sums are
 * modulo 2^32, so the order of lanes does not matter. Included after a header of pixels, in a file that names the
 * function (SCATTER), its target (T3R_SCATTER) and the addition of products of pairs (SCATTER_ADD). */
#ifndef T3R_KERNELS_LANES_SCATTER_PIXELS_H
#define T3R_KERNELS_LANES_SCATTER_PIXELS_H

#include <stdbool.h>
#include <stddef.h>

#include "core/fixed.h"
#include "kernels/scatter_bits.h"

#define STEPS_MOST (T3R_BLENDED_ROWS_MOST * T3R_LANES / PIXELS) /* of a splat */

/* Squares and products of a vector's pixels: the first four columns of each part of 128 bits, then the last four, in
 * the order of packing. */
typedef struct step_terms {
    lanes square[2], product[2];
} step_terms;

static inline T3R_SCATTER void accumulate(lanes *sum, lanes a, lanes b)
{
    *sum = SCATTER_ADD(*sum, a, b);
}

static inline T3R_SCATTER lanes size_bits(lanes x)
{
    return different(x, OF_LANES(srai_epi32)(x, 31));
}

/* Sums the lanes of both halves. */
static inline T3R_SCATTER quad folded(lanes x)
{
    return LANES == 4 ? part(x, 0) : OF_QUAD(add_epi32)(part(x, 0), part(x, 1));
}

/* Sums the lanes of each of four vectors. */
static inline T3R_SCATTER quad sums_of_four(lanes x0, lanes x1, lanes x2, lanes x3)
{
    const lanes a = add(OF_LANES(unpacklo_epi32)(x0, x1), OF_LANES(unpackhi_epi32)(x0, x1));
    const lanes b = add(OF_LANES(unpacklo_epi32)(x2, x3), OF_LANES(unpackhi_epi32)(x2, x3));
    return folded(add(OF_LANES(unpacklo_epi64)(a, b), OF_LANES(unpackhi_epi64)(a, b)));
}

/* State of removing a splat. */
typedef struct off_job {
    t3r_wanted *tile;
    lanes colour[3];
    quad scale, less;
    lanes squares, products, squares_sum, products_sum; /* as in terms_of() in scatter.c */
    lanes lacking[3], weight;
} off_job;

/* Pixels' weights, the splat's changes of their colours, and their residuals. */
typedef struct taken_pixels {
    lanes w, moves[3], lacks[3];
} taken_pixels;

/* Removes the splat from a vector of pixels in these rows of the low and the high half; fills `out` unless it is NULL.
 */
T3R_LANES_INLINE T3R_SCATTER void take_off(const off_job *job, const t3r_blended_row *low_row,
                                           const t3r_blended_row *high_row, uint32_t place, shape which,
                                           taken_pixels *out)
{
    lanes weights, alpha;
    load_kept(low_row, high_row, which, &weights, &alpha);
    if (out != NULL) {
        const lanes counted = both(weights, load_pixels(plane_at(job->tile->counts, place), which));
        out->w = OF_LANES(srli_epi16)(OF_LANES(sll_epi16)(counted, job->scale), 1);
    }
    for (int c = 0; c < 3; c++) {
        uint16_t *colour = plane_at(job->tile->pixels.colour_q7[c], place);
        const lanes behind = load_pixels(colour, which);
        const lanes step = OF_LANES(sub_epi16)(job->colour[c], behind);
        store_pixels(colour, which, OF_LANES(add_epi16)(behind, OF_LANES(mulhrs_epi16)(alpha, step)));
        if (out != NULL) {
            out->moves[c] = OF_LANES(mulhrs_epi16)(out->w, step);
            out->lacks[c] = load_pixels(plane_at(job->tile->residual_q4[c], place), which);
        }
    }
}

/* Columns of three colours for sums of products: pairs of two colours, and the third beside 0. */
typedef struct columns {
    lanes two, third;
} columns;

T3R_LANES_INLINE T3R_SCATTER columns first_columns(const lanes x[3])
{
    return (columns){OF_LANES(unpacklo_epi16)(x[0], x[1]), OF_LANES(unpacklo_epi16)(x[2], all(0))};
}

T3R_LANES_INLINE T3R_SCATTER columns last_columns(const lanes x[3])
{
    return (columns){OF_LANES(unpackhi_epi16)(x[0], x[1]), OF_LANES(unpackhi_epi16)(x[2], all(0))};
}

T3R_LANES_INLINE T3R_SCATTER lanes sum_of_products(columns a, columns b)
{
    return SCATTER_ADD(OF_LANES(madd_epi16)(a.two, b.two), a.third, b.third);
}

/* Stores squares and products of four columns of each part: half of them. */
T3R_LANES_INLINE T3R_SCATTER void note_half(off_job *job, columns moves, columns lacks, lanes *square, lanes *product)
{
    *square = sum_of_products(moves, moves);
    *product = sum_of_products(moves, lacks);
    const lanes size = size_bits(*product);
    job->squares = either(job->squares, *square);
    job->squares_sum = add(job->squares_sum, OF_LANES(srli_epi32)(*square, 8));
    job->products = either(job->products, size);
    job->products_sum = add(job->products_sum, OF_LANES(srli_epi32)(size, 8));
}

T3R_LANES_INLINE T3R_SCATTER void note_terms(off_job *job, const taken_pixels *x, step_terms *terms)
{
    const lanes share = OF_LANES(sra_epi16)(x->w, job->less);
    for (int c = 0; c < 3; c++) {
        accumulate(&job->lacking[c], share, x->lacks[c]);
    }
    accumulate(&job->weight, share, OF_LANES(set1_epi16)(1));
    note_half(job, first_columns(x->moves), first_columns(x->lacks), &terms->square[0], &terms->product[0]);
    note_half(job, last_columns(x->moves), last_columns(x->lacks), &terms->square[1], &terms->product[1]);
}

/* Removes the splat from a vector and stores its terms, unless `terms` is NULL. */
T3R_LANES_INLINE T3R_SCATTER void step(off_job *job, const t3r_blended_row *low_row, const t3r_blended_row *high_row,
                                       uint32_t place, shape which, step_terms *terms)
{
    taken_pixels x;
    take_off(job, low_row, high_row, place, which, terms == NULL ? NULL : &x);
    if (terms != NULL) {
        note_terms(job, &x, terms);
    }
}

/* A rounding right shift: squares are below 3 x 2^30, products' sizes below 3 x 2^27, so that halves fit. */
typedef struct rounding {
    lanes half;
    quad shift;
} rounding;

static inline T3R_SCATTER rounding rounding_of(uint32_t shift)
{
    return (rounding){all((int32_t)((1u << shift) >> 1)), OF_QUAD(cvtsi32_si128)((int)shift)};
}

static inline T3R_SCATTER lanes packed_squares(const lanes square[2], const rounding *by)
{
    return OF_LANES(packs_epi32)(OF_LANES(srl_epi32)(add(square[0], by->half), by->shift),
                                 OF_LANES(srl_epi32)(add(square[1], by->half), by->shift));
}

static inline T3R_SCATTER lanes packed_products(const lanes product[2], const rounding *by)
{
    return OF_LANES(packs_epi32)(OF_LANES(sra_epi32)(add(product[0], by->half), by->shift),
                                 OF_LANES(sra_epi32)(add(product[1], by->half), by->shift));
}

/* x and y of a vector's pixels and their change from step to step; modulo 2^16. */
typedef struct places {
    lanes at[2], down[2];
} places;

/* Repeats x modulo 2^16. */
static inline T3R_SCATTER quad all_16(int32_t x)
{
    return OF_QUAD(set1_epi16)((int16_t)(uint16_t)x);
}

/* Returns the places from the group on. */
static inline T3R_SCATTER places places_of(const t3r_scatter_splat *splat, uint32_t group)
{
    const bool whole = PIXELS == T3R_TILE_SIDE && splat->span->groups == 2;
    const lanes column = repeated(OF_QUAD(setr_epi16)(0, 1, 2, 3, 4, 5, 6, 7));
    places p;
    for (int k = 0; k < 2; k++) {
        const int32_t right = splat->right_q13[k], down = splat->down_q13[k];
        const int32_t first = splat->origin_q13[k] + (int32_t)group * T3R_LANES * right;
        /* the high half is beside or below the low one */
        const quad halves[2] = {all_16(first), all_16(first + (whole ? T3R_LANES * right : down))};
        p.at[k] = OF_LANES(add_epi16)(joined(halves), OF_LANES(mullo_epi16)(column, repeated(all_16(right))));
        p.down[k] = repeated(all_16(whole ? down : PIXELS / T3R_LANES * down));
    }
    return p;
}

/* Adds orders 0 to 2. */
static inline T3R_SCATTER void add_low(lanes x, lanes y, lanes terms, lanes *sums)
{
    accumulate(&sums[T3R_M_1], terms, OF_LANES(set1_epi16)(1));
    accumulate(&sums[T3R_M_X], terms, x);
    accumulate(&sums[T3R_M_Y], terms, y);
    accumulate(&sums[T3R_M_X2], terms, OF_LANES(mulhrs_epi16)(x, x));
    accumulate(&sums[T3R_M_XY], terms, OF_LANES(mulhrs_epi16)(x, y));
    accumulate(&sums[T3R_M_Y2], terms, OF_LANES(mulhrs_epi16)(y, y));
}

/* Adds orders 3 and 4. */
static inline T3R_SCATTER void add_high(lanes x, lanes y, lanes square, lanes *curvature)
{
    const lanes xx = OF_LANES(mulhrs_epi16)(x, x), xy = OF_LANES(mulhrs_epi16)(x, y), yy = OF_LANES(mulhrs_epi16)(y, y);
    const lanes square_x = OF_LANES(mulhrs_epi16)(square, x), square_y = OF_LANES(mulhrs_epi16)(square, y);
    accumulate(&curvature[T3R_M_X3], square_x, xx);
    accumulate(&curvature[T3R_M_X2Y], square_x, xy);
    accumulate(&curvature[T3R_M_XY2], square_x, yy);
    accumulate(&curvature[T3R_M_Y3], square_y, yy);
    const lanes square_xx = OF_LANES(mulhrs_epi16)(square, xx), square_xy = OF_LANES(mulhrs_epi16)(square, xy);
    accumulate(&curvature[T3R_M_X4], square_xx, xx);
    accumulate(&curvature[T3R_M_X3Y], square_xx, xy);
    accumulate(&curvature[T3R_M_X2Y2], square_xx, yy);
    accumulate(&curvature[T3R_M_XY3], square_xy, yy);
    accumulate(&curvature[T3R_M_Y4], OF_LANES(mulhrs_epi16)(square, yy), yy);
}

typedef struct moments {
    lanes gradient[T3R_REFINE_MOMENTS_2], curvature[T3R_REFINE_MOMENTS_4];
} moments;

/* Adds the requested sums, a choice that is constant once inlined. */
T3R_LANES_INLINE T3R_SCATTER void sum_moments(places at, const step_terms *terms, uint32_t steps, rounding square_by,
                                              rounding product_by, bool low, bool high, moments *to)
{
    moments m = *to; /* in registers */
    for (uint32_t i = 0; i < steps; i++) {
        const lanes square = packed_squares(terms[i].square, &square_by);
        if (low) {
            add_low(at.at[0], at.at[1], packed_products(terms[i].product, &product_by), m.gradient);
            add_low(at.at[0], at.at[1], square, m.curvature);
        }
        if (high) {
            add_high(at.at[0], at.at[1], square, m.curvature);
        }
        at.at[0] = OF_LANES(add_epi16)(at.at[0], at.down[0]);
        at.at[1] = OF_LANES(add_epi16)(at.at[1], at.down[1]);
    }
    *to = m;
}

/* Adds sums, each shifted right (or left, below 0) like t3r_scale32() and clamped to +-most. */
static inline T3R_SCATTER void add_scaled(lanes x, lanes right, lanes most, int32_t *to)
{
    const lanes one = all(1);
    const lanes rounded = OF_LANES(srai_epi32)(add(signed_right_each(x, subtract(right, one)), one), 1);
    const lanes raised = left_each(x, subtract(all(0), right));
    lanes sum = chosen(greater(right, all(0)), rounded, raised);
    sum = OF_LANES(max_epi32)(OF_LANES(min_epi32)(sum, most), subtract(all(0), most));
    store(to, add(load(to), sum));
}

/* Removes the splat from the group on, and stores the terms of every step unless `terms` is NULL; returns their
 * number. */
T3R_LANES_INLINE T3R_SCATTER uint32_t collect_terms(off_job *job, const t3r_scatter_splat *splat, uint32_t group,
                                                    step_terms *terms)
{
    enum { ROWS = PIXELS / T3R_LANES };
    const t3r_tile_splat *span = splat->span;
    const uint32_t rows = span->last - span->first + 1u;
    const t3r_blended_row *row = splat->rows + group * rows;
    uint32_t place = (uint32_t)span->first * T3R_TILE_SIDE + span->column + group * T3R_LANES, steps = 0;
    if (PIXELS == T3R_TILE_SIDE && span->groups == 2) {
        for (; steps < rows; steps++, row++, place += T3R_TILE_SIDE) {
            step(job, row, row + rows, place, T3R_WHOLE_ROW, terms == NULL ? NULL : &terms[steps]);
        }
        return steps;
    }
    for (; steps < rows / ROWS; steps++, row += ROWS, place += ROWS * T3R_TILE_SIDE) {
        step(job, row, row + 1, place, PIXELS_USUAL, terms == NULL ? NULL : &terms[steps]);
    }
    if (rows % ROWS != 0) {
        step(job, row, NULL, place, T3R_ONE_ROW, terms == NULL ? NULL : &terms[steps]);
        steps++;
    }
    return steps;
}

/* Returns the number of groups taken separately: a vector that holds a row of the tile takes both together. */
static inline uint32_t passes_of(const t3r_scatter_splat *splat)
{
    return PIXELS == T3R_TILE_SIDE ? 1 : splat->span->groups;
}

_Static_assert(offsetof(t3r_refine_sums, gradient) == 4 * sizeof(int32_t) &&
                   offsetof(t3r_refine_sums, curvature) == (4 + T3R_REFINE_MOMENTS_2) * sizeof(int32_t),
               "sums lie one behind the other");

/* fine: sums of residuals, and the weight. */
static inline T3R_SCATTER void add_sums(quad fine, const moments *m, const t3r_sum_shifts *by, int32_t most,
                                        t3r_refine_sums *to)
{
    enum { X = T3R_X_FRACTION, X2 = T3R_X2_FRACTION, X3 = T3R_X3_FRACTION, X4 = T3R_X4_FRACTION, SUMS = 24 };
    static const int32_t fraction[SUMS] = {0, 0,  0,  0,  0,  X,  X,  X2, X2, X2, 0,  X,
                                           X, X2, X2, X2, X3, X3, X3, X3, X4, X4, X4, X4};
    const lanes *g = m->gradient, *c = m->curvature;
    const quad gradient = OF_QUAD(set1_epi32)(by->gradient), curvature = OF_QUAD(set1_epi32)(by->curvature);
    const quad held = OF_QUAD(set1_epi32)(most);
    const quad sums[SUMS / 4] = {fine,
                                 sums_of_four(g[0], g[1], g[2], g[3]),
                                 sums_of_four(g[4], g[5], c[0], c[1]),
                                 sums_of_four(c[2], c[3], c[4], c[5]),
                                 sums_of_four(c[6], c[7], c[8], c[9]),
                                 sums_of_four(c[10], c[11], c[12], c[13])};
    const quad right[SUMS / 4] = {OF_QUAD(setr_epi32)(by->colour, by->colour, by->colour, by->weight),
                                  gradient,
                                  OF_QUAD(unpacklo_epi64)(gradient, curvature),
                                  curvature,
                                  curvature,
                                  curvature};
    const quad bound[SUMS / 4] = {OF_QUAD(set1_epi32)(INT32_MAX), held, held, held, held, held};
    int32_t *first = (int32_t *)(void *)to;
    T3R_LANES_UNROLL for (int i = 0; i < SUMS; i += LANES)
    {
        add_scaled(joined(sums + i / 4), add(joined(right + i / 4), load(fraction + i)), joined(bound + i / 4),
                   first + i);
    }
    const lanes zero = all(0);
    const int32_t last =
        t3r_scale32(OF_QUAD(cvtsi128_si32)(sums_of_four(c[14], zero, zero, zero)), -(by->curvature + X4));
    to->curvature[T3R_M_Y4] += t3r_clamp32(last, -most, most);
}

/* Right shifts of the terms. */
typedef struct term_shifts {
    uint32_t square, product;
} term_shifts;

static inline T3R_SCATTER term_shifts shifts_of(const off_job *job, uint32_t rows)
{
    /* squares and products side by side, all lanes folded into two */
    lanes bits = either(OF_LANES(unpacklo_epi32)(job->squares, job->products),
                        OF_LANES(unpackhi_epi32)(job->squares, job->products));
    lanes sums = add(OF_LANES(unpacklo_epi32)(job->squares_sum, job->products_sum),
                     OF_LANES(unpackhi_epi32)(job->squares_sum, job->products_sum));
    const quad bit = OF_QUAD(or_si128)(part(bits, 0), part(bits, LANES / 4 - 1)), sum = folded(sums);
    const uint64_t all_bits = (uint64_t)OF_QUAD(cvtsi128_si64)(OF_QUAD(or_si128)(bit, OF_QUAD(srli_si128)(bit, 8)));
    const uint64_t size = (uint64_t)OF_QUAD(cvtsi128_si64)(OF_QUAD(add_epi32)(sum, OF_QUAD(srli_si128)(sum, 8)));
    return (term_shifts){t3r_term_shift((uint32_t)all_bits, (uint32_t)size, rows),
                         t3r_term_shift((uint32_t)(all_bits >> 32), (uint32_t)(size >> 32), rows)};
}

/* Sums of the steps, apart from their terms. */
typedef struct taken {
    quad fine; /* residuals, and the weight */
    term_shifts shift;
    uint32_t steps;
} taken;

T3R_LANES_INLINE T3R_SCATTER taken take_splat_off(t3r_wanted *restrict tile, const t3r_scatter_splat *splat,
                                                  uint32_t less, step_terms *terms)
{
    off_job job;
    job.tile = tile;
    job.scale = OF_QUAD(cvtsi32_si128)((int)splat->scale);
    job.less = OF_QUAD(cvtsi32_si128)((int)less);
    job.squares = job.products = job.squares_sum = job.products_sum = job.weight = all(0);
    for (int c = 0; c < 3; c++) {
        job.colour[c] = OF_LANES(set1_epi16)((int16_t)splat->span->colour_q7[c]);
        job.lacking[c] = all(0);
    }
    taken t = {.steps = 0};
    for (uint32_t group = 0; group < passes_of(splat); group++) {
        t.steps += collect_terms(&job, splat, group, terms == NULL ? NULL : &terms[t.steps]);
    }
    if (terms != NULL) {
        t.fine = sums_of_four(job.lacking[0], job.lacking[1], job.lacking[2], job.weight);
        t.shift = shifts_of(&job, t3r_rows_of(splat->span));
    }
    return t;
}

T3R_LANES_INLINE T3R_SCATTER void add_terms(const t3r_scatter_splat *splat, const step_terms *terms, const taken *t,
                                            uint32_t less, t3r_refine_sums *to)
{
    const rounding square_by = rounding_of(t->shift.square), product_by = rounding_of(t->shift.product);
    const uint32_t passes = passes_of(splat), steps = t->steps / passes;
    const lanes none = all(0);
    moments m = {{none, none, none, none, none, none},
                 {none, none, none, none, none, none, none, none, none, none, none, none, none, none, none}};
    for (uint32_t group = 0; group < passes; group++, terms += steps) {
        const places at = places_of(splat, group);
        /* twice, because no instruction set has registers for all sums together */
        sum_moments(at, terms, steps, square_by, product_by, true, false, &m);
        sum_moments(at, terms, steps, square_by, product_by, false, true, &m);
    }
    const t3r_sum_shifts by = t3r_sum_shifts_of(to->area, splat->scale, less, t->shift.square, t->shift.product);
    add_sums(t->fine, &m, &by, t3r_moment_most(to->area, splat->pixels), to);
}

T3R_SCATTER void SCATTER(t3r_wanted *restrict tile, const t3r_scatter_splat *splat, t3r_refine_sums *restrict to)
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
