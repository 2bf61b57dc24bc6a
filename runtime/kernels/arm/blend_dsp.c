/* Blending for a Cortex-M with products of 16 bits: pixel by pixel, and none where the splat cannot be seen. */
#include "variants.h"

#ifdef T3R_DSP

#include <arm_acle.h>

#include "core/fixed.h"
#include "core/memory.h"
#include "kernels/alpha.h"

/* Of less than this no alpha comes to 1/255, whatever the opacity. */
#define LEAST_LEFT 3791

/* alphas_of() in blend.c, of what is left of T3R_ALPHA_RANGE. Factors below 2^15 take one instruction with the sum. */
static inline uint32_t alpha_of(int32_t s, uint32_t opacity_q16)
{
    const int32_t p3 = __smlawb(s, T3R_ALPHA_C4, T3R_ALPHA_C3), p2 = __smlawb(s, p3, T3R_ALPHA_C2);
    const uint32_t p1 = (uint32_t)__smlawb(s, p2, T3R_ALPHA_C1);
    uint32_t p = T3R_ALPHA_C0 + ((uint32_t)s * p1 >> 16);
    p = p * p >> 16;
    p = p * p >> 16;
    p = p * p >> 16;
    return T3R_MIN(p * opacity_q16 >> 16, (uint32_t)T3R_ALPHA_MOST_Q16);
}

static inline uint16_t with_colour(uint16_t behind, uint32_t weight, uint32_t colour_q7)
{
    return (uint16_t)(behind + ((weight * colour_q7 + T3R_HALF_Q16) >> 16)); /* below 2^32 */
}

/* rows: where what is blended is kept, or NULL; known where this is inlined. Returns all bits of the weights kept. */
static inline __attribute__((always_inline)) uint32_t blend_group(t3r_tile *restrict tile, const t3r_tile_splat *splat,
                                                                  uint32_t group, t3r_blended_row *restrict rows)
{
    const uint32_t row = splat->first, a = (uint32_t)splat->a, b = (uint32_t)splat->b, c = (uint32_t)splat->c;
    const uint32_t gx = (uint32_t)splat->group[group].gx, gy = (uint32_t)splat->group[group].gy;
    const uint32_t at = 16 * T3R_ALPHA_RANGE + 7 - (uint32_t)splat->group[group].q - row * (gy + row * c);
    const uint32_t opacity = splat->opacity_q16, red = splat->colour_q7[0], green = splat->colour_q7[1];
    const uint32_t blue = splat->colour_q7[2];
    uint32_t any = 0;
    for (uint32_t i = 0; i < T3R_LANES; i++) {
        const uint32_t column = splat->column + group * T3R_LANES + i;
        uint32_t left = at - i * (gx + row * b + i * a), step = gy + i * b + (2 * row + 1) * c; /* modulo 2^32 */
        t3r_blended_row *to = rows;
        for (uint32_t j = row; j <= splat->last; j++, to += rows != NULL, left -= step, step += 2 * c) {
            const uint32_t t = tile->transmittance_q16[j][column];
            uint32_t alpha = 0, w = 0;
            if ((int32_t)left >= 16 * LEAST_LEFT && t >= T3R_STOP_Q16) {
                alpha = alpha_of(T3R_MIN((int32_t)left >> 4, T3R_ALPHA_RANGE), opacity);
                if (alpha >= T3R_ALPHA_LEAST_Q16) {
                    w = (t * alpha + T3R_HALF_Q16) >> 16;
                    tile->transmittance_q16[j][column] = (uint16_t)(t - w);
                    tile->colour_q7[0][j][column] = with_colour(tile->colour_q7[0][j][column], w, red);
                    tile->colour_q7[1][j][column] = with_colour(tile->colour_q7[1][j][column], w, green);
                    tile->colour_q7[2][j][column] = with_colour(tile->colour_q7[2][j][column], w, blue);
                }
            }
            if (rows != NULL) {
                to->weight_q16[i] = (uint16_t)w;
                to->alpha_q15[i] = (int16_t)(w == 0 ? 0 : alpha >> 1);
                any |= w;
            }
        }
    }
    return any;
}

void t3r_blend_dsp(t3r_tile *tile, const t3r_tile_splat *splat)
{
    for (uint32_t group = 0; group < splat->groups; group++) {
        if ((splat->drawn >> group & 1) != 0) {
            (void)blend_group(tile, splat, group, NULL);
        }
    }
}

#if T3R_FEATURE_REFINEMENT
uint16_t t3r_blend_keep_dsp(t3r_tile *restrict tile, const t3r_tile_splat *splat, t3r_blended_row *restrict rows)
{
    const uint32_t rows_a_group = splat->last - splat->first + 1u;
    uint32_t any = 0;
    for (uint32_t group = 0; group < splat->groups; group++, rows += rows_a_group) {
        if ((splat->drawn >> group & 1) != 0) {
            any |= blend_group(tile, splat, group, rows);
        } else {
            memset(rows, 0, rows_a_group * sizeof *rows);
        }
    }
    return (uint16_t)any;
}
#endif

#else
typedef int t3r_no_blend_dsp; /* a file may not be empty */
#endif
