/* Projection of eight Gaussians at a time, in 64-bit lanes: project.c step by step, with its bounds. What has no vector
 * instruction (divisions, logarithms) is done lane by lane. */
#include "variants.h"

#ifdef T3R_X86

#include "core/fixed.h"
#include "intrinsics.h"
#include "kernels/project_parts.h"

#define LANES 8

typedef int64_t lanes __attribute__((vector_size(LANES * sizeof(int64_t))));

/* b where the mask has ones, else a */
static inline T3R_AVX512 lanes chosen(lanes mask, lanes b, lanes a)
{
    return (lanes)_mm512_mask_blend_epi64(_mm512_movepi64_mask((__m512i)mask), (__m512i)a, (__m512i)b);
}

static inline T3R_AVX512 lanes least(lanes a, lanes b)
{
    return (lanes)_mm512_min_epi64((__m512i)a, (__m512i)b);
}

static inline T3R_AVX512 lanes most(lanes a, lanes b)
{
    return (lanes)_mm512_max_epi64((__m512i)a, (__m512i)b);
}

static inline T3R_AVX512 lanes magnitude(lanes x)
{
    return (lanes)_mm512_abs_epi64((__m512i)x);
}

/* |x| at most `bound` */
static inline T3R_AVX512 lanes held(lanes x, lanes bound)
{
    return most(least(x, bound), -bound);
}

/* t3r_round_shift64() */
static inline T3R_AVX512 lanes round_shift(lanes x, lanes shift)
{
    const lanes one = (lanes){0} + 1;
    return (x + ((one << shift) >> 1)) >> shift;
}

/* t3r_scale64() */
static inline T3R_AVX512 lanes scaled(lanes x, lanes shift)
{
    const lanes none = {0}, right = least(-shift, none + 62);
    const lanes down = round_shift(x, most(right, none)) & (shift > -63);
    return chosen(shift >= 0, x << most(shift, none), down);
}

/* Eight Gaussians by field; behind the last, it again. */
typedef struct eight {
    lanes position[3], factor[9], exponent, opacity;
} eight;

static inline T3R_AVX512 void take(const t3r_gaussian *gaussians, uint32_t count, eight *e)
{
    for (uint32_t i = 0; i < LANES; i++) {
        const t3r_gaussian *g = &gaussians[i < count ? i : count - 1];
        for (uint32_t k = 0; k < 3; k++) {
            e->position[k][i] = g->position_q20[k];
        }
        for (uint32_t k = 0; k < 9; k++) {
            e->factor[k][i] = g->factor[k];
        }
        e->exponent[i] = g->factor_exponent;
        e->opacity[i] = g->opacity_q15;
    }
}

/* Means before the camera, and whether they are seen; of those that are not, some that harms no step. */
typedef struct means {
    lanes z_q20, rn, lz, u_q24, v_q24, are_seen;
} means;

static inline T3R_AVX512 means see(const t3r_projection *p, const eight *e)
{
    const lanes none = {0};
    lanes c[3];
    for (uint32_t i = 0; i < 3; i++) {
        const int32_t *w = p->world_to_camera_q30 + 3 * i;
        lanes sum = none;
        for (uint32_t k = 0; k < 3; k++) {
            sum += (e->position[k] - p->centre_q20[k]) * w[k];
        }
        c[i] = round_shift(sum, none + 30);
    }
    means m;
    m.are_seen = (c[2] > T3R_NEAR_Q20) & (c[2] <= INT32_MAX) & (magnitude(c[0]) <= c[2] * T3R_ASIDE) &
                 (magnitude(c[1]) <= c[2] * T3R_ASIDE) & (e->opacity > 128);
    m.z_q20 = chosen(m.are_seen, c[2], none + (1 << 20));
    for (uint32_t i = 0; i < LANES; i++) {
        const t3r_reciprocal inverse = t3r_invert((uint32_t)m.z_q20[i]);
        m.rn[i] = inverse.rn;
        m.lz[i] = inverse.lz;
    }
    m.u_q24 = round_shift((c[0] & m.are_seen) * m.rn, 38 - m.lz);
    m.v_q24 = round_shift((c[1] & m.are_seen) * m.rn, 38 - m.lz);
    return m;
}

/* footprint_row() */
static inline T3R_AVX512 void row_of(const int32_t *w, const int32_t *w2, lanes tangent_q24, int32_t f_q16,
                                     const means *m, const eight *e, lanes row_q12[3])
{
    const lanes none = {0};
    lanes r_q24[3];
    for (uint32_t i = 0; i < 3; i++) {
        r_q24[i] = round_shift(w[i] - round_shift(tangent_q24 * w2[i], none + 24), none + 6);
    }
    const lanes scale = round_shift(m->rn * f_q16, none + 30), shift = e->exponent + m->lz - 26;
    for (uint32_t j = 0; j < 3; j++) {
        const lanes sum = r_q24[0] * e->factor[j] + r_q24[1] * e->factor[3 + j] + r_q24[2] * e->factor[6 + j];
        lanes pixels = round_shift(sum, none + 14) * scale;
        pixels = chosen(shift > 0, held(pixels, none + ((int64_t)1 << 40)), pixels);
        row_q12[j] = held(scaled(pixels, shift), none + T3R_EXTENT_MOST_Q12);
    }
}

typedef struct conics {
    lanes a_q30, b_q30, c_q30;
} conics;

