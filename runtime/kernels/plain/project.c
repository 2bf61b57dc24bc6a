/* SPDX-License-Identifier: Apache-2.0 */
/* EWA projection of 3-D covariances (Zwicker et al. 2001, "EWA volume splatting"), with the Jacobian clamped at 1.3
 * times the picture's farther edge and the 0.3 px^2 dilation of 3D Gaussian Splatting (Kerbl et al. 2023). */
#include "kernels/project.h"

#include "core/fixed.h"
#include "kernels/project_parts.h"

/* Computes one row of T = J W F in pixels, Q12: (f / z) (w - tangent w2) F, with tangent = x / z or y / z. */
static void footprint_row(const int32_t *w, const int32_t *w2, int32_t tangent_q24, int32_t f_q16,
                          t3r_reciprocal inverse, const t3r_gaussian *g, int32_t row_q12[3])
{
    int32_t r_q24[3]; /* |w| <= 1 and |tangent| <= 16: below 2^29 */
    for (int i = 0; i < 3; i++) {
        int64_t along = t3r_round_shift64((int64_t)tangent_q24 * w2[i], 24);
        r_q24[i] = (int32_t)t3r_round_shift64(w[i] - along, 6);
    }
    /* f / z = scale 2^(lz - 28): scale in [2^19, 2^31] */
    int64_t scale = t3r_round_shift64((int64_t)f_q16 * inverse.rn, 30);
    int32_t shift = g->factor_exponent + inverse.lz - 26;
    for (int j = 0; j < 3; j++) {
        /* 3 x 2^29 x 2^15 < 2^46; less 14 bits, times scale: below 2^63 */
        int64_t sum = (int64_t)r_q24[0] * g->factor[j] + (int64_t)r_q24[1] * g->factor[3 + j] +
                      (int64_t)r_q24[2] * g->factor[6 + j];
        int64_t pixels = t3r_round_shift64(sum, 14) * scale;
        if (shift > 0) {
            pixels = t3r_clamp64(pixels, -((int64_t)1 << 40), (int64_t)1 << 40);
        }
        row_q12[j] = (int32_t)t3r_clamp64(t3r_scale64(pixels, shift), -T3R_EXTENT_MOST_Q12, T3R_EXTENT_MOST_Q12);
    }
}

/* Returns value / 2^n, for n of either sign, clamped to int32. */
static int32_t to_q30(int64_t value, int32_t right)
{
    return (int32_t)t3r_clamp64(t3r_scale64(value, -right), -INT32_MAX, INT32_MAX);
}

/* Computes the conic of the 2 x 2 covariance T T^T + 0.3 I. The determinant is a sum of squares (Cauchy-Binet), so that
 * needles lose nothing to cancellation:
 *   det = sum of squared 2 x 2 minors of T + 0.3 trace(T T^T) + 0.09 */
static void conic_of(const int32_t a_q12[3], const int32_t b_q12[3], t3r_splat *splat)
{
    int32_t most = 1;
    for (int j = 0; j < 3; j++) {
        most = T3R_MAX(most, T3R_MAX(t3r_abs32(a_q12[j]), t3r_abs32(b_q12[j])));
    }
    int32_t n = T3R_MAX(0, (int32_t)t3r_msb32((uint32_t)most) - 14); /* 0..10 */
    int64_t a[3], b[3];                                              /* at most 2^15 */
    for (int j = 0; j < 3; j++) {
        a[j] = t3r_round_shift32(a_q12[j], (uint32_t)n);
        b[j] = t3r_round_shift32(b_q12[j], (uint32_t)n);
    }
    int64_t m01 = a[0] * b[1] - a[1] * b[0];
    int64_t m02 = a[0] * b[2] - a[2] * b[0];
    int64_t m12 = a[1] * b[2] - a[2] * b[1];
    int64_t aa = a[0] * a[0] + a[1] * a[1] + a[2] * a[2]; /* Q(24 - 2n), at most 3 x 2^30 */
    int64_t bb = b[0] * b[0] + b[1] * b[1] + b[2] * b[2];
    int64_t ab = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    /* Q(48 - 4n). |m| <= 2^31; by Lagrange the three squares sum to at most aa bb <= 9 x 2^60, the trace's term to
     * 6 x 2^30 x 2^23 and the constant to 2^45: below 2^64. */
    uint64_t det = (uint64_t)(m01 * m01) + (uint64_t)(m02 * m02) + (uint64_t)(m12 * m12) +
                   (uint64_t)t3r_round_shift64((aa + bb) * T3R_DILATION_Q24, (uint32_t)(2 * n)) +
                   ((((uint64_t)T3R_DILATION_Q24 * T3R_DILATION_Q24) >> (4 * n)));
    const t3r_inverse_determinant inverse = t3r_invert_determinant(det);
    const int64_t rd = inverse.rd;
    int64_t dilation = t3r_round_shift64(T3R_DILATION_Q24, (uint32_t)(2 * n));
    /* (aa + dilation) <= 2^31.6 and rd <= 2^31: the products stay below 2^63 */
    int32_t right = 9 + 2 * n + inverse.s;
    splat->a_q30 = to_q30((bb + dilation) * rd, right);
    splat->b_q30 = to_q30(-ab * rd, right);
    splat->c_q30 = to_q30((aa + dilation) * rd, right);
}

static int64_t half_width_q8(const int32_t row_q12[3], int32_t log_level_q16)
{
    int64_t variance_q24 = T3R_DILATION_Q24;
    for (int j = 0; j < 3; j++) {
        variance_q24 += (int64_t)row_q12[j] * row_q12[j]; /* at most 3 x 2^48 */
    }
    return t3r_half_width_q8((uint64_t)variance_q24, log_level_q16);
}

