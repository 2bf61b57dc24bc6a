/* SPDX-License-Identifier: Apache-2.0 */
/* Derivatives of a measure of a drawn view.
 *
 * The walk goes front to back, like drawing: the colour C of a pixel is the sum of T_i alpha_i c_i, so dC / d alpha_i =
 * T_i c_i - (C - C_i) / (1 - alpha_i), C_i being the colour blended up to and including i. The measure's derivative g
 * at the pixel is known before, so one number per pixel, g . C_i, replaces three. */
#include <stddef.h>
#include <string.h>

#include "study/rivals/splats/splat_blend.h"
#include "study/rivals/splats/splat_view.h"

typedef struct tile {
    float transmittance[SPLAT_TILE][SPLAT_TILE];
    float behind[SPLAT_TILE][SPLAT_TILE]; /* g . (C - C_i) */
    float g[3][SPLAT_TILE][SPLAT_TILE];   /* derivatives of the measure; 0 beyond the picture */
} tile;

/* Sums over a splat's pixels in a tile, one per column. */
typedef struct sums {
    float q[SPLAT_TILE], qx[SPLAT_TILE], qy[SPLAT_TILE]; /* of d measure / d q, and of its products with dx, dy */
    float qxx[SPLAT_TILE], qxy[SPLAT_TILE], qyy[SPLAT_TILE];
    float colour[3][SPLAT_TILE];
} sums;

RIVAL_INLINE void load(const splat_view *view, const float *rgb, const float *gradient, uint32_t left, uint32_t top,
                       tile *t)
{
    uint32_t width = view->camera.width, height = view->camera.height;
    memset(t, 0, sizeof *t);
    for (uint32_t y = 0; y < SPLAT_TILE; y++) {
        for (uint32_t x = 0; x < SPLAT_TILE; x++) {
            t->transmittance[y][x] = 1;
            if (top + y >= height || left + x >= width) {
                continue;
            }
            size_t at = ((size_t)(top + y) * width + left + x) * 3;
            for (int c = 0; c < 3; c++) {
                t->g[c][y][x] = gradient[at + (size_t)c];
                t->behind[y][x] += gradient[at + (size_t)c] * rgb[at + (size_t)c];
            }
        }
    }
}

RIVAL_INLINE void add_row(const splat *s, float least, float left, float dy, int32_t y, tile *t, sums *out)
{
    float alpha[SPLAT_TILE], dx[SPLAT_TILE];
    float *T = t->transmittance[y], *behind = t->behind[y];
    splat_alphas(s, least, left, dy, T, alpha, dx);
    for (int i = 0; i < SPLAT_TILE; i++) {
        float w = T[i] * alpha[i];
        float own = s->colour[0] * t->g[0][y][i] + s->colour[1] * t->g[1][y][i] + s->colour[2] * t->g[2][y][i];
        behind[i] -= w * own;
        /* at the cap alpha is constant */
        float live = alpha[i] < SPLAT_ALPHA_MOST ? alpha[i] : 0.0f;
        float dq = -live * (T[i] * own - behind[i] / (1 - alpha[i]));
        out->q[i] += dq;
        out->qx[i] += dq * dx[i];
        out->qy[i] += dq * dy;
        out->qxx[i] += dq * dx[i] * dx[i];
        out->qxy[i] += dq * dx[i] * dy;
        out->qyy[i] += dq * dy * dy;
        out->colour[0][i] += w * t->g[0][y][i];
        out->colour[1][i] += w * t->g[1][y][i];
        out->colour[2][i] += w * t->g[2][y][i];
        T[i] -= w;
    }
}

/* Adds the columns in pairs, which takes few instructions. */
RIVAL_INLINE double total(const float column[SPLAT_TILE])
{
    float half[SPLAT_TILE / 2];
    for (int i = 0; i < SPLAT_TILE / 2; i++) {
        half[i] = column[i] + column[i + SPLAT_TILE / 2];
    }
    return (double)((half[0] + half[2]) + (half[1] + half[3]));
}

/* alpha = opacity exp(-q): d alpha / d opacity = alpha / opacity = -(d alpha / d q) / opacity. */
RIVAL_INLINE void add_sums(const splat *s, const sums *in, splat_gradient *out)
{
    double qx = total(in->qx), qy = total(in->qy);
    out->x -= s->a * qx + s->b * qy;
    out->y -= s->b * qx + s->c * qy;
    out->a += 0.5 * total(in->qxx);
    out->b += total(in->qxy);
    out->c += 0.5 * total(in->qyy);
    out->opacity -= total(in->q) / s->opacity;
    for (int c = 0; c < 3; c++) {
        out->colour[c] += total(in->colour[c]);
    }
}

RIVAL_VARIANTS void splat_view_differentiate(const splat_view *view, const float *rgb, const float *rgb_gradient,
                                             splat_gradient *gradients)
{
    for (uint32_t n = 0; n < view->across * view->down; n++) {
        uint32_t left = n % view->across * SPLAT_TILE, top = n / view->across * SPLAT_TILE;
        tile t;
        load(view, rgb, rgb_gradient, left, top, &t);
        for (uint32_t at = view->first[n]; at < view->first[n + 1]; at++) {
            const splat *s = &view->splats[view->list[at]];
            int32_t first, last;
            sums sum = {0};
            splat_rows(s, (int32_t)top, &first, &last);
            for (int32_t y = first; y <= last; y++) {
                add_row(s, (float)view->alpha_least, (float)left, (float)((int32_t)top + y) - s->y, y, &t, &sum);
            }
            add_sums(s, &sum, &gradients[view->list[at]]);
        }
    }
}
