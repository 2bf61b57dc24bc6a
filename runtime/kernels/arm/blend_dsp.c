/* SPDX-License-Identifier: Apache-2.0 */
/* Blending for a Cortex-M with 16-bit products: pixel by pixel, skipping those where the splat is invisible. */
#include "variants.h"

#ifdef T3R_DSP

#include <arm_acle.h>
#include <stdbool.h>
#include <stddef.h>

#include "core/alpha.h"
#include "core/fixed.h"
#include "products.h"

/* With less of T3R_ALPHA_RANGE left no alpha reaches 1/255, at any opacity. */
#define LEAST_LEFT 3791

/* Computes alphas_of() of blend.c from the rest of T3R_ALPHA_RANGE. Factors below 2^15 take one instruction including
 * the sum. */
static inline uint32_t alpha_of(int32_t s, uint32_t opacity_q32)
{
    const int32_t p3 = __smlawb(s, T3R_ALPHA_C4, T3R_ALPHA_C3), p2 = __smlawb(s, p3, T3R_ALPHA_C2);
    const uint32_t p1 = (uint32_t)__smlawb(s, p2, T3R_ALPHA_C1);
    uint32_t p = T3R_ALPHA_C0 + ((uint32_t)s * p1 >> 16);
    p = p * p >> 16;
    p = p * p >> 16;
    p = p * p >> 16;
    return T3R_MIN((uint32_t)((uint64_t)p * opacity_q32 >> 32), (uint32_t)T3R_ALPHA_MOST_Q16);
}

/* Offset between a pixel's transmittance and its colour planes. */
enum { PLANE = T3R_TILE_SIDE * T3R_TILE_SIDE };

_Static_assert(offsetof(t3r_tile, colour_q7) == PLANE * sizeof(uint16_t), "planes lie one behind the other");

/* Adds (w colour + 2^15) / 2^16, given w 2^15 and twice the colour. */
static inline void add_colour(uint16_t *to, int32_t w_q31, int32_t twice_colour)
{
    *to = (uint16_t)t3r_add_high_product(*to, w_q31, twice_colour);
}

/* rows: where blended rows are kept if it `keeps` them, 0 before. Returns the bitwise or of the kept weights. */
static inline __attribute__((always_inline)) uint32_t blend_group(t3r_tile *restrict tile, const t3r_tile_splat *splat,
                                                                  uint32_t group, bool keeps,
                                                                  t3r_blended_row *restrict rows)
{
    const uint32_t row = splat->first, a = (uint32_t)splat->a, b = (uint32_t)splat->b, c = (uint32_t)splat->c;
    const uint32_t gx = (uint32_t)splat->group[group].gx, gy = (uint32_t)splat->group[group].gy;
    const uint32_t at = 16 * T3R_ALPHA_RANGE + 7 - (uint32_t)splat->group[group].q - row * (gy + row * c);
    const uint32_t opacity = (uint32_t)splat->opacity_q16 << 16, rows_a_group = splat->last - row + 1;
    const int32_t red = 2 * splat->colour_q7[0], green = 2 * splat->colour_q7[1], blue = 2 * splat->colour_q7[2];
    uint32_t any = 0;
    for (uint32_t i = 0; i < T3R_LANES; i++) {
        uint32_t left = at - i * (gx + row * b + i * a), step = gy + i * b + (2 * row + 1) * c; /* modulo 2^32 */
        uint16_t *place = &tile->transmittance_q16[row][splat->column + group * T3R_LANES + i];
        uint16_t *keep = keeps ? &rows->weight_q16[i] : NULL;
        for (uint32_t j = rows_a_group; j > 0; j--) {
            if ((int32_t)left >= 16 * LEAST_LEFT) {
                const uint32_t t = *place;
                const uint32_t alpha = alpha_of(T3R_MIN((int32_t)left >> 4, T3R_ALPHA_RANGE), opacity);
                if (alpha >= T3R_ALPHA_LEAST_Q16 && t >= T3R_STOP_Q16) {
                    const uint32_t w = (t * alpha + T3R_HALF_Q16) >> 16;
                    const int32_t w_q31 = (int32_t)(w << 15);
                    place[0] = (uint16_t)(t - w);
                    add_colour(place + PLANE, w_q31, red);
                    add_colour(place + 2 * PLANE, w_q31, green);
                    add_colour(place + 3 * PLANE, w_q31, blue);
                    if (keeps && w != 0) {
                        keep[0] = (uint16_t)w;
                        keep[T3R_LANES] = (uint16_t)(alpha >> 1);
                        any |= w;
                    }
                }
            }
            left -= step;
            step += 2 * c;
            place += T3R_TILE_SIDE;
            keep += keeps ? sizeof *rows / sizeof *keep : 0;
        }
    }
    return any;
}

void t3r_blend_dsp(t3r_tile *tile, const t3r_tile_splat *splat)
{
    for (uint32_t group = 0; group < splat->groups; group++) {
        if ((splat->drawn >> group & 1) != 0) {
            (void)blend_group(tile, splat, group, false, NULL);
        }
    }
}

#if T3R_FEATURE_REFINEMENT
uint16_t t3r_blend_keep_dsp(t3r_tile *restrict tile, const t3r_tile_splat *splat, t3r_blended_row *restrict rows)
{
    const uint32_t rows_a_group = splat->last - splat->first + 1u;
    uint32_t any = 0;
    for (uint32_t group = 0; group < splat->groups; group++, rows += rows_a_group) {
        for (uint32_t j = 0; j < rows_a_group; j++) {
            rows[j] = (t3r_blended_row){{0}, {0}};
        }
        if ((splat->drawn >> group & 1) != 0) {
            any |= blend_group(tile, splat, group, true, rows);
        }
    }
    return (uint16_t)any;
}
#endif

#else
typedef int t3r_no_blend_dsp; /* a file may not be empty */
#endif