/* Computes the inclusive pixels within centre -+ half, clipped to 0..size - 1. Returns false if there are none. */
static bool clip_range(int32_t centre_q12, int64_t half_q8, uint32_t size, uint16_t *low, uint16_t *high)
{
    int64_t half_q12 = half_q8 << 4;
    int64_t first = (centre_q12 - half_q12 + 4095) >> 12;
    int64_t last = (centre_q12 + half_q12) >> 12;
    first = T3R_MAX(first, 0);
    last = T3R_MIN(last, (int64_t)size - 1);
    if (first > last) {
        return false;
    }
    *low = (uint16_t)first;
    *high = (uint16_t)last;
    return true;
}

/* A Gaussian's mean in camera coordinates. */
typedef struct seen_mean {
    int64_t z_q20; /* in (T3R_NEAR_Q20, 2^31) */
    t3r_reciprocal inverse;
    int64_t u_q24, v_q24; /* x / z and y / z, at most 16 and 2^-23 */
} seen_mean;

/* Computes the mean in camera coordinates. Returns false when it is culled. */
static bool see(const t3r_projection *p, const t3r_gaussian *g, seen_mean *seen)
{
    int64_t d[3]; /* positions and centres are within 2^30: below 2^31 */
    for (int i = 0; i < 3; i++) {
        d[i] = (int64_t)g->position_q20[i] - p->centre_q20[i];
    }
    int64_t c[3]; /* camera coordinates, Q20: |d| < 2^31.8 and the rows have norm 1 */
    for (int i = 0; i < 3; i++) {
        const int32_t *w = p->world_to_camera_q30 + 3 * i;
        c[i] = t3r_round_shift64(w[0] * d[0] + w[1] * d[1] + w[2] * d[2], 30);
    }
    if (c[2] <= T3R_NEAR_Q20 || c[2] > INT32_MAX || t3r_abs64(c[0]) > T3R_ASIDE * c[2] ||
        t3r_abs64(c[1]) > T3R_ASIDE * c[2]) {
        return false;
    }
    seen->z_q20 = c[2];
    seen->inverse = t3r_invert((uint32_t)c[2]);
    /* x / z in Q24: |c| < 2^31.8 times rn <= 2^31 stays below 2^63 */
    seen->u_q24 = t3r_round_shift64(c[0] * seen->inverse.rn, (uint32_t)(38 - seen->inverse.lz));
    seen->v_q24 = t3r_round_shift64(c[1] * seen->inverse.rn, (uint32_t)(38 - seen->inverse.lz));
    return true;
}

/* Computes both rows of T, pixels, Q12. */
static void footprint(const t3r_projection *p, const t3r_gaussian *g, const seen_mean *seen, int32_t a_q12[3],
                      int32_t b_q12[3])
{
    const int32_t *w = p->world_to_camera_q30;
    int32_t hold_u = (int32_t)t3r_clamp64(seen->u_q24, -p->limit_x_q24, p->limit_x_q24);
    int32_t hold_v = (int32_t)t3r_clamp64(seen->v_q24, -p->limit_y_q24, p->limit_y_q24);
    footprint_row(w, w + 6, hold_u, p->fx_q16, seen->inverse, g, a_q12);
    footprint_row(w + 3, w + 6, hold_v, p->fy_q16, seen->inverse, g, b_q12);
}

bool t3r_footprint_rows(const t3r_projection *p, const t3r_gaussian *g, int32_t a_q12[3], int32_t b_q12[3])
{
    seen_mean seen;
    if (!see(p, g, &seen)) {
        return false;
    }
    footprint(p, g, &seen, a_q12, b_q12);
    return true;
}

bool t3r_project(const t3r_projection *p, const t3r_gaussian *g, t3r_splat *splat)
{
    seen_mean seen;
    if (g->opacity_q15 <= 128 || !see(p, g, &seen)) { /* below 1/255 everywhere, or not seen */
        return false;
    }
    /* |u| <= 16 + 2^-23 and f < 2^30: below 2^59 */
    int64_t x_q12 = t3r_round_shift64(seen.u_q24 * p->fx_q16 + (int64_t)p->cx_q16 * (1 << 24), 28);
    int64_t y_q12 = t3r_round_shift64(seen.v_q24 * p->fy_q16 + (int64_t)p->cy_q16 * (1 << 24), 28);
    int32_t a_q12[3], b_q12[3];
    footprint(p, g, &seen, a_q12, b_q12);

    const int32_t log_level_q16 = t3r_log_level_q16(g->opacity_q15);
    splat->x_q12 = (int32_t)x_q12;
    splat->y_q12 = (int32_t)y_q12;
    if (!clip_range(splat->x_q12, half_width_q8(a_q12, log_level_q16), p->width, &splat->x0, &splat->x1) ||
        !clip_range(splat->y_q12, half_width_q8(b_q12, log_level_q16), p->height, &splat->y0, &splat->y1)) {
        return false;
    }
    conic_of(a_q12, b_q12, splat);
    splat->z_q20 = (int32_t)seen.z_q20;
    for (int i = 0; i < 3; i++) {
        splat->colour_q7[i] = g->colour_q7[i];
    }
    splat->opacity_q15 = g->opacity_q15;
    return true;
}

void t3r_project_c(const t3r_projection *p, const t3r_gaussian *gaussians, uint32_t count, t3r_splat *splats)
{
    for (uint32_t i = 0; i < count; i++) {
        if (!t3r_project(p, &gaussians[i], &splats[i])) {
            splats[i].z_q20 = 0;
        }
    }
}