static inline T3R_AVX512 lanes dot(const lanes a[3], const lanes b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* conic_of(). The determinant is modulo 2^64. */
static inline T3R_AVX512 conics conics_of(const lanes a_q12[3], const lanes b_q12[3])
{
    const lanes none = {0};
    lanes largest = none + 1, n, s, rd, a[3], b[3];
    for (uint32_t j = 0; j < 3; j++) {
        largest = most(largest, most(magnitude(a_q12[j]), magnitude(b_q12[j])));
    }
    for (uint32_t i = 0; i < LANES; i++) {
        n[i] = T3R_MAX(0, (int32_t)t3r_msb32((uint32_t)largest[i]) - 14);
    }
    for (uint32_t j = 0; j < 3; j++) {
        a[j] = round_shift(a_q12[j], n);
        b[j] = round_shift(b_q12[j], n);
    }
    const lanes m01 = a[0] * b[1] - a[1] * b[0], m02 = a[0] * b[2] - a[2] * b[0], m12 = a[1] * b[2] - a[2] * b[1];
    const lanes aa = dot(a, a), bb = dot(b, b), ab = dot(a, b);
    const lanes det = m01 * m01 + m02 * m02 + m12 * m12 + round_shift((aa + bb) * T3R_DILATION_Q24, 2 * n) +
                      ((none + (int64_t)T3R_DILATION_Q24 * T3R_DILATION_Q24) >> (4 * n));
    for (uint32_t i = 0; i < LANES; i++) {
        const t3r_inverse_determinant inverse = t3r_invert_determinant((uint64_t)det[i]);
        s[i] = inverse.s;
        rd[i] = inverse.rd;
    }
    const lanes dilation = round_shift(none + T3R_DILATION_Q24, 2 * n), right = 9 + 2 * n + s;
    const lanes bound = none + INT32_MAX;
    return (conics){held(scaled((bb + dilation) * rd, -right), bound), held(scaled(-ab * rd, -right), bound),
                    held(scaled((aa + dilation) * rd, -right), bound)};
}

/* The inclusive pixels within centre -+ half, clipped to 0..size - 1. */
typedef struct ranges {
    lanes low, high;
} ranges;

static inline T3R_AVX512 ranges clipped(lanes centre_q12, const lanes row_q12[3], lanes log_level_q16, uint32_t size)
{
    const lanes none = {0}, variance_q24 = dot(row_q12, row_q12) + T3R_DILATION_Q24;
    lanes half_q12;
    for (uint32_t i = 0; i < LANES; i++) {
        half_q12[i] = t3r_half_width_q8((uint64_t)variance_q24[i], (int32_t)log_level_q16[i]) << 4;
    }
    return (ranges){most((centre_q12 - half_q12 + 4095) >> 12, none),
                    least((centre_q12 + half_q12) >> 12, none + ((int64_t)size - 1))};
}

/* The centre in pixels, Q12, as 32 bits hold it. */
static inline T3R_AVX512 lanes centre_of(lanes tangent_q24, int32_t f_q16, int32_t c_q16)
{
    const lanes none = {0};
    return round_shift(tangent_q24 * f_q16 + (int64_t)c_q16 * (1 << 24), none + 28) << 32 >> 32;
}

static __attribute__((noinline)) T3R_AVX512 void project_eight(const t3r_projection *p, const t3r_gaussian *gaussians,
                                                               uint32_t count, t3r_splat *splats)
{
    const int32_t *w = p->world_to_camera_q30;
    const lanes none = {0};
    lanes a_q12[3], b_q12[3], log_level_q16;
    eight e;
    take(gaussians, count, &e);
    const means m = see(p, &e);
    const lanes x_q12 = centre_of(m.u_q24, p->fx_q16, p->cx_q16), y_q12 = centre_of(m.v_q24, p->fy_q16, p->cy_q16);
    row_of(w, w + 6, held(m.u_q24, none + p->limit_x_q24), p->fx_q16, &m, &e, a_q12);
    row_of(w + 3, w + 6, held(m.v_q24, none + p->limit_y_q24), p->fy_q16, &m, &e, b_q12);
    for (uint32_t i = 0; i < LANES; i++) {
        log_level_q16[i] = t3r_log_level_q16(m.are_seen[i] != 0 ? (uint32_t)e.opacity[i] : 1u);
    }
    const ranges x = clipped(x_q12, a_q12, log_level_q16, p->width);
    const ranges y = clipped(y_q12, b_q12, log_level_q16, p->height);
    const lanes are_drawn = m.are_seen & (x.low <= x.high) & (y.low <= y.high);
    const conics c = conics_of(a_q12, b_q12);
    for (uint32_t i = 0; i < count; i++) {
        t3r_splat *s = &splats[i];
        const t3r_gaussian *g = &gaussians[i];
        s->z_q20 = are_drawn[i] != 0 ? (int32_t)m.z_q20[i] : 0;
        s->x_q12 = (int32_t)x_q12[i];
        s->y_q12 = (int32_t)y_q12[i];
        s->a_q30 = (int32_t)c.a_q30[i];
        s->b_q30 = (int32_t)c.b_q30[i];
        s->c_q30 = (int32_t)c.c_q30[i];
        for (uint32_t k = 0; k < 3; k++) {
            s->colour_q7[k] = g->colour_q7[k];
        }
        s->opacity_q15 = g->opacity_q15;
        s->x0 = (uint16_t)x.low[i];
        s->x1 = (uint16_t)x.high[i];
        s->y0 = (uint16_t)y.low[i];
        s->y1 = (uint16_t)y.high[i];
    }
}

void t3r_project_avx512(const t3r_projection *p, const t3r_gaussian *gaussians, uint32_t count, t3r_splat *splats)
{
    for (uint32_t i = 0; i < count; i += LANES) {
        project_eight(p, gaussians + i, T3R_MIN(count - i, (uint32_t)LANES), splats + i);
    }
}

#else
typedef int t3r_no_project_avx512; /* a file may not be empty */
#endif
