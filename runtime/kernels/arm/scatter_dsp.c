/* SPDX-License-Identifier: Apache-2.0 */
/* Scattering for a Cortex-M with sums of two products: pixels in which the splat has no weight are skipped, the others
 * are gathered and summed two at a time. */
#include "variants.h"

#if defined(T3R_DSP) && T3R_FEATURE_REFINEMENT

#include <arm_acle.h>
#include <stdbool.h>

#include "core/fixed.h"
#include "kernels/lanes/vectors/inline.h"
#include "kernels/scatter_bits.h"
#include "products.h"

enum { PIXELS_MOST = T3R_BLENDED_ROWS_MOST * T3R_LANES };

/* A pixel's terms before the reduction to 16 bits, and its place: terms_of() in scatter.c. */
typedef struct pixel_term {
    uint32_t square;
    int32_t product;
    int16_t x_q13, y_q13;
} pixel_term;

typedef struct off_job {
    t3r_wanted *tile;
    int32_t twice_colour[3];
    uint32_t scale, less;
    int32_t lacking[3], weight;
} off_job;

static inline int32_t mulr_q15(int32_t a, int32_t b)
{
    return __smlabb(a, b, 1 << 14) >> 15;
}

/* Removes the splat from a pixel. Returns whether the pixel counts, and its term unless `term` is NULL. */
static inline __attribute__((always_inline)) bool take_pixel_off(off_job *job, uint32_t weight, int32_t alpha,
                                                                 uint32_t row, uint32_t column, pixel_term *term)
{
    const int32_t w = (uint16_t)((weight & job->tile->counts[row][column]) << job->scale) >> 1;
    const int32_t share = w >> job->less, w_q31 = w << 16, alpha_q31 = alpha * (1 << 16);
    uint32_t square = 0;
    int32_t product = 0;
    T3R_LANES_UNROLL for (int c = 0; c < 3; c++)
    {
        uint16_t *behind = &job->tile->pixels.colour_q7[c][row][column];
        const int32_t twice_step = job->twice_colour[c] - 2 * *behind;
        *behind = (uint16_t)t3r_add_high_product(*behind, alpha_q31, twice_step); /* alpha x step, rounded */
        if (term != NULL) {
            const int32_t moves = t3r_high_product(w_q31, twice_step), lacks = job->tile->residual_q4[c][row][column];
            square += (uint32_t)(moves * moves);
            product += moves * lacks;
            job->lacking[c] += share * lacks;
        }
    }
    if (term == NULL || w == 0) {
        return false;
    }
    job->weight += share;
    term->square = square;
    term->product = product;
    return true;
}

/* Removes the splat, and stores the terms of its pixels unless `terms` is NULL; returns their number. */
static inline __attribute__((always_inline)) uint32_t take_splat_off(off_job *job, const t3r_scatter_splat *splat,
                                                                     pixel_term *terms)
{
    const t3r_tile_splat *span = splat->span;
    const t3r_blended_row *at = splat->rows;
    pixel_term *term = terms;
    for (uint32_t group = 0; group < span->groups; group++) {
        for (uint32_t row = span->first; row <= span->last; row++, at++) {
            const int32_t down = (int32_t)(row - span->first), across = (int32_t)(group * T3R_LANES);
            const int32_t x = splat->origin_q13[0] + down * splat->down_q13[0] + across * splat->right_q13[0];
            const int32_t y = splat->origin_q13[1] + down * splat->down_q13[1] + across * splat->right_q13[1];
            for (int32_t i = 0; i < T3R_LANES; i++) {
                const uint32_t weight = at->weight_q16[i], column = span->column + (uint32_t)(across + i);
                if (weight != 0 && take_pixel_off(job, weight, at->alpha_q15[i], row, column, term)) {
                    term->x_q13 = (int16_t)(uint16_t)(x + i * splat->right_q13[0]); /* modulo 2^16 */
                    term->y_q13 = (int16_t)(uint16_t)(y + i * splat->right_q13[1]);
                    term++;
                }
            }
        }
    }
    return terms == NULL ? 0 : (uint32_t)(term - terms);
}

/* Sizes of all terms: the bitwise or, and the sum, each without its last 8 bits. */
typedef struct term_sizes {
    uint32_t squares, products, squares_sum, products_sum;
} term_sizes;

