#include "blend.h"

#include "alpha.h"
#include "core/fixed.h"
#include "core/memory.h"

/* One lane: exp(-q / 8) by the polynomial about q = 6, squared three times. Nothing is negative, so one unsigned
 * multiplication serves throughout. */
static inline uint16_t alpha_of(int32_t q_q17, uint16_t opacity_q16)
{
    int32_t t = (q_q17 + 8) >> 4; /* q / 8 in Q16 */
    t = t < 0 ? 0 : t;            /* rounding may leave q a little below 0 */
    t = t > T3R_ALPHA_RANGE ? T3R_ALPHA_RANGE : t;
    uint16_t s = (uint16_t)(T3R_ALPHA_RANGE - t);
    uint16_t p = (uint16_t)(T3R_ALPHA_C3 + t3r_mulr_q16(s, T3R_ALPHA_C4));
    p = (uint16_t)(T3R_ALPHA_C2 + t3r_mulr_q16(s, p));
    p = (uint16_t)(T3R_ALPHA_C1 + t3r_mulr_q16(s, p));
    p = (uint16_t)(T3R_ALPHA_C0 + t3r_mulr_q16(s, p));
    p = t3r_mulr_q16(p, p);
    p = t3r_mulr_q16(p, p);
    p = t3r_mulr_q16(p, p);
    uint16_t alpha = t3r_mulr_q16(p, opacity_q16);
    alpha = alpha > T3R_ALPHA_MOST_Q16 ? T3R_ALPHA_MOST_Q16 : alpha;
    return alpha < T3R_ALPHA_LEAST_Q16 ? 0 : alpha;
}

uint16_t t3r_alpha_q16(int32_t q_q17, uint16_t opacity_q16)
{
    return alpha_of(q_q17, opacity_q16);
}

static void blend_group(t3r_tile *tile, const t3r_tile_splat *splat, uint32_t group)
{
    const uint32_t column = splat->column + group * T3R_LANES;
    const int32_t gx = splat->group[group].gx, gy = splat->group[group].gy, row = splat->first;
    int32_t q[T3R_LANES], step[T3R_LANES];
    for (int32_t i = 0; i < T3R_LANES; i++) {
        q[i] = splat->group[group].q + i * gx + i * i * splat->a + row * (gy + i * splat->b + row * splat->c);
        step[i] = gy + i * splat->b + (2 * row + 1) * splat->c;
    }
    const int32_t bend = 2 * splat->c;
    const uint16_t opacity = splat->opacity_q16;
    const uint16_t red = splat->colour_q7[0], green = splat->colour_q7[1], blue = splat->colour_q7[2];
    for (uint32_t j = splat->first; j <= splat->last; j++) {
        uint16_t *transmittance = tile->transmittance_q16[j] + column;
        uint16_t *r = tile->colour_q7[0][j] + column;
        uint16_t *g = tile->colour_q7[1][j] + column;
        uint16_t *b = tile->colour_q7[2][j] + column;
        for (int32_t i = 0; i < T3R_LANES; i++) {
            uint16_t alpha = alpha_of(q[i], opacity);
            uint16_t t = transmittance[i];
            alpha = t < T3R_STOP_Q16 ? 0 : alpha;
            uint16_t w = t3r_mulr_q16(t, alpha);
            transmittance[i] = (uint16_t)(t - w);
            r[i] = (uint16_t)(r[i] + t3r_mulr_q16(w, red));
            g[i] = (uint16_t)(g[i] + t3r_mulr_q16(w, green));
            b[i] = (uint16_t)(b[i] + t3r_mulr_q16(w, blue));
            q[i] += step[i];
            step[i] += bend;
        }
    }
}

/* Before a group is blended its transmittance is kept, afterwards what that lost are the weights. */
static void keep(const t3r_tile *tile, const t3r_tile_splat *splat, uint32_t column,
                 t3r_blend_weights *restrict weights)
{
    for (uint32_t j = splat->first; j <= splat->last; j++) {
        memcpy(weights[j - splat->first].q16, &tile->transmittance_q16[j][column], sizeof weights->q16);
    }
}

static void take(const t3r_tile *tile, const t3r_tile_splat *splat, uint32_t column,
                 t3r_blend_weights *restrict weights)
{
    for (uint32_t j = splat->first; j <= splat->last; j++) {
        const uint16_t *transmittance = tile->transmittance_q16[j] + column;
        t3r_blend_weights row = weights[j - splat->first];
        for (int32_t i = 0; i < T3R_LANES; i++) {
            row.q16[i] = (uint16_t)(row.q16[i] - transmittance[i]);
        }
        weights[j - splat->first] = row;
    }
}

void t3r_blend_c(t3r_tile *restrict tile, const t3r_tile_splat *splat, t3r_blend_weights *restrict weights)
{
    const uint32_t rows = splat->last - splat->first + 1u;
    for (uint32_t group = 0; group < splat->groups; group++) {
        const uint32_t column = splat->column + group * T3R_LANES;
        if (weights != NULL) {
            keep(tile, splat, column, weights + group * rows);
        }
        if ((splat->drawn >> group & 1) != 0) {
            blend_group(tile, splat, group);
        }
        if (weights != NULL) {
            take(tile, splat, column, weights + group * rows);
        }
    }
}

static void blend_rows_again(t3r_tile *restrict tile, const uint16_t colour_q7[3], uint32_t column, uint32_t first,
                             uint32_t last, const t3r_blend_weights *weights)
{
    const uint16_t red = colour_q7[0], green = colour_q7[1], blue = colour_q7[2];
    for (uint32_t j = first; j <= last; j++) {
        uint16_t *transmittance = tile->transmittance_q16[j] + column;
        uint16_t *r = tile->colour_q7[0][j] + column;
        uint16_t *g = tile->colour_q7[1][j] + column;
        uint16_t *b = tile->colour_q7[2][j] + column;
        for (int32_t i = 0; i < T3R_LANES; i++) {
            uint16_t w = weights[j - first].q16[i];
            transmittance[i] = (uint16_t)(transmittance[i] - w);
            r[i] = (uint16_t)(r[i] + t3r_mulr_q16(w, red));
            g[i] = (uint16_t)(g[i] + t3r_mulr_q16(w, green));
            b[i] = (uint16_t)(b[i] + t3r_mulr_q16(w, blue));
        }
    }
}

void t3r_blend_again_c(t3r_tile *restrict tile, const t3r_tile_splat *splat, const t3r_blend_weights *weights)
{
    const uint32_t rows = splat->last - splat->first + 1u;
    for (uint32_t group = 0; group < splat->groups; group++) {
        blend_rows_again(tile, splat->colour_q7, splat->column + group * T3R_LANES, splat->first, splat->last,
                         weights + group * rows);
    }
}
