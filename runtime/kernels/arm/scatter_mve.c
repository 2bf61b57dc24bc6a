/* SPDX-License-Identifier: Apache-2.0 */
/* Scattering, eight pixels at a time, in vectors of Helium. Rows in which the splat has no weight are skipped. */
#include "variants.h"

#if defined(T3R_MVE) && T3R_FEATURE_REFINEMENT

#include <arm_mve.h>

#include "core/fixed.h"
#include "kernels/lanes/vectors/inline.h"
#include "kernels/scatter_bits.h"

/* Terms of a row's pixels before the reduction to 16 bits: first the even columns, then the odd ones. */
typedef struct row_terms {
    uint32x4_t square[2];
    int32x4_t product[2];
    uint32_t group, row; /* of the splat */
} row_terms;

typedef struct off_job {
    t3r_wanted *tile;
    int16_t colour[3];
    int32_t scale, less;
    uint32x4_t squares, products; /* bitwise or, as in terms_of() in scatter.c */
    uint32_t squares_sum, products_sum;
    int32_t lacking[3], weight;
} off_job;

enum { PLANE = T3R_TILE_SIDE * T3R_TILE_SIDE };

/* Removes the splat from a row. Returns whether it has weight there, and the terms unless `terms` is NULL. */
static inline __attribute__((always_inline)) bool take_row_off(off_job *job, const t3r_blended_row *row, uint32_t place,
                                                               row_terms *terms)
{
    const uint16x8_t weights = vld1q_u16(row->weight_q16);
    if (vcmpneq_n_u16(weights, 0) == 0) {
        return false;
    }
    const int16x8_t alpha = vld1q_s16(row->alpha_q15);
    const uint16x8_t counted = vandq_u16(weights, vld1q_u16(&job->tile->counts[0][0] + place));
    const int16x8_t w = vreinterpretq_s16_u16(vshrq_n_u16(vshlq_r_u16(counted, job->scale), 1));
    const int16x8_t share = vshlq_r_s16(w, -job->less);
    uint32x4_t square[2] = {vdupq_n_u32(0), vdupq_n_u32(0)};
    int32x4_t product[2] = {vdupq_n_s32(0), vdupq_n_s32(0)};
    int16_t *behind_at = (int16_t *)&job->tile->pixels.colour_q7[0][0][0] + place;
    const int16_t *lacks_at = &job->tile->residual_q4[0][0][0] + place;
    T3R_LANES_UNROLL for (int c = 0; c < 3; c++, behind_at += PLANE, lacks_at += PLANE)
    {
        const int16x8_t behind = vld1q_s16(behind_at), step = vsubq_s16(vdupq_n_s16(job->colour[c]), behind);
        vst1q_s16(behind_at, vaddq_s16(behind, vqrdmulhq_s16(alpha, step)));
        if (terms != NULL) {
            const int16x8_t moves = vqrdmulhq_s16(w, step), lacks = vld1q_s16(lacks_at);
            square[0] = vaddq_u32(square[0], vreinterpretq_u32_s32(vmullbq_int_s16(moves, moves)));
            square[1] = vaddq_u32(square[1], vreinterpretq_u32_s32(vmulltq_int_s16(moves, moves)));
            product[0] = vaddq_s32(product[0], vmullbq_int_s16(moves, lacks));
            product[1] = vaddq_s32(product[1], vmulltq_int_s16(moves, lacks));
            job->lacking[c] = vmladavaq_s16(job->lacking[c], share, lacks);
        }
    }
    if (terms != NULL) {
        job->weight = vaddvaq_s16(job->weight, share);
        for (int k = 0; k < 2; k++) {
            const uint32x4_t size = vreinterpretq_u32_s32(veorq_s32(product[k], vshrq_n_s32(product[k], 31)));
            terms->square[k] = square[k];
            terms->product[k] = product[k];
            job->squares = vorrq_u32(job->squares, square[k]);
            job->products = vorrq_u32(job->products, size);
            job->squares_sum = vaddvaq_u32(job->squares_sum, vshrq_n_u32(square[k], 8));
            job->products_sum = vaddvaq_u32(job->products_sum, vshrq_n_u32(size, 8));
        }
    }
    return true;
}

/* Removes the splat, and stores the terms of rows with weight unless `terms` is NULL; returns their number. */
static inline __attribute__((always_inline)) uint32_t take_splat_off(off_job *job, const t3r_scatter_splat *splat,
                                                                     row_terms *terms)
{
    const t3r_tile_splat *span = splat->span;
    const uint32_t rows = span->last - span->first + 1u;
    const t3r_blended_row *row = splat->rows;
    uint32_t count = 0;
    for (uint32_t group = 0; group < span->groups; group++) {
        uint32_t place = (uint32_t)span->first * T3R_TILE_SIDE + span->column + group * T3R_LANES;
        for (uint32_t j = 0; j < rows; j++, row++, place += T3R_TILE_SIDE) {
            if (take_row_off(job, row, place, terms == NULL ? NULL : &terms[count]) && terms != NULL) {
                terms[count].group = group;
                terms[count].row = j;
                count++;
            }
        }
    }
    return count;
}

