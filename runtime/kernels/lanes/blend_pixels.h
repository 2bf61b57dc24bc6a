/* SPDX-License-Identifier: Apache-2.0 */
/* Blending, PIXELS at a time: two rows of eight columns or a row of the tile, or eight columns of a row. Included
 * after a header of pixels, in a file that names the functions BLEND and BLEND_KEEP. */
#ifndef T3R_KERNELS_LANES_BLEND_PIXELS_H
#define T3R_KERNELS_LANES_BLEND_PIXELS_H

#include "core/alpha.h"
#include "core/memory.h"

/* Returns (a b + 2^15) / 2^16 of 16-bit unsigned numbers: the high half plus the top bit of the low half. */
static inline T3R_LANES_TARGET lanes mulr_q16(lanes a, lanes b)
{
    return OF_LANES(add_epi16)(OF_LANES(mulhi_epu16)(a, b), OF_LANES(srli_epi16)(OF_LANES(mullo_epi16)(a, b), 15));
}

/* Returns the same from twice b: (a b / 2^15 + 1) / 2, both rounded down. */
static inline T3R_LANES_TARGET lanes mulr_q16_doubled(lanes a, lanes twice_b)
{
    return OF_LANES(avg_epu16)(OF_LANES(mulhi_epu16)(a, twice_b), all(0));
}

static inline T3R_LANES_TARGET lanes constant(uint32_t x)
{
    return OF_LANES(set1_epi16)((int16_t)x);
}

/* Returns all bits set where a >= b, for 16-bit unsigned numbers. */
static inline T3R_LANES_TARGET lanes at_least_16(lanes a, lanes b)
{
    return OF_LANES(cmpeq_epi16)(OF_LANES(max_epu16)(a, b), a);
}

/* Fills each part of 128 bits with a number. */
static inline T3R_LANES_TARGET lanes each_half(int32_t low, int32_t high)
{
    const quad both_of[2] = {OF_QUAD(set1_epi32)(low), OF_QUAD(set1_epi32)(high)};
    return joined(both_of);
}

/* Eight pixels of a row in each part of 128 bits: the first four columns of the parts, and the last four. `left` is
 * T3R_ALPHA_RANGE - q / 8, times 16, plus half for rounding; modulo 2^32, like plain C's sums without overflow. */
typedef struct quadratic {
    lanes left[2], step[2], bend; /* change from step to step, and the change of that change */
} quadratic;

static inline T3R_LANES_TARGET void advance(quadratic *q)
{
    for (int k = 0; k < 2; k++) {
        q->left[k] = subtract(q->left[k], q->step[k]);
        q->step[k] = add(q->step[k], q->bend);
    }
}

/* low, high: the halves' groups; rows: distance of the high half's row below the low one's; every: rows per step. */
static inline T3R_LANES_TARGET quadratic quadratic_of(const t3r_tile_splat *s, uint32_t low, uint32_t high,
                                                      int32_t rows, int32_t every)
{
    const int32_t row[2] = {s->first, s->first + rows}, gy[2] = {s->group[low].gy, s->group[high].gy};
    const int32_t q[2] = {s->group[low].q + row[0] * (gy[0] + row[0] * s->c),
                          s->group[high].q + row[1] * (gy[1] + row[1] * s->c)};
    const lanes at = each_half(16 * T3R_ALPHA_RANGE + 7 - q[0], 16 * T3R_ALPHA_RANGE + 7 - q[1]);
    const lanes slope = each_half(s->group[low].gx + row[0] * s->b, s->group[high].gx + row[1] * s->b);
    const lanes a = all(s->a), b = all(every * s->b);
    const lanes down =
        each_half(every * (gy[0] + (2 * row[0] + every) * s->c), every * (gy[1] + (2 * row[1] + every) * s->c));
    quadratic out = {.bend = all(2 * every * every * s->c)};
    for (int k = 0; k < 2; k++) {
        const lanes i = add(repeated(OF_QUAD(setr_epi32)(0, 1, 2, 3)), all(4 * k));
        const lanes across = multiply(i, add(slope, multiply(i, a)));
        out.left[k] = subtract(at, across);
        out.step[k] = add(down, multiply(i, b));
    }
    return out;
}

static inline T3R_LANES_TARGET lanes alpha_of(const quadratic *q, lanes opacity_q16)
{
    /* packing saturates below at 0 */
    lanes s = OF_LANES(packus_epi32)(OF_LANES(srai_epi32)(q->left[0], 4), OF_LANES(srai_epi32)(q->left[1], 4));
    s = OF_LANES(min_epu16)(s, constant(T3R_ALPHA_RANGE));
    lanes p = OF_LANES(add_epi16)(constant(T3R_ALPHA_C3), OF_LANES(mulhi_epu16)(s, constant(T3R_ALPHA_C4)));
    p = OF_LANES(add_epi16)(constant(T3R_ALPHA_C2), OF_LANES(mulhi_epu16)(s, p));
    p = OF_LANES(add_epi16)(constant(T3R_ALPHA_C1), OF_LANES(mulhi_epu16)(s, p));
    p = OF_LANES(add_epi16)(constant(T3R_ALPHA_C0), OF_LANES(mulhi_epu16)(s, p));
    p = OF_LANES(mulhi_epu16)(p, p);
    p = OF_LANES(mulhi_epu16)(p, p);
    p = OF_LANES(mulhi_epu16)(p, p);
    lanes alpha = OF_LANES(min_epu16)(OF_LANES(mulhi_epu16)(p, opacity_q16), constant(T3R_ALPHA_MOST_Q16));
    return both(alpha, at_least_16(alpha, constant(T3R_ALPHA_LEAST_Q16)));
}

