/* SPDX-License-Identifier: Apache-2.0 */
/* Projection of LANES Gaussians at a time, with the steps and bounds of project.c. Where a number of project.c has 64
 * bits but fits 32 for usual Gaussians, it has 32 here; the other Gaussians are marked, and plain C projects them.
 * Included after a header of lanes, in a file that names the function PROJECT. */
#ifndef T3R_KERNELS_LANES_PROJECT_LANES_H
#define T3R_KERNELS_LANES_PROJECT_LANES_H

#include "footprint_lanes.h"
#include "kernels/lanes/vectors/logarithm_lanes.h"

/* Returns x / 2^shift, round-half-up, of non-negative 64 bits if twice the result fits 32 bits; shift 1..63. */
static inline T3R_LANES_TARGET lanes round_shift_positive(wide x, lanes shift)
{
    return OF_LANES(srli_epi32)(add(low_of(right_by(x, widened(subtract(shift, all(1))))), all(1)), 1);
}

/* Returns t3r_log2_wide_q16(), x in 2^15..2^52 - 1: shifts by sevens down to 24 bits or more, which are all that the
 * table reads. */
static inline T3R_LANES_TARGET lanes log_wide_q16(wide x)
{
    const lanes above = low_of(right(x, 31));
    const lanes sevens = add(add(greater(above, all(0)), greater(above, all(127))), greater(above, all(16383)));
    const lanes down = subtract(sevens, OF_LANES(slli_epi32)(sevens, 3));
    return add(log_q16(low_of(right_by(x, widened(down))), 8), OF_LANES(slli_epi32)(down, 16));
}

/* Returns t3r_exp2_q16(). A count beyond 31 gives 0, so one of the two shifts does nothing, or both give the same. */
static inline T3R_LANES_TARGET lanes exp_q16(lanes x_q16)
{
    const lanes index = OF_LANES(srli_epi32)(both(x_q16, all(0xffff)), 9);
    const lanes fraction_q16 = OF_LANES(slli_epi32)(both(x_q16, all(511)), 7);
    const lanes mantissa_q20 = interpolated(t3r_exp2_table_q20, index, fraction_q16);
    const lanes up = subtract(OF_LANES(srai_epi32)(x_q16, 16), all(4)), down = subtract(all(0), up);
    const lanes half = OF_LANES(srli_epi32)(left_each(all(1), down), 1);
    return either(left_each(mantissa_q20, up), right_each(add(mantissa_q20, half), down));
}

/* Returns t3r_log_level_q16() of opacities above 128: 255 times that has 16 to 23 bits, and levels are 5 to 12; eight
 * times the product, or 2^18, is normalised in a few steps. */
static inline T3R_LANES_TARGET lanes log_level_q16(lanes opacity_q15)
{
    const lanes log = subtract(log_q16(multiply(opacity_q15, all(255 << 8)), 4), all(23 << 16));
    const lanes level_q8 = add(low_of(right(unsigned_product(log, all(45426)), 24)), all(16));
    return subtract(log_q16(OF_LANES(slli_epi32)(level_q8, 1 + 18), 4), all(18 << 16));
}

static inline T3R_LANES_TARGET wide dot(const lanes a[3], const lanes b[3])
{
    return sum(sum(product(a[0], b[0]), product(a[1], b[1])), product(a[2], b[2]));
}

/* The inclusive pixels within centre -+ half, clipped to 0..size - 1. Centres beyond 2^18 px are clamped, since no box
 * is as wide. */
typedef struct ranges {
    lanes low, high;
} ranges;

static inline T3R_LANES_TARGET ranges clipped(lanes centre_q12, const lanes row_q12[3], lanes level_q16, uint32_t size)
{
    const wide variance_q24 = sum(dot(row_q12, row_q12), all_wide(T3R_DILATION_Q24));
    const lanes log_half_q16 =
        subtract(OF_LANES(srai_epi32)(add(log_wide_q16(variance_q24), level_q16), 1), all(16 << 16));
    const lanes half_q8 = OF_LANES(srli_epi32)(exp_q16(log_half_q16), 8);
    const lanes half_q12 = OF_LANES(slli_epi32)(add(add(half_q8, OF_LANES(srli_epi32)(half_q8, 10)), all(2)), 4);
    const lanes centre = held(centre_q12, all(1 << 30));
    const lanes first = OF_LANES(srai_epi32)(add(subtract(centre, half_q12), all(4095)), 12);
    return (ranges){OF_LANES(max_epi32)(first, all(0)),
                    OF_LANES(min_epi32)(OF_LANES(srai_epi32)(add(centre, half_q12), 12), all((int32_t)size - 1))};
}

