/* SPDX-License-Identifier: Apache-2.0 */
/* Blending, eight pixels at a time, in vectors of Helium. */
#include "variants.h"

#ifdef T3R_MVE

#include <arm_mve.h>

#include "core/alpha.h"
#include "core/memory.h"

/* T3R_ALPHA_RANGE - q / 8, times 16, plus half for rounding, in the even and the odd columns; its change from row to
 * row, and the change of that change. Modulo 2^32, like plain C's sums without overflow. */
typedef struct quadratic {
    uint32x4_t left[2], step[2];
    uint32_t bend;
} quadratic;

static inline quadratic quadratic_of(const t3r_tile_splat *s, uint32_t group)
{
    const uint32_t row = s->first, a = (uint32_t)s->a, b = (uint32_t)s->b, c = (uint32_t)s->c;
    const uint32_t gx = (uint32_t)s->group[group].gx, gy = (uint32_t)s->group[group].gy;
    const uint32_t at = 16 * T3R_ALPHA_RANGE - 1 - (uint32_t)s->group[group].q - row * (gy + row * c);
    quadratic q = {.bend = 2 * c};
    for (uint32_t k = 0; k < 2; k++) {
        const uint32x4_t i = vidupq_n_u32(k, 2);
        const uint32x4_t slope = vaddq_n_u32(vmulq_n_u32(i, a), gx + row * b);
        q.left[k] = vsubq_u32(vdupq_n_u32(at), vmulq_u32(i, slope));
        q.step[k] = vaddq_n_u32(vmulq_n_u32(i, b), gy + (2 * row + 1) * c);
    }
    return q;
}

static inline uint16x8_t alpha_of(const quadratic *q, uint16_t opacity_q16)
{
    uint16x8_t s = vqrshrunbq_n_s32(vdupq_n_u16(0), vreinterpretq_s32_u32(q->left[0]), 4);
    s = vminq_u16(vqrshruntq_n_s32(s, vreinterpretq_s32_u32(q->left[1]), 4), vdupq_n_u16(T3R_ALPHA_RANGE));
    uint16x8_t p = vaddq_n_u16(vmulhq_u16(s, vdupq_n_u16(T3R_ALPHA_C4)), T3R_ALPHA_C3);
    p = vaddq_n_u16(vmulhq_u16(s, p), T3R_ALPHA_C2);
    p = vaddq_n_u16(vmulhq_u16(s, p), T3R_ALPHA_C1);
    p = vaddq_n_u16(vmulhq_u16(s, p), T3R_ALPHA_C0);
    p = vmulhq_u16(p, p);
    p = vmulhq_u16(p, p);
    p = vmulhq_u16(p, p);
    return vminq_u16(vmulhq_u16(p, vdupq_n_u16(opacity_q16)), vdupq_n_u16(T3R_ALPHA_MOST_Q16));
}

static inline void add_colour(uint16_t *to, uint16x8_t weight, uint16_t colour_q7)
{
    vst1q_u16(to, vaddq_u16(vld1q_u16(to), vrmulhq_u16(weight, vdupq_n_u16(colour_q7))));
}

/* rows: where blended rows are kept, or NULL; constant once inlined. Returns the bitwise or of the kept weights. */
static inline __attribute__((always_inline)) uint16x8_t
blend_group(t3r_tile *restrict tile, const t3r_tile_splat *splat, uint32_t group, t3r_blended_row *restrict rows)
{
    const uint32_t first = splat->first * T3R_TILE_SIDE + splat->column + group * T3R_LANES;
    uint16_t *transmittance = &tile->transmittance_q16[0][0] + first, *red = &tile->colour_q7[0][0][0] + first;
    const uint16_t opacity = splat->opacity_q16, r = splat->colour_q7[0], g = splat->colour_q7[1];
    const uint16_t b = splat->colour_q7[2];
    enum { PLANE = T3R_TILE_SIDE * T3R_TILE_SIDE };
    quadratic q = quadratic_of(splat, group);
    uint16x8_t any = vdupq_n_u16(0);
    for (uint32_t row = splat->first; row <= splat->last; row++) {
        const uint16x8_t t = vld1q_u16(transmittance), alpha = alpha_of(&q, opacity);
        const mve_pred16_t drawn = vcmpcsq_m_n_u16(t, T3R_STOP_Q16, vcmpcsq_n_u16(alpha, T3R_ALPHA_LEAST_Q16));
        const uint16x8_t w = vpselq_u16(vrmulhq_u16(t, alpha), vdupq_n_u16(0), drawn);
        vst1q_u16(transmittance, vsubq_u16(t, w));
        add_colour(red, w, r);
        add_colour(red + PLANE, w, g);
        add_colour(red + 2 * PLANE, w, b);
        if (rows != NULL) {
            const uint16x8_t none = vdupq_n_u16(0);
            vst1q_u16(rows->weight_q16, w);
            vst1q_s16(rows->alpha_q15,
                      vreinterpretq_s16_u16(vpselq_u16(vshrq_n_u16(alpha, 1), none, vcmpneq_n_u16(w, 0))));
            any = vorrq_u16(any, w);
            rows++;
        }
        for (int k = 0; k < 2; k++) {
            q.left[k] = vsubq_u32(q.left[k], q.step[k]);
            q.step[k] = vaddq_n_u32(q.step[k], q.bend);
        }
        transmittance += T3R_TILE_SIDE;
        red += T3R_TILE_SIDE;
    }
    return any;
}

void t3r_blend_mve(t3r_tile *tile, const t3r_tile_splat *splat)
{
    for (uint32_t group = 0; group < splat->groups; group++) {
        if ((splat->drawn >> group & 1) != 0) {
            (void)blend_group(tile, splat, group, NULL);
        }
    }
}

#if T3R_FEATURE_REFINEMENT
uint16_t t3r_blend_keep_mve(t3r_tile *restrict tile, const t3r_tile_splat *splat, t3r_blended_row *restrict rows)
{
    const uint32_t rows_a_group = splat->last - splat->first + 1u;
    uint16x8_t any = vdupq_n_u16(0);
    for (uint32_t group = 0; group < splat->groups; group++, rows += rows_a_group) {
        if ((splat->drawn >> group & 1) != 0) {
            any = vorrq_u16(any, blend_group(tile, splat, group, rows));
        } else {
            memset(rows, 0, rows_a_group * sizeof *rows);
        }
    }
    const uint64x2_t halves = vreinterpretq_u64_u16(any);
    const uint64_t bits = vgetq_lane_u64(halves, 0) | vgetq_lane_u64(halves, 1);
    const uint32_t both = (uint32_t)bits | (uint32_t)(bits >> 32);
    return (uint16_t)(both | both >> 16);
}
#endif

#else
typedef int t3r_no_blend_mve; /* a file may not be empty */
#endif
