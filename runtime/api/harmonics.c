/* SPDX-License-Identifier: Apache-2.0 */
/* Colours that depend on the direction of view (SPEC, "Harmonics"). */
#include "api/checks.h"
#include "core/fixed.h"
#include "trim3r.h"

#define UNIT_BITS 24u /* fraction bits of directions and harmonics */

/* The constants of the harmonics, in Q24: 0.2820947918 ... 1.4453057213. */
enum {
    C00 = 4732765,
    C10 = 8197390,
    C20 = 18329921,
    C21 = 5291392,
    C22 = 9164961,
    C30 = 9899289,
    C31 = 48496413,
    C32 = 7667956,
    C33 = 6260860,
    C34 = 24248206
};

/* Returns (a b) / 2^24; |a| and |b| at most 2^27. */
static int32_t multiply_q24(int32_t a, int32_t b)
{
    return (int32_t)t3r_round_shift64((int64_t)a * b, UNIT_BITS);
}

/* Scales the vector to unit length, each entry at most 2^24; all 0 for a vector of length 0. */
static void normalise_q24(const int32_t direction[3], int32_t unit_q24[3])
{
    uint64_t square = 0;
    for (int i = 0; i < 3; i++) {
        const int64_t d = direction[i];
        square += (uint64_t)(d * d); /* at most 2^62 each: the sum of three is below 2^64 */
    }
    if (square == 0) {
        unit_q24[0] = unit_q24[1] = unit_q24[2] = 0;
        return;
    }
    /* short vectors are lengthened, so that the root has at least 30 bits */
    const uint32_t shift = (63 - t3r_msb64(square)) / 2;
    const int64_t length = t3r_isqrt64(square << (2 * shift));
    for (int i = 0; i < 3; i++) {
        /* below 2^32 before and 2^56 after the shift */
        const int64_t lengthened = (int64_t)((uint64_t)(int64_t)direction[i] << shift);
        unit_q24[i] = (int32_t)t3r_round_div64((int64_t)((uint64_t)lengthened << UNIT_BITS), length);
    }
}

/* Computes the harmonics of degree 0 to 3, in the order and with the signs of SPEC; all below 2^25. */
static void evaluate_q24(const int32_t unit_q24[3], uint32_t degree, int32_t values_q24[T3R_HARMONICS_MOST])
{
    const int32_t x = unit_q24[0], y = unit_q24[1], z = unit_q24[2];
    values_q24[0] = C00;
    if (degree >= 1) {
        values_q24[1] = -multiply_q24(C10, y);
        values_q24[2] = multiply_q24(C10, z);
        values_q24[3] = -multiply_q24(C10, x);
    }
    if (degree < 2) {
        return;
    }
    const int32_t xx = multiply_q24(x, x), yy = multiply_q24(y, y), zz = multiply_q24(z, z);
    const int32_t xy = multiply_q24(x, y), yz = multiply_q24(y, z), xz = multiply_q24(x, z);
    values_q24[4] = multiply_q24(C20, xy);
    values_q24[5] = -multiply_q24(C20, yz);
    values_q24[6] = multiply_q24(C21, 2 * zz - xx - yy);
    values_q24[7] = -multiply_q24(C20, xz);
    values_q24[8] = multiply_q24(C22, xx - yy);
    if (degree < 3) {
        return;
    }
    values_q24[9] = -multiply_q24(C30, multiply_q24(y, 3 * xx - yy));
    values_q24[10] = multiply_q24(C31, multiply_q24(xy, z));
    values_q24[11] = -multiply_q24(C32, multiply_q24(y, 4 * zz - xx - yy));
    values_q24[12] = multiply_q24(C33, multiply_q24(z, 2 * zz - 3 * xx - 3 * yy));
    values_q24[13] = -multiply_q24(C32, multiply_q24(x, 4 * zz - xx - yy));
    values_q24[14] = multiply_q24(C34, multiply_q24(z, xx - yy));
    values_q24[15] = -multiply_q24(C30, multiply_q24(x, xx - 3 * yy));
}

t3r_status t3r_harmonics_colour(const int16_t *coefficients_q12, uint32_t degree, const int32_t direction[3],
                                uint16_t colour_q7[3])
{
    T3R_REFUSE_UNLESS(coefficients_q12 != NULL && direction != NULL && colour_q7 != NULL, T3R_ERR_ARGUMENT);
    if (degree > T3R_HARMONICS_DEGREE_MOST) {
        return T3R_ERR_ARGUMENT;
    }
    int32_t unit_q24[3], values_q24[T3R_HARMONICS_MOST];
    normalise_q24(direction, unit_q24);
    /* a vector of length 0 shows the mean over all directions */
    const uint32_t seen = unit_q24[0] == 0 && unit_q24[1] == 0 && unit_q24[2] == 0 ? 0 : degree;
    evaluate_q24(unit_q24, seen, values_q24);
    for (uint32_t channel = 0; channel < 3; channel++) {
        int64_t sum_q36 = 0; /* 16 products below 2^15 x 2^25: below 2^44 */
        for (uint32_t i = 0; i < (seen + 1) * (seen + 1); i++) {
            sum_q36 += (int64_t)coefficients_q12[3 * i + channel] * values_q24[i];
        }
        /* 255 levels in Q7: 32640; the product is below 2^59 */
        const int64_t colour = t3r_round_shift64(sum_q36 * 32640, 36) + 16320;
        colour_q7[channel] = (uint16_t)t3r_clamp64(colour, 0, 32640);
    }
    return T3R_OK;
}
