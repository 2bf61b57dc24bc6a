/* SPDX-License-Identifier: Apache-2.0 */
/* One splat over one row of a tile: the innermost step of rendering, walking and differentiating, in loops of a fixed
 * length over all columns, which compilers vectorize. */
#ifndef TRIM3R_TOOLS_RIVALS_SPLAT_BLEND_H
#define TRIM3R_TOOLS_RIVALS_SPLAT_BLEND_H

#include "study/rivals/splats/splat_view.h"
#include "study/rivals/splats/vectorized.h"

/* Returns exp(-q) for q in 0..16, within 2e-5 relative up to q = 6, where alpha matters: the series of q / 16, to
 * the 16th power. */
RIVAL_INLINE float splat_decay(float q)
{
    float t = q * (-1.0f / 16);
    float e = 1 + t * (1 + t * (1.0f / 2 + t * (1.0f / 6 + t * (1.0f / 24 + t * (1.0f / 120 + t * (1.0f / 720))))));
    e *= e;
    e *= e;
    e *= e;
    return e * e;
}

/* Computes alpha of columns left .. left + 7 at dy below the centre, 0 where it is below `least` or the pixel is
 * closed; dx gets their distances from the centre. Each loop has one condition: with more, compilers branch. */
RIVAL_INLINE void splat_alphas(const splat *s, float least, float left, float dy, const float transmittance[SPLAT_TILE],
                               float alpha[SPLAT_TILE], float dx[SPLAT_TILE])
{
    float rest = 0.5f * s->c * dy * dy, slope = s->b * dy, half = 0.5f * s->a, opacity = s->opacity;
    float q[SPLAT_TILE];
    for (int i = 0; i < SPLAT_TILE; i++) {
        dx[i] = left + (float)i - s->x;
        float whole = (half * dx[i] + slope) * dx[i] + rest;
        q[i] = whole < 16.0f ? whole : 16.0f;
    }
    for (int i = 0; i < SPLAT_TILE; i++) {
        float a = opacity * splat_decay(q[i]);
        alpha[i] = a < SPLAT_ALPHA_MOST ? a : SPLAT_ALPHA_MOST;
    }
    for (int i = 0; i < SPLAT_TILE; i++) {
        alpha[i] = alpha[i] < least ? 0.0f : alpha[i];
    }
    for (int i = 0; i < SPLAT_TILE; i++) {
        alpha[i] = transmittance[i] < SPLAT_CLOSED ? 0.0f : alpha[i];
    }
}

/* Computes the rows of the tile starting at pixel row `top` that the splat may reach. */
RIVAL_INLINE void splat_rows(const splat *s, int32_t top, int32_t *first, int32_t *last)
{
    *first = s->top > top ? s->top - top : 0;
    *last = s->bottom < top + SPLAT_TILE - 1 ? s->bottom - top : SPLAT_TILE - 1;
}

#endif
