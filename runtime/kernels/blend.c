#include "blend.h"

#include "core/fixed.h"

/* exp(s - 0.75) on [0, 0.75] in Q16: C0 + s (C1 + s (C2 + s (C3 + s C4))), minimax, C0 and C1 lowered so that
 * the result stays below 1: error below 2^-15, with the roundings below 2^-14. */
#define C0 30957
#define C1 30944
#define C2 15597
#define C3 4735
#define C4 1892
#define T_MOST 49152 /* 0.75: exp(-6) x 1 is below 1/255 already */

/* One lane: exp(-q / 8) by the polynomial about q = 6, squared three times. Nothing is negative, so one unsigned
 * multiplication serves throughout. */
static inline uint16_t alpha_of(int32_t q_q17, uint16_t opacity_q16)
{
    int32_t t = (q_q17 + 8) >> 4; /* q / 8 in Q16 */
    t = t < 0 ? 0 : t;            /* rounding may leave q a little below 0 */
    t = t > T_MOST ? T_MOST : t;
    uint16_t s = (uint16_t)(T_MOST - t);
    uint16_t p = (uint16_t)(C3 + t3r_mulr_q16(s, C4));
    p = (uint16_t)(C2 + t3r_mulr_q16(s, p));
    p = (uint16_t)(C1 + t3r_mulr_q16(s, p));
    p = (uint16_t)(C0 + t3r_mulr_q16(s, p));
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

void t3r_blend_rows(t3r_tile *tile, const t3r_lane_splat *splat, uint32_t column, uint32_t first, uint32_t last)
{
    int32_t q[T3R_LANES], step[T3R_LANES];
    const int32_t row = (int32_t)first;
    for (int32_t i = 0; i < T3R_LANES; i++) {
        q[i] = splat->q + i * splat->gx + i * i * splat->a + row * (splat->gy + i * splat->b + row * splat->c);
        step[i] = splat->gy + i * splat->b + (2 * row + 1) * splat->c;
    }
    const int32_t bend = 2 * splat->c;
    const uint16_t opacity = splat->opacity_q16;
    const uint16_t red = splat->colour_q7[0], green = splat->colour_q7[1], blue = splat->colour_q7[2];
    for (uint32_t j = first; j <= last; j++) {
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
