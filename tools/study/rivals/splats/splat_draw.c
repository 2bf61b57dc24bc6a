/* SPDX-License-Identifier: Apache-2.0 */
/* Draws a view, or reports the splats that draw it. */
#include <stddef.h>

#include "study/rivals/splats/splat_blend.h"
#include "study/rivals/splats/splat_view.h"

typedef struct tile {
    float transmittance[SPLAT_TILE][SPLAT_TILE];
    float colour[3][SPLAT_TILE][SPLAT_TILE];
} tile;

RIVAL_INLINE void clear(tile *t)
{
    *t = (tile){0};
    for (int y = 0; y < SPLAT_TILE; y++) {
        for (int x = 0; x < SPLAT_TILE; x++) {
            t->transmittance[y][x] = 1;
        }
    }
}

RIVAL_INLINE void blend(const splat *s, float least, int32_t left, int32_t top, tile *t)
{
    int32_t first, last;
    splat_rows(s, top, &first, &last);
    for (int32_t y = first; y <= last; y++) {
        float alpha[SPLAT_TILE], dx[SPLAT_TILE];
        float *T = t->transmittance[y];
        splat_alphas(s, least, (float)left, (float)(top + y) - s->y, T, alpha, dx);
        for (int i = 0; i < SPLAT_TILE; i++) {
            float w = T[i] * alpha[i];
            t->colour[0][y][i] += w * s->colour[0];
            t->colour[1][y][i] += w * s->colour[1];
            t->colour[2][y][i] += w * s->colour[2];
            T[i] -= w;
        }
    }
}

RIVAL_INLINE void put(const splat_view *view, const tile *t, uint32_t left, uint32_t top, float *rgb,
                      float *transmittance)
{
    uint32_t width = view->camera.width, height = view->camera.height;
    for (uint32_t y = 0; y < SPLAT_TILE && top + y < height; y++) {
        for (uint32_t x = 0; x < SPLAT_TILE && left + x < width; x++) {
            size_t pixel = (size_t)(top + y) * width + left + x;
            for (int c = 0; c < 3; c++) {
                rgb[pixel * 3 + (size_t)c] = t->colour[c][y][x];
            }
            if (transmittance != NULL) {
                transmittance[pixel] = t->transmittance[y][x];
            }
        }
    }
}

RIVAL_VARIANTS void splat_view_draw(const splat_view *view, float *rgb, float *transmittance)
{
    for (uint32_t n = 0; n < view->across * view->down; n++) {
        uint32_t left = n % view->across * SPLAT_TILE, top = n / view->across * SPLAT_TILE;
        tile t;
        clear(&t);
        for (uint32_t at = view->first[n]; at < view->first[n + 1]; at++) {
            blend(&view->splats[view->list[at]], (float)view->alpha_least, (int32_t)left, (int32_t)top, &t);
        }
        put(view, &t, left, top, rgb, transmittance);
    }
}

typedef struct walk {
    void (*visit)(void *user, const splat_row *row);
    void *user;
} walk;

static void walk_splat(const splat_view *view, uint32_t index, uint32_t left, uint32_t top, tile *t, const walk *to)
{
    const splat *s = &view->splats[index];
    uint32_t columns = view->camera.width - left;
    splat_row row = {.gaussian = index, .x = left, .columns = columns < SPLAT_TILE ? columns : SPLAT_TILE};
    int32_t first, last;
    splat_rows(s, (int32_t)top, &first, &last);
    for (int32_t y = first; y <= last; y++) {
        float dx[SPLAT_TILE];
        float *T = t->transmittance[y];
        row.y = top + (uint32_t)y;
        splat_alphas(s, (float)view->alpha_least, (float)left, (float)row.y - s->y, T, row.alpha, dx);
        for (int i = 0; i < SPLAT_TILE; i++) {
            row.before[i] = T[i];
            T[i] -= T[i] * row.alpha[i];
        }
        to->visit(to->user, &row);
    }
}

void splat_view_walk(const splat_view *view, void (*visit)(void *user, const splat_row *row), void *user)
{
    const walk to = {visit, user};
    for (uint32_t n = 0; n < view->across * view->down; n++) {
        tile t;
        clear(&t);
        for (uint32_t at = view->first[n]; at < view->first[n + 1]; at++) {
            walk_splat(view, view->list[at], n % view->across * SPLAT_TILE, n / view->across * SPLAT_TILE, &t, &to);
        }
    }
}
