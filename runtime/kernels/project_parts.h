/* Scalar parts of projection, shared by projecting one Gaussian and several (project.c). */
#ifndef T3R_KERNEL_PROJECT_PARTS_H
#define T3R_KERNEL_PROJECT_PARTS_H

#include "core/fixed.h"
#include "project.h"

#define T3R_EXTENT_MOST_Q12 (1 << 24) /* bound of a footprint column: 4096 px */

/* 1 / z as rn 2^(lz - 62), rn in (2^30, 2^31] */
typedef struct t3r_reciprocal {
    int64_t rn;
    int32_t lz;
} t3r_reciprocal;

static inline t3r_reciprocal t3r_invert(uint32_t z)
{
    int32_t lz = 31 - (int32_t)t3r_msb32(z);
    uint32_t normal = z << lz;
    return (t3r_reciprocal){(int64_t)((UINT64_C(1) << 62) / normal), lz};
}

/* The determinant of a covariance = normal 2^s, and 1 / it = rd 2^(-62 - s). */
typedef struct t3r_inverse_determinant {
    int64_t rd;
    int32_t s;
} t3r_inverse_determinant;

static inline t3r_inverse_determinant t3r_invert_determinant(uint64_t det)
{
    int32_t s = (int32_t)t3r_msb64(det) - 31;
    uint32_t normal = (uint32_t)(s >= 0 ? det >> s : det << -s);
    return (t3r_inverse_determinant){(int64_t)((UINT64_C(1) << 62) / normal), s};
}

/* log2 of 2 L in Q8, L = ln 2 (log2(255 opacity_q15) - 15), Q8; ln 2 = 45426 / 65536; 16 / 256 of margin */
static inline int32_t t3r_log_level_q16(uint32_t opacity_q15)
{
    int64_t level_q8 = ((((int64_t)t3r_log2_q16(255u * opacity_q15) - (15 << 16)) * 45426) >> 24) + 16;
    return t3r_log2_q16((uint32_t)(2 * T3R_MAX(level_q8, 16)));
}

/* Returns the half-width in pixels, Q8, of the box outside of which opacity exp(-q) < 1/255: sqrt(2 L variance), by
 * logarithms, with more than their error (2^-13 of it) added. */
static inline int64_t t3r_half_width_q8(uint64_t variance_q24, int32_t log_level_q16)
{
    /* Q24 times Q8 is Q32, whose root is Q16; below 2^15 px */
    int32_t log_half_q16 = ((t3r_log2_wide_q16(variance_q24) + log_level_q16) >> 1) - (16 << 16);
    uint32_t half_q8 = t3r_exp2_q16(log_half_q16) >> 8;
    return (int64_t)half_q8 + (half_q8 >> 10) + 2;
}

#endif
