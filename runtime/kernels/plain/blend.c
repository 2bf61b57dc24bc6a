/* SPDX-License-Identifier: Apache-2.0 */
#include "kernels/blend.h"

#include "core/alpha.h"
#include "core/fixed.h"
#include "core/memory.h"
#include "kernels/lanes/vectors/lanes.h"

/* Computes alphas from exp(-q / 8), by the polynomial around q = 6, squared three times. Nothing is negative, so one
 * unsigned multiplication is enough. It rounds down; only sums over many splats are rounded to the nearest. */
static inline __attribute__((always_inline)) t3r_lanes alphas_of(const int32_t q_q17[T3R_C_LANES], uint16_t opacity_q16)
{
    t3r_lanes s;
    T3R_EACH_LANE
    {
        int32_t t = (q_q17[i] + 8) >> 4; /* q / 8 in Q16 */
        t = t < 0 ? 0 : t;               /* rounding may leave q a little below 0 */
        t = t > T3R_ALPHA_RANGE ? T3R_ALPHA_RANGE : t;
        s.x[i] = (uint16_t)(T3R_ALPHA_RANGE - t);
    }
    t3r_lanes p = t3r_lanes_add(t3r_lanes_of(T3R_ALPHA_C3), t3r_lanes_mul_q16(s, t3r_lanes_of(T3R_ALPHA_C4)));
    p = t3r_lanes_add(t3r_lanes_of(T3R_ALPHA_C2), t3r_lanes_mul_q16(s, p));
    p = t3r_lanes_add(t3r_lanes_of(T3R_ALPHA_C1), t3r_lanes_mul_q16(s, p));
    p = t3r_lanes_add(t3r_lanes_of(T3R_ALPHA_C0), t3r_lanes_mul_q16(s, p));
    p = t3r_lanes_mul_q16(p, p);
    p = t3r_lanes_mul_q16(p, p);
    p = t3r_lanes_mul_q16(p, p);
    t3r_lanes alpha = t3r_lanes_mul_q16(p, t3r_lanes_of(opacity_q16));
    T3R_EACH_LANE
    {
        alpha.x[i] = alpha.x[i] > T3R_ALPHA_MOST_Q16 ? T3R_ALPHA_MOST_Q16 : alpha.x[i];
    }
    return t3r_lanes_where_at_least(alpha, alpha, T3R_ALPHA_LEAST_Q16);
}

uint16_t t3r_alpha_q16(int32_t q_q17, uint16_t opacity_q16)
{
    int32_t q[T3R_C_LANES];
    T3R_EACH_LANE
    {
        q[i] = q_q17;
    }
    return alphas_of(q, opacity_q16).x[0];
}

/* A row's blended lanes. */
typedef struct blended {
    t3r_lanes weight, alpha;
} blended;

static inline void add_colour(uint16_t *to, t3r_lanes weight, uint16_t colour_q7)
{
    t3r_lanes_store(t3r_lanes_add(t3r_lanes_load(to), t3r_lanes_mulr_q16(weight, t3r_lanes_of(colour_q7))), to);
}

static inline __attribute__((always_inline)) blended
blend_lanes(t3r_tile *tile, const t3r_tile_splat *splat, uint32_t j, uint32_t column, const int32_t q[T3R_C_LANES])
{
    uint16_t *transmittance = tile->transmittance_q16[j] + column;
    const t3r_lanes t = t3r_lanes_load(transmittance);
    blended b;
    b.alpha = t3r_lanes_where_at_least(alphas_of(q, splat->opacity_q16), t, T3R_STOP_Q16);
    b.weight = t3r_lanes_mulr_q16(t, b.alpha);
    t3r_lanes_store(t3r_lanes_subtract(t, b.weight), transmittance);
    add_colour(tile->colour_q7[0][j] + column, b.weight, splat->colour_q7[0]);
    add_colour(tile->colour_q7[1][j] + column, b.weight, splat->colour_q7[1]);
    add_colour(tile->colour_q7[2][j] + column, b.weight, splat->colour_q7[2]);
    return b;
}

static inline void keep_pixel(blended b, uint16_t *weight_q16, int16_t *alpha_q15)
{
    t3r_lanes_store(b.weight, weight_q16);
    b.alpha = t3r_lanes_where_at_least(b.alpha, b.weight, 1);
    T3R_EACH_LANE
    {
        alpha_q15[i] = (int16_t)(b.alpha.x[i] >> 1);
    }
}

/* Blends a group of columns. rows: where the blended rows are stored, or NULL; a constant once inlined. Returns the
 * bitwise or of the weights stored. */
static inline __attribute__((always_inline)) uint16_t blend_group(t3r_tile *restrict tile, const t3r_tile_splat *splat,
                                                                  uint32_t group, t3r_blended_row *restrict rows)
{
    const int32_t gx = splat->group[group].gx, gy = splat->group[group].gy, row = splat->first;
    const int32_t bend = 2 * splat->c;
    t3r_lanes any = t3r_lanes_of(0);
    for (int32_t first = 0; first < T3R_LANES; first += T3R_C_LANES) {
        const uint32_t column = splat->column + group * T3R_LANES + (uint32_t)first;
        int32_t q[T3R_C_LANES], step[T3R_C_LANES];
        T3R_EACH_LANE
        {
            const int32_t x = first + i;
            q[i] = splat->group[group].q + x * gx + x * x * splat->a + row * (gy + x * splat->b + row * splat->c);
            step[i] = gy + x * splat->b + (2 * row + 1) * splat->c;
        }
        for (uint32_t j = splat->first; j <= splat->last; j++) {
            const blended b = blend_lanes(tile, splat, j, column, q);
            if (rows != NULL) {
                t3r_blended_row *to = &rows[j - splat->first];
                keep_pixel(b, to->weight_q16 + first, to->alpha_q15 + first);
                any = t3r_lanes_or(any, b.weight);
            }
            T3R_EACH_LANE
            {
                q[i] += step[i];
                step[i] += bend;
            }
        }
    }
    uint16_t bits = 0;
    T3R_EACH_LANE
    {
        bits |= any.x[i];
    }
    return bits;
}

void t3r_blend_c(t3r_tile *tile, const t3r_tile_splat *splat)
{
    for (uint32_t group = 0; group < splat->groups; group++) {
        if ((splat->drawn >> group & 1) != 0) {
            (void)blend_group(tile, splat, group, NULL);
        }
    }
}

uint16_t t3r_blend_keep_c(t3r_tile *restrict tile, const t3r_tile_splat *splat, t3r_blended_row *restrict rows)
{
    const uint32_t rows_a_group = splat->last - splat->first + 1u;
    uint16_t bits = 0;
    for (uint32_t group = 0; group < splat->groups; group++, rows += rows_a_group) {
        if ((splat->drawn >> group & 1) != 0) {
            bits |= blend_group(tile, splat, group, rows);
        } else {
            memset(rows, 0, rows_a_group * sizeof *rows);
        }
    }
    return bits;
}
