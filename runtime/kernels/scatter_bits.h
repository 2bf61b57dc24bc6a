/* SPDX-License-Identifier: Apache-2.0 */
/* Bit widths of all terms that scattering sums, shared by plain C and the variants (SPEC.md, "Refinement"). */
#ifndef T3R_KERNEL_SCATTER_BITS_H
#define T3R_KERNEL_SCATTER_BITS_H

#include "core/fixed.h"
#include "scatter.h"

#define T3R_X_FRACTION 13  /* bits of x and y: |x| is below 3.4 wherever a weight is not 0, and wraps modulo 8 */
#define T3R_X2_FRACTION 11 /* of their products */
/* The square times a power, rounded by 15 bits, times another power. */
#define T3R_X3_FRACTION (T3R_X_FRACTION + T3R_X2_FRACTION - 15)
#define T3R_X4_FRACTION (2 * T3R_X2_FRACTION - 15)

/* Bits of each pixel's |g|^2, and of the sum over all pixels; likewise of g . r. |x| < 2^14.8 in its fraction, so sums
 * of their products stay below 2^31. */
#define T3R_TERM_BITS 14
#define T3R_TERM_SUM_BITS 16

/* Bound of what one pixel adds, Q7: |g| and |r| are at most 255 sqrt 3 levels, |g| also 255 sqrt 3 times w <=
 * exp(-|e|^2 / 2), and |e|^k exp(-|e|^2 / 2), k <= 2, beside |g| |r| and |e|^k exp(-|e|^2), k <= 4, beside |g|^2 are at
 * most 1. A tile's sums are clamped to this times the pixels of the splat's box there, so that the bound does not
 * depend on roundings. */
#define T3R_MOMENT_MOST_Q7 (195075 * 128)

/* Returns ceil(log2 rows), rows of eight pixels: 0..5. */
static inline uint32_t t3r_count_bits(uint32_t rows)
{
    return rows <= 1 ? 0 : t3r_msb32(rows - 1) + 1;
}

/* Returns the right shift that reduces a number with these bits to `bits` bits. */
static inline uint32_t t3r_shift_to(uint32_t all_bits, uint32_t bits)
{
    const uint32_t has = all_bits == 0 ? 0 : t3r_msb32(all_bits) + 1;
    return has > bits ? has - bits : 0;
}

/* Returns the right shift of terms. all_bits: bitwise or of the sizes of all terms; sum: of the sizes, each without its
 * last 8 bits; rows: of eight pixels. */
static inline uint32_t t3r_term_shift(uint32_t all_bits, uint32_t sum, uint32_t rows)
{
    const uint32_t by_size = t3r_shift_to(all_bits, T3R_TERM_BITS);
    const uint32_t by_sum = t3r_shift_to(sum + rows * T3R_LANES, T3R_TERM_SUM_BITS - 8);
    return T3R_MAX(by_size, by_sum);
}

/* A rounding right shift of 32 bits in two steps, so that adding the half cannot overflow: ((x >> first) + half) >>
 * half. */
typedef struct t3r_shift_steps {
    uint32_t first, half;
} t3r_shift_steps;

static inline t3r_shift_steps t3r_shift_steps_of(uint32_t shift)
{
    return shift == 0 ? (t3r_shift_steps){0, 0} : (t3r_shift_steps){shift - 1, 1};
}

/* Right shifts from the sums to t3r_refine_sums; gradient and curvature of order 0. */
typedef struct t3r_sum_shifts {
    int32_t colour, weight, gradient, curvature;
} t3r_sum_shifts;

static inline t3r_sum_shifts t3r_sum_shifts_of(uint32_t area, uint32_t scale, uint32_t count_bits,
                                               uint32_t square_shift, uint32_t product_shift)
{
    const int32_t fine = (int32_t)(t3r_refine_shift(area) + scale);
    return (t3r_sum_shifts){
        .colour = 8 + fine - (int32_t)count_bits, /* from Q19 to Q11 */
        .weight = fine - (int32_t)count_bits,
        .gradient = 4 + fine - (int32_t)product_shift,                  /* from Q11 to Q7 */
        .curvature = 7 + fine + (int32_t)scale - (int32_t)square_shift, /* from Q14 to Q7, of a square */
    };
}

static inline int32_t t3r_moment_most(uint32_t area, uint32_t pixels)
{
    return t3r_scale32(T3R_MOMENT_MOST_Q7, -(int32_t)t3r_refine_shift(area)) * (int32_t)pixels;
}

/* Adds moments of the orders 0, 1, 2 and so on, with their fraction bits. */
static inline void t3r_add_moments(const uint32_t *moments, uint32_t orders, int32_t right, int32_t most, int32_t *sums)
{
    static const int8_t fraction[] = {0, T3R_X_FRACTION, T3R_X2_FRACTION, T3R_X3_FRACTION, T3R_X4_FRACTION};
    for (uint32_t order = 0, k = 0; order < orders; order++) {
        for (uint32_t i = 0; i <= order; i++, k++) {
            sums[k] += t3r_clamp32(t3r_scale32((int32_t)moments[k], -(right + fraction[order])), -most, most);
        }
    }
}

/* Adds a splat's sums over its pixels: residual colour, weight, and moments modulo 2^32. */
static inline void t3r_add_scattered(const int32_t colour[3], int32_t weight,
                                     const uint32_t gradient[T3R_REFINE_MOMENTS_2],
                                     const uint32_t curvature[T3R_REFINE_MOMENTS_4], const t3r_sum_shifts *by,
                                     int32_t most, t3r_refine_sums *sums)
{
    for (int c = 0; c < 3; c++) {
        sums->colour[c] += t3r_scale32(colour[c], -by->colour);
    }
    sums->weight += t3r_scale32(weight, -by->weight);
    t3r_add_moments(gradient, 3, by->gradient, most, sums->gradient);
    t3r_add_moments(curvature, 5, by->curvature, most, sums->curvature);
}

#endif