static inline T3R_LANES_TARGET lanes squares(const lanes a[3])
{
    return add(add(multiply(a[0], a[0]), multiply(a[1], a[1])), multiply(a[2], a[2]));
}

/* Returns (x y - z w)^2. The difference is below 2^31 in size, and squaring removes the sign. */
static inline T3R_LANES_TARGET wide squared_minor(lanes x, lanes y, lanes z, lanes w)
{
    const lanes minor = subtract(multiply(x, y), multiply(z, w));
    return product(minor, minor);
}

/* The covariance without its dilation, Q(24 - 2n), and its determinant with dilation, as in conic_of(). */
typedef struct covariances {
    lanes twice; /* 2 n */
    lanes aa, bb, ab;
    lanes determinant, s; /* its 32 bits, times 2^s */
} covariances;

/* Computes the covariances and marks lanes beyond 32 bits. */
static inline T3R_LANES_TARGET covariances covariance_of(const lanes a_q12[3], const lanes b_q12[3], lanes *beyond)
{
    lanes largest = all(0), a[3], b[3], by;
    for (int j = 0; j < 3; j++) {
        largest = OF_LANES(max_epi32)(largest, OF_LANES(abs_epi32)(a_q12[j]));
        largest = OF_LANES(max_epi32)(largest, OF_LANES(abs_epi32)(b_q12[j]));
    }
    /* sizes below 2^14 count as 2^14: n is 0..10 */
    (void)normal_of(OF_LANES(slli_epi32)(OF_LANES(max_epi32)(largest, all(1 << 14)), 6), 8, &by);
    const lanes n = subtract(all(10), by);
    const lanes half = OF_LANES(srli_epi32)(left_each(all(1), n), 1);
    for (int j = 0; j < 3; j++) {
        a[j] = signed_right_each(add(a_q12[j], half), n);
        b[j] = signed_right_each(add(b_q12[j], half), n);
    }
    covariances c;
    c.twice = add(n, n);
    c.aa = squares(a);
    c.bb = squares(b);
    /* with both below 2^31 so is ab, and their sum is below 2^32 */
    *beyond = either(*beyond, either(c.aa, c.bb));
    c.ab = add(add(multiply(a[0], b[0]), multiply(a[1], b[1])), multiply(a[2], b[2]));
    const wide dilations = all_wide((int64_t)T3R_DILATION_Q24 * T3R_DILATION_Q24);
    wide det = right_by(dilations, widened(add(c.twice, c.twice)));
    const wide twice = widened(c.twice), half_unit = right(left_by(all_wide(1), twice), 1);
    const wide trace = unsigned_product(add(c.aa, c.bb), all(T3R_DILATION_Q24));
    det = sum(det, right_by(sum(trace, half_unit), twice));
    det = sum(det, squared_minor(a[0], b[1], a[1], b[0]));
    det = sum(det, squared_minor(a[0], b[2], a[2], b[0]));
    det = sum(det, squared_minor(a[1], b[2], a[2], b[1]));
    const lanes high = high_of(det); /* below 2^31: by Lagrange the squares sum to at most aa bb */
    *beyond = either(*beyond, equal(high, all(0)));
    (void)normal_of(OF_LANES(max_epi32)(high, all(1)), 16, &by);
    c.s = subtract(all(31), by); /* 1..31 */
    c.determinant = low_of(right_by(det, widened(c.s)));
    return c;
}

/* Computes conic_of(); rd = floor(2^62 / determinant). a, c <= 1 / 0.6, and |b| is less: twice that is below 2^32. */
static inline T3R_LANES_TARGET void conic_of(const covariances *c, lanes rd, lanes conic_q30[3])
{
    const lanes half = OF_LANES(srli_epi32)(left_each(all(1), c->twice), 1);
    const lanes dilation = right_each(add(all(T3R_DILATION_Q24), half), c->twice);
    const lanes shift = add(add(c->twice, c->s), all(9));
    conic_q30[0] = round_shift_positive(unsigned_product(add(c->bb, dilation), rd), shift);
    conic_q30[2] = round_shift_positive(unsigned_product(add(c->aa, dilation), rd), shift);
    /* halves of -ab round up: for ab > 0 subtract one before negating */
    const lanes less = OF_LANES(srli_epi32)(greater(c->ab, all(0)), 31);
    const wide size = difference(unsigned_product(OF_LANES(abs_epi32)(c->ab), rd), widened(less));
    const lanes b = round_shift_positive(size, shift), opposite = subtract(all(0), less);
    conic_q30[1] = add(different(b, opposite), less);
}

