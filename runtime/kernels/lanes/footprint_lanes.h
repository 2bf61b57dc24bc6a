/* SPDX-License-Identifier: Apache-2.0 */
/* Means and footprints of LANES Gaussians at a time, for their projection and their axes, with the steps and bounds of
 * project.c. Included after a header of lanes. */
#ifndef T3R_KERNELS_LANES_FOOTPRINT_LANES_H
#define T3R_KERNELS_LANES_FOOTPRINT_LANES_H

#include "kernels/lanes/vectors/records.h"
#include "kernels/project_parts.h"

static inline T3R_LANES_TARGET lanes held(lanes x, lanes bound)
{
    return OF_LANES(max_epi32)(OF_LANES(min_epi32)(x, bound), subtract(all(0), bound));
}

/* Multiplies a signed by an unsigned number. */
static inline T3R_LANES_TARGET wide mixed_product(lanes a, lanes b)
{
    const lanes beyond = both(a, OF_LANES(srai_epi32)(b, 31)); /* b read as signed lacks 2^32 there */
    return sum(product(a, b), lifted(beyond));
}

/* Returns x / 2^shift, round-half-up, of 64 bits if twice the result fits 32 bits; shift 1..33. */
static inline T3R_LANES_TARGET lanes round_shift(wide x, lanes shift)
{
    return OF_LANES(srai_epi32)(add(low_of(right_by(x, widened(subtract(shift, all(1))))), all(1)), 1);
}

/* Returns the same for signed numbers, |x| < 2^62, from their upper halves; shift 33 and more. */
static inline T3R_LANES_TARGET lanes round_shift_far(wide x, lanes shift)
{
    return OF_LANES(srai_epi32)(add(signed_right_each(high_of(x), subtract(shift, all(33))), all(1)), 1);
}

/* Returns floor(2^62 / normal), normal in 2^31..2^32 - 1: a parabola to 1 %, Newton's step to 14 bits, then twice the
 * remainder over the divisor. The last step is off by at most one, as a test of all divisors shows. */
static inline T3R_LANES_TARGET lanes inverted(lanes normal)
{
    const wide one = all_wide(INT64_C(1) << 62);
    const lanes x = OF_LANES(srli_epi32)(normal, 17); /* Q15, 1/2..1 */
    /* 140 / 33 - x (64 / 11 - x 256 / 99), Q14 */
    const lanes slope = subtract(all(95325), OF_LANES(srli_epi32)(multiply(x, all(42367)), 15));
    lanes y = subtract(all(69508), OF_LANES(srli_epi32)(multiply(x, slope), 15));
    const lanes lack = OF_LANES(srai_epi32)(subtract(all(1 << 29), multiply(x, y)), 14);
    y = add(y, OF_LANES(srai_epi32)(multiply(y, lack), 15));
    lanes quotient = OF_LANES(slli_epi32)(y, 16);
    wide rest = difference(one, unsigned_product(normal, quotient)); /* below 2^49 */
    quotient = add(quotient, OF_LANES(srai_epi32)(multiply(y, OF_LANES(srai_epi32)(high_of(rest), 2)), 12));
    rest = difference(one, unsigned_product(normal, quotient)); /* below 2^38 */
    quotient = add(quotient, OF_LANES(srai_epi32)(multiply(y, low_of(right(rest, 22))), 24));
    rest = difference(one, unsigned_product(normal, quotient));
    const lanes high = high_of(rest), is_more = greater(high, all(0)),
                is_there = both(equal(high, all(0)), at_least(low_of(rest), normal));
    return subtract(add(quotient, OF_LANES(srai_epi32)(high, 31)), either(is_more, is_there));
}

_Static_assert(offsetof(t3r_gaussian, factor) == 12 && offsetof(t3r_gaussian, factor_exponent) == 30 &&
                   offsetof(t3r_gaussian, colour_q7) == 32 && offsetof(t3r_gaussian, opacity_q15) == 38,
               "a Gaussian's first ten words: position, factor and exponent, colours and opacity");

/* Reads the first ten words of LANES Gaussians. */
static inline T3R_LANES_TARGET void read_gaussians(const t3r_gaussian *gaussians, lanes word[10])
{
    const uint8_t *from[LANES];
    T3R_LANES_UNROLL for (int i = 0; i < LANES; i++)
    {
        from[i] = (const uint8_t *)&gaussians[i];
    }
    read_four(from, 0, word);
    read_four(from, 16, word + 4);
    read_two(from, 32, word + 8);
}

/* Gaussians by field. */
typedef struct gaussians_by_field {
    lanes position[3], factor[9], exponent, opacity_q15;
} by_field;