/* A factor of a row's pixels. */
typedef int16x8_t factor;

static inline uint32_t added(uint32_t sum, factor a, factor b)
{
    return (uint32_t)vmladavaq_s16((int32_t)sum, a, b);
}

static inline uint32_t added_alone(uint32_t sum, factor a)
{
    return (uint32_t)vaddvaq_s16((int32_t)sum, a);
}

#include "kernels/lanes/scatter_moments.h"

enum { CHUNK = 8 }; /* rows whose factors are kept at the same time */

static inline int16x8_t coordinates(const t3r_scatter_splat *splat, uint32_t k, const row_terms *row)
{
    const int32_t right = splat->right_q13[k];
    const int32_t first = splat->origin_q13[k] + (int32_t)row->row * splat->down_q13[k] +
                          (int32_t)(row->group * T3R_LANES) * right; /* modulo 2^16 */
    const int16x8_t column = vreinterpretq_s16_u16(vidupq_n_u16(0, 1));
    return vaddq_n_s16(vmulq_n_s16(column, (int16_t)right), (int16_t)(uint16_t)first);
}

static inline void factors_of(const row_terms *terms, const t3r_scatter_splat *splat, int32_t square_shift,
                              int32_t product_shift, factors *f)
{
    const int16x8_t none = vdupq_n_s16(0);
    const int16x8_t x = coordinates(splat, 0, terms), y = coordinates(splat, 1, terms);
    const int16x8_t xx = vqrdmulhq_s16(x, x), xy = vqrdmulhq_s16(x, y), yy = vqrdmulhq_s16(y, y);
    int16x8_t m = vmovnbq_s32(none, vreinterpretq_s32_u32(vrshlq_n_u32(terms->square[0], -square_shift)));
    m = vmovntq_s32(m, vreinterpretq_s32_u32(vrshlq_n_u32(terms->square[1], -square_shift)));
    f->product = vmovntq_s32(vmovnbq_s32(none, vrshlq_n_s32(terms->product[0], -product_shift)),
                             vrshlq_n_s32(terms->product[1], -product_shift));
    f->square = m;
    f->x = x;
    f->y = y;
    f->xx = xx;
    f->xy = xy;
    f->yy = yy;
    f->square_x = vqrdmulhq_s16(m, x);
    f->square_y = vqrdmulhq_s16(m, y);
    f->square_xx = vqrdmulhq_s16(m, xx);
    f->square_xy = vqrdmulhq_s16(m, xy);
    f->square_yy = vqrdmulhq_s16(m, yy);
}

static uint32_t bits_of(uint32x4_t x)
{
    return vgetq_lane_u32(x, 0) | vgetq_lane_u32(x, 1) | vgetq_lane_u32(x, 2) | vgetq_lane_u32(x, 3);
}

void t3r_scatter_mve(t3r_wanted *restrict tile, const t3r_scatter_splat *splat, t3r_refine_sums *restrict to)
{
    const uint32_t all_rows = t3r_rows_of(splat->span), less = t3r_count_bits(all_rows);
    off_job job = {.tile = tile, .scale = (int32_t)splat->scale, .less = (int32_t)less};
    for (int c = 0; c < 3; c++) {
        job.colour[c] = (int16_t)splat->span->colour_q7[c];
    }
    if (to == NULL) {
        (void)take_splat_off(&job, splat, NULL);
        return;
    }
    row_terms terms[T3R_BLENDED_ROWS_MOST];
    job.squares = job.products = vdupq_n_u32(0);
    const uint32_t count = take_splat_off(&job, splat, terms);
    const uint32_t square_shift = t3r_term_shift(bits_of(job.squares), job.squares_sum, all_rows);
    const uint32_t product_shift = t3r_term_shift(bits_of(job.products), job.products_sum, all_rows);
    uint32_t gradient[T3R_REFINE_MOMENTS_2] = {0}, curvature[T3R_REFINE_MOMENTS_4] = {0};
    for (uint32_t first = 0; first < count; first += CHUNK) {
        factors f[CHUNK];
        const uint32_t rows = T3R_MIN(count - first, CHUNK);
        for (uint32_t i = 0; i < rows; i++) {
            factors_of(&terms[first + i], splat, (int32_t)square_shift, (int32_t)product_shift, &f[i]);
        }
        add_factors(f, rows, gradient, curvature);
    }
    const t3r_sum_shifts by = t3r_sum_shifts_of(to->area, splat->scale, less, square_shift, product_shift);
    t3r_add_scattered(job.lacking, job.weight, gradient, curvature, &by, t3r_moment_most(to->area, splat->pixels), to);
}

#else
typedef int t3r_no_scatter_mve; /* a file may not be empty */
#endif