/* State of blending a splat. */
typedef struct blend_job {
    t3r_tile *tile;
    lanes opacity, colour[3];          /* colours are doubled */
    lanes drawn;                       /* all bits set in the drawn halves */
    lanes any;                         /* bitwise or of the kept weights */
    t3r_blended_row *rows, *high_rows; /* of both halves, or NULL; constant once inlined */
} blend_job;

T3R_LANES_INLINE T3R_LANES_TARGET void blend_step(blend_job *job, const quadratic *q, uint32_t place, shape which)
{
    uint16_t *transmittance = plane_at(job->tile->transmittance_q16, place);
    const lanes t = load_pixels(transmittance, which);
    lanes alpha = both(alpha_of(q, job->opacity), at_least_16(t, constant(T3R_STOP_Q16)));
    if (which == T3R_WHOLE_ROW) {
        alpha = both(alpha, job->drawn);
    }
    const lanes w = mulr_q16(t, alpha); /* 0 where there is no pixel */
    store_pixels(transmittance, which, OF_LANES(sub_epi16)(t, w));
    for (int c = 0; c < 3; c++) {
        uint16_t *colour = plane_at(job->tile->colour_q7[c], place);
        store_pixels(colour, which,
                     OF_LANES(add_epi16)(load_pixels(colour, which), mulr_q16_doubled(w, job->colour[c])));
    }
    if (job->rows != NULL) {
        const lanes still = OF_LANES(cmpeq_epi16)(w, all(0));
        alpha = without(still, OF_LANES(srli_epi16)(alpha, 1));
        store_kept(job->rows, job->high_rows, which, w, alpha);
        job->any = either(job->any, w);
        job->rows += which == T3R_TWO_ROWS ? 2 : 1;
        job->high_rows += which == T3R_TWO_ROWS ? 2 : 1;
    }
}

/* Blends one group, a vector's worth of rows at a time. */
T3R_LANES_INLINE T3R_LANES_TARGET void blend_group(blend_job *job, const t3r_tile_splat *splat, uint32_t group)
{
    enum { ROWS = PIXELS / T3R_LANES };
    quadratic q = quadratic_of(splat, group, group, 1, ROWS);
    uint32_t row = splat->first, place = row * T3R_TILE_SIDE + splat->column + group * T3R_LANES;
    for (; row + ROWS <= splat->last + 1u; row += ROWS, place += ROWS * T3R_TILE_SIDE) {
        blend_step(job, &q, place, PIXELS_USUAL);
        advance(&q);
    }
    if (row <= splat->last) {
        blend_step(job, &q, place, T3R_ONE_ROW);
    }
}

/* Blends both groups, a whole row of the tile at a time. */
T3R_LANES_INLINE T3R_LANES_TARGET void blend_rows(blend_job *job, const t3r_tile_splat *splat)
{
    quadratic q = quadratic_of(splat, 0, 1, 0, 1);
    for (uint32_t row = splat->first; row <= splat->last; row++) {
        blend_step(job, &q, row * T3R_TILE_SIDE, T3R_WHOLE_ROW);
        advance(&q);
    }
}

static inline T3R_LANES_TARGET blend_job begun(t3r_tile *tile, const t3r_tile_splat *splat)
{
    blend_job job = {.tile = tile, .opacity = constant(splat->opacity_q16), .any = all(0)};
    for (int c = 0; c < 3; c++) {
        job.colour[c] = constant(2u * splat->colour_q7[c]);
    }
    job.drawn = each_half(-(splat->drawn & 1), -(splat->drawn >> 1 & 1));
    return job;
}

/* Returns the bitwise or of all pixels. */
static inline T3R_LANES_TARGET uint16_t all_bits(lanes x)
{
    quad bits = OF_QUAD(or_si128)(part(x, 0), part(x, LANES / 4 - 1));
    bits = OF_QUAD(or_si128)(bits, OF_QUAD(srli_si128)(bits, 8));
    bits = OF_QUAD(or_si128)(bits, OF_QUAD(srli_si128)(bits, 4));
    return (uint16_t)((uint32_t)OF_QUAD(cvtsi128_si32)(bits) | (uint32_t)OF_QUAD(cvtsi128_si32)(bits) >> 16);
}

T3R_LANES_TARGET void BLEND(t3r_tile *tile, const t3r_tile_splat *splat)
{
    blend_job job = begun(tile, splat);
    job.rows = job.high_rows = NULL;
    if (PIXELS == T3R_TILE_SIDE && splat->drawn == 3) {
        blend_rows(&job, splat);
        return;
    }
    for (uint32_t group = 0; group < splat->groups; group++) {
        if ((splat->drawn >> group & 1) != 0) {
            blend_group(&job, splat, group);
        }
    }
}

T3R_LANES_TARGET uint16_t BLEND_KEEP(t3r_tile *restrict tile, const t3r_tile_splat *splat,
                                     t3r_blended_row *restrict rows)
{
    const uint32_t count = splat->last - splat->first + 1u;
    blend_job job = begun(tile, splat);
    if (PIXELS == T3R_TILE_SIDE && splat->groups == 2) {
        job.rows = rows;
        job.high_rows = rows + count;
        blend_rows(&job, splat);
        return all_bits(job.any);
    }
    for (uint32_t group = 0; group < splat->groups; group++, rows += count) {
        if ((splat->drawn >> group & 1) != 0) {
            job.rows = rows;
            job.high_rows = rows + 1;
            blend_group(&job, splat, group);
        } else {
            memset(rows, 0, count * sizeof *rows);
        }
    }
    return all_bits(job.any);
}

#endif