/* Converts the first ten words of each Gaussian to fields. */
static inline T3R_LANES_TARGET by_field fields_of(const lanes word[10])
{
    by_field g;
    for (int k = 0; k < 3; k++) {
        g.position[k] = word[k];
    }
    for (int k = 0; k < 9; k++) {
        const lanes two = word[3 + k / 2];
        g.factor[k] = OF_LANES(srai_epi32)(k % 2 == 0 ? OF_LANES(slli_epi32)(two, 16) : two, 16);
    }
    g.exponent = OF_LANES(srai_epi32)(OF_LANES(slli_epi32)(word[7], 8), 24);
    g.opacity_q15 = OF_LANES(srli_epi32)(word[9], 16);
    return g;
}

/* Means in camera coordinates, and whether they are visible; invisible ones have harmless values. */
typedef struct means {
    lanes z_q20, rn, lz, u_q24, v_q24, are_seen;
    lanes beyond; /* the highest bit marks a lane that needs more than 32 bits */
} means;

static inline T3R_LANES_TARGET means see(const t3r_projection *p, const by_field *g)
{
    lanes c[3], beyond = all(0), by;
    for (int i = 0; i < 3; i++) {
        const int32_t *w = p->world_to_camera_q30 + 3 * i;
        int64_t constant = INT64_C(1) << 29;
        for (int k = 0; k < 3; k++) {
            constant -= (int64_t)w[k] * p->centre_q20[k];
        }
        wide at_q50 = all_wide(constant);
        for (int k = 0; k < 3; k++) {
            at_q50 = sum(at_q50, product(g->position[k], all(w[k])));
        }
        c[i] = low_of(right(at_q50, 30));
        /* 32 bits hold c where its three highest bits are the same */
        beyond = either(beyond, add(high_of(at_q50), all(1 << 29)));
    }
    beyond = either(beyond, OF_LANES(slli_epi32)(beyond, 1));
    const lanes aside = OF_LANES(slli_epi32)(OF_LANES(min_epu32)(c[2], all(1 << 27)), 4);
    means m;
    m.are_seen = both(greater(c[2], all(T3R_NEAR_Q20)), greater(g->opacity_q15, all(128)));
    m.are_seen = both(m.are_seen, at_least(aside, OF_LANES(abs_epi32)(c[0])));
    m.are_seen = both(m.are_seen, at_least(aside, OF_LANES(abs_epi32)(c[1])));
    m.z_q20 = chosen(m.are_seen, c[2], all(1 << 20));
    const lanes normal = OF_LANES(slli_epi32)(normal_of(m.z_q20, 8, &by), 1);
    m.lz = add(by, all(1));
    m.beyond = either(beyond, subtract(m.lz, all(5))); /* farther than 2^27 */
    m.rn = inverted(normal);
    const lanes shift = subtract(all(38), m.lz);
    m.u_q24 = round_shift(mixed_product(both(c[0], m.are_seen), m.rn), shift);
    m.v_q24 = round_shift(mixed_product(both(c[1], m.are_seen), m.rn), shift);
    return m;
}

/* Computes footprint_row(). */
static inline T3R_LANES_TARGET void row_of(const int32_t *w, const int32_t *w2, lanes tangent_q24, int32_t f_q16,
                                           means *m, const by_field *g, lanes row_q12[3])
{
    lanes r_q24[3]; /* at most 17 x 2^24 */
    for (int i = 0; i < 3; i++) {
        /* w - round(along) rounded once more by 6 is floor(w + 2^5 - along + (2^-1 - 2^-24)) by 6 */
        const int64_t constant = (int64_t)w[i] * (1 << 24) + (1 << 29) + (1 << 23) - 1;
        r_q24[i] = low_of(right(difference(all_wide(constant), product(tangent_q24, all(w2[i]))), 30));
    }
    const lanes scale = low_of(right(sum(unsigned_product(m->rn, all(f_q16)), all_wide(1 << 29)), 30));
    const lanes shift = subtract(all(26), add(g->exponent, m->lz));
    m->beyond = either(m->beyond, subtract(shift, all(33))); /* wider than about a quarter of z */
    for (int j = 0; j < 3; j++) {
        wide along = all_wide(1 << 13);
        for (int k = 0; k < 3; k++) {
            along = sum(along, product(r_q24[k], g->factor[3 * k + j]));
        }
        /* 3 x 17 x 2^24 x 2^15 / 2^14 < 2^31, times scale < 2^31 */
        const wide pixels = product(low_of(right(along, 14)), scale);
        row_q12[j] = held(round_shift_far(pixels, shift), all(T3R_EXTENT_MOST_Q12));
    }
}

/* Computes both rows of T, pixels, Q12. */
static inline T3R_LANES_TARGET void rows_of(const t3r_projection *p, means *m, const by_field *g, lanes a_q12[3],
                                            lanes b_q12[3])
{
    const int32_t *w = p->world_to_camera_q30;
    row_of(w, w + 6, held(m->u_q24, all(p->limit_x_q24)), p->fx_q16, m, g, a_q12);
    row_of(w + 3, w + 6, held(m->v_q24, all(p->limit_y_q24)), p->fy_q16, m, g, b_q12);
}

#endif