static term_sizes sizes_of(const pixel_term *terms, uint32_t count)
{
    term_sizes s = {0, 0, 0, 0};
    for (const pixel_term *end = terms + count; terms != end; terms++) {
        const uint32_t size = (uint32_t)(terms->product ^ (terms->product >> 31));
        s.squares |= terms->square;
        s.squares_sum += terms->square >> 8;
        s.products |= size;
        s.products_sum += size >> 8;
    }
    return s;
}

/* A factor of two pixels. */
typedef union factor {
    int16_t one[2];
    int16x2_t both;
} factor;

static inline uint32_t added(uint32_t sum, factor a, factor b)
{
    return (uint32_t)__smlad(a.both, b.both, (int32_t)sum);
}

static inline uint32_t added_alone(uint32_t sum, factor a)
{
    const factor one = {.one = {1, 1}};
    return added(sum, a, one);
}

#include "kernels/lanes/scatter_moments.h"

enum { CHUNK = 32 }; /* pairs whose factors are kept at the same time */

static void factors_of(const pixel_term *term, uint32_t count, const t3r_shift_steps square_by,
                       const t3r_shift_steps product_by, factors *f)
{
    for (uint32_t i = 0; i < count; i++, term++) {
        const uint32_t k = i % 2;
        factors *to = f + i / 2;
        const int32_t x = term->x_q13, y = term->y_q13;
        const int32_t xx = mulr_q15(x, x), xy = mulr_q15(x, y), yy = mulr_q15(y, y);
        const int32_t m = (int32_t)(((term->square >> square_by.first) + square_by.half) >> square_by.half);
        const int32_t p = ((term->product >> product_by.first) + (int32_t)product_by.half) >> product_by.half;
        to->product.one[k] = (int16_t)p;
        to->square.one[k] = (int16_t)m;
        to->x.one[k] = (int16_t)x;
        to->y.one[k] = (int16_t)y;
        to->xx.one[k] = (int16_t)xx;
        to->xy.one[k] = (int16_t)xy;
        to->yy.one[k] = (int16_t)yy;
        to->square_x.one[k] = (int16_t)mulr_q15(m, x);
        to->square_y.one[k] = (int16_t)mulr_q15(m, y);
        to->square_xx.one[k] = (int16_t)mulr_q15(m, xx);
        to->square_xy.one[k] = (int16_t)mulr_q15(m, xy);
        to->square_yy.one[k] = (int16_t)mulr_q15(m, yy);
    }
}

void t3r_scatter_dsp(t3r_wanted *restrict tile, const t3r_scatter_splat *splat, t3r_refine_sums *restrict to)
{
    const uint32_t all_rows = t3r_rows_of(splat->span), less = t3r_count_bits(all_rows);
    off_job job = {.tile = tile, .scale = splat->scale, .less = less};
    for (int c = 0; c < 3; c++) {
        job.twice_colour[c] = 2 * splat->span->colour_q7[c];
    }
    if (to == NULL) {
        (void)take_splat_off(&job, splat, NULL);
        return;
    }
    pixel_term terms[PIXELS_MOST + 1];
    const uint32_t count = take_splat_off(&job, splat, terms);
    terms[count] = (pixel_term){0, 0, 0, 0}; /* after the last, to complete a pair */
    const term_sizes sizes = sizes_of(terms, count);
    const uint32_t square_shift = t3r_term_shift(sizes.squares, sizes.squares_sum, all_rows);
    const uint32_t product_shift = t3r_term_shift(sizes.products, sizes.products_sum, all_rows);
    const t3r_shift_steps square_by = t3r_shift_steps_of(square_shift), product_by = t3r_shift_steps_of(product_shift);
    uint32_t gradient[T3R_REFINE_MOMENTS_2] = {0}, curvature[T3R_REFINE_MOMENTS_4] = {0};
    for (uint32_t first = 0; first < count; first += 2 * CHUNK) {
        factors f[CHUNK];
        const uint32_t pairs = T3R_MIN((count - first + 1) / 2, CHUNK);
        factors_of(terms + first, 2 * pairs, square_by, product_by, f);
        add_factors(f, pairs, gradient, curvature);
    }
    const t3r_sum_shifts by = t3r_sum_shifts_of(to->area, splat->scale, less, square_shift, product_shift);
    t3r_add_scattered(job.lacking, job.weight, gradient, curvature, &by, t3r_moment_most(to->area, splat->pixels), to);
}

#else
typedef int t3r_no_scatter_dsp; /* a file may not be empty */
#endif
