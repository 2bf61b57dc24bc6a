#include "blend.h"

#include "fixed.h"

/* exp(-t) on [0, 0.75] in Q15: 1 + t (C1 + t (C2 + t (C3 + t C4))), minimax; |error| < 2^-18 before rounding */
#define C1 (-32764)
#define C2 16327
#define C3 (-5221)
#define C4 955
#define T_MOST 24576 /* 0.75: exp(-6) x 1 is below 1/255 already */

/* One lane. q is clamped to [0, 6], halved three times, and exp(-q / 8) squared three times. */
static inline int16_t alpha_of(int32_t q_q17, int16_t opacity_q15)
{
    int32_t t_wide = (q_q17 + 16) >> 5; /* q / 8 in Q15 */
    t_wide = t_wide > T_MOST ? T_MOST : t_wide;
    int16_t t = (int16_t)t_wide; /* rounding may leave it a little below 0 */
    t = t < 0 ? 0 : t;
    int16_t p = (int16_t)(C3 + t3r_mulr_q15(t, C4));
    p = (int16_t)(C2 + t3r_mulr_q15(t, p));
    p = (int16_t)(C1 + t3r_mulr_q15(t, p));
    p = (int16_t)(T3R_ONE_Q15 + t3r_mulr_q15(t, p));
    p = t3r_mulr_q15(p, p);
    p = t3r_mulr_q15(p, p);
    p = t3r_mulr_q15(p, p);
    int16_t alpha = t3r_mulr_q15(p, opacity_q15);
    alpha = alpha > T3R_ALPHA_MOST_Q15 ? T3R_ALPHA_MOST_Q15 : alpha;
    return alpha < T3R_ALPHA_LEAST_Q15 ? 0 : alpha;
}

int16_t t3r_alpha_q15(int32_t q_q17, int16_t opacity_q15)
{
    return alpha_of(q_q17, opacity_q15);
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
    const int16_t opacity = splat->opacity_q15;
    const int16_t red = splat->colour_q7[0], green = splat->colour_q7[1], blue = splat->colour_q7[2];
    for (uint32_t j = first; j <= last; j++) {
        int16_t *transmittance = tile->transmittance_q15[j] + column;
        uint16_t *r = tile->colour_q7[0][j] + column;
        uint16_t *g = tile->colour_q7[1][j] + column;
        uint16_t *b = tile->colour_q7[2][j] + column;
        for (int32_t i = 0; i < T3R_LANES; i++) {
            int16_t alpha = alpha_of(q[i], opacity);
            int16_t t = transmittance[i];
            alpha = t < T3R_STOP_Q15 ? 0 : alpha;
            int16_t w = t3r_mulr_q15(t, alpha);
            transmittance[i] = (int16_t)(t - w);
            r[i] = (uint16_t)(r[i] + t3r_mulr_q15(w, red));
            g[i] = (uint16_t)(g[i] + t3r_mulr_q15(w, green));
            b[i] = (uint16_t)(b[i] + t3r_mulr_q15(w, blue));
            q[i] += step[i];
            step[i] += bend;
        }
    }
}