/* Returns the centre in pixels, Q12, in 32 bits. */
static inline T3R_LANES_TARGET lanes centre_of(lanes tangent_q24, int32_t f_q16, int32_t c_q16)
{
    return low_of(right(sum(product(tangent_q24, all(f_q16)), all_wide((int64_t)c_q16 * (1 << 24) + (1 << 27))), 28));
}

/* Converts ten words of each Gaussian to ten words of its splat; returns a bit for each Gaussian that plain C has to
 * project. */
static inline T3R_LANES_TARGET uint32_t project_lanes(const t3r_projection *p, const lanes gaussians[10],
                                                      lanes splats[10])
{
    const by_field g = fields_of(gaussians);
    lanes a_q12[3], b_q12[3];
    means m = see(p, &g);
    rows_of(p, &m, &g, a_q12, b_q12);
    splats[0] = centre_of(m.u_q24, p->fx_q16, p->cx_q16);
    splats[1] = centre_of(m.v_q24, p->fy_q16, p->cy_q16);
    const lanes level_q16 = log_level_q16(chosen(m.are_seen, g.opacity_q15, all(129)));
    const ranges x = clipped(splats[0], a_q12, level_q16, p->width),
                 y = clipped(splats[1], b_q12, level_q16, p->height);
    const lanes are_out = either(greater(x.low, x.high), greater(y.low, y.high));
    const covariances c = covariance_of(a_q12, b_q12, &m.beyond);
    conic_of(&c, inverted(c.determinant), splats + 2);
    splats[5] = chosen(are_out, all(0), both(m.z_q20, m.are_seen));
    splats[6] = gaussians[8];
    splats[7] = gaussians[9];
    splats[8] = either(x.low, OF_LANES(slli_epi32)(y.low, 16));
    splats[9] = either(x.high, OF_LANES(slli_epi32)(y.high, 16));
    return signs_of(m.beyond);
}

static void project_scalar(const t3r_projection *p, const t3r_gaussian *g, t3r_splat *splat)
{
    if (!t3r_project(p, g, splat)) {
        splat->z_q20 = 0;
    }
}

_Static_assert(offsetof(t3r_splat, a_q30) == 8 && offsetof(t3r_splat, z_q20) == 20 &&
                   offsetof(t3r_splat, colour_q7) == 24 && offsetof(t3r_splat, opacity_q15) == 30 &&
                   offsetof(t3r_splat, x0) == 32 && offsetof(t3r_splat, y0) == 34 && offsetof(t3r_splat, x1) == 36,
               "a splat's ten words: centre, conic, depth, colours and opacity, box");

/* Projects LANES Gaussians; returns the bits of project_lanes(). */
static __attribute__((noinline)) T3R_LANES_TARGET uint32_t project_batch(const t3r_projection *p,
                                                                         const t3r_gaussian *gaussians,
                                                                         t3r_splat *splats)
{
    uint8_t *to[LANES];
    lanes in[10], out[10];
    T3R_LANES_UNROLL for (int i = 0; i < LANES; i++)
    {
        to[i] = (uint8_t *)&splats[i];
    }
    read_gaussians(gaussians, in);
    const uint32_t beyond = project_lanes(p, in, out);
    write_four(out, to, 0);
    write_four(out + 4, to, 16);
    write_two(out + 8, to, 32);
    return beyond;
}

void PROJECT(const t3r_projection *p, const t3r_gaussian *gaussians, uint32_t count, t3r_splat *splats)
{
    uint32_t i = 0;
    for (; i + LANES <= count; i += LANES) {
        for (uint32_t beyond = project_batch(p, gaussians + i, splats + i); beyond != 0; beyond &= beyond - 1) {
            const uint32_t lane = i + (uint32_t)__builtin_ctz(beyond);
            project_scalar(p, &gaussians[lane], &splats[lane]);
        }
    }
    for (; i < count; i++) {
        project_scalar(p, &gaussians[i], &splats[i]);
    }
}

#endif
