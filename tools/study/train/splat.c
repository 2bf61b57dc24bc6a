/* SPDX-License-Identifier: Apache-2.0 */
/* The differentiable splatter of the training: splats of an image plane, drawn, differentiated and refined in float32
 * by the splatter of the rivals.
 *
 * A splat is nine floats: centre x, y; conic a, b, c with q = (a dx^2 + 2 b dx dy + c dy^2) / 2; opacity; red, green,
 * blue. Pictures are [pictures][height][width][3]. OpenMP threads share a batch, each picture by one, so that sums have
 * one order and training is deterministic. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "study/rivals/splats/splat_blend.h"
#include "study/rivals/splats/splat_view.h"

#define PARAMETERS 9
#ifndef ALPHA_LEAST /* a test lowers it: the cut has no derivative */
#define ALPHA_LEAST SPLAT_ALPHA_LEAST
#endif

/* A batch: splats of picture b are start[b]..start[b + 1] - 1; `order` lists each picture's, front to back, counted
 * from its start. */
typedef struct batch {
    uint32_t width, height;
    const int32_t *start, *order;
} batch;

static splat splat_of(const float *row, uint32_t place, const splat_camera *camera)
{
    splat s = {.x = row[0], .y = row[1], .a = row[2], .b = row[3], .c = row[4], .opacity = row[5], .right = -1};
    float level = 2 * logf(s.opacity / (float)ALPHA_LEAST), determinant = s.a * s.c - s.b * s.b;
    memcpy(s.colour, row + 6, sizeof s.colour);
    s.depth_key = place;
    if (s.opacity > (float)ALPHA_LEAST && determinant > 0) {
        splat_cut(s.x, sqrtf(level * s.c / determinant), camera->width, &s.left, &s.right);
        splat_cut(s.y, sqrtf(level * s.a / determinant), camera->height, &s.top, &s.bottom);
        s.right = s.bottom < s.top ? s.left - 1 : s.right;
    }
    return s;
}

/* Opens the view of picture b. False without memory; splat_view_close() in any case. */
static bool open_view(splat_view *view, const batch *of, int32_t b, const float *splats)
{
    const splat_camera camera = {.width = of->width, .height = of->height};
    const int32_t first = of->start[b], count = of->start[b + 1] - first;
    if (!splat_view_open(view, &camera, (uint32_t)count)) {
        return false;
    }
    view->alpha_least = ALPHA_LEAST;
    for (int32_t n = 0; n < count; n++) {
        const int32_t at = of->order[first + n];
        view->splats[at] = splat_of(splats + (size_t)PARAMETERS * (first + at), (uint32_t)n, &camera);
    }
    return splat_view_bin(view);
}

/* Draws the pictures into rgb. Returns 0 when memory is out. */
int splat_forward(int32_t pictures, uint32_t width, uint32_t height, const int32_t *start, const float *splats,
                  const int32_t *order, float *rgb)
{
    const batch of = {width, height, start, order};
    int good = 1;
#pragma omp parallel for schedule(dynamic) reduction(&& : good)
    for (int32_t b = 0; b < pictures; b++) {
        splat_view view;
        if (open_view(&view, &of, b, splats)) {
            splat_view_draw(&view, rgb + (size_t)b * 3 * width * height, NULL);
        } else {
            good = 0;
        }
        splat_view_close(&view);
    }
    return good;
}

/* Writes derivatives of a loss with respect to every parameter, from those with respect to the pictures that
 * splat_forward() drew. gradient: like splats. Returns 0 when memory is out. */
int splat_backward(int32_t pictures, uint32_t width, uint32_t height, const int32_t *start, const float *splats,
                   const int32_t *order, const float *rgb, const float *rgb_gradient, float *gradient)
{
    const batch of = {width, height, start, order};
    const size_t samples = (size_t)3 * width * height;
    int good = 1;
#pragma omp parallel for schedule(dynamic) reduction(&& : good)
    for (int32_t b = 0; b < pictures; b++) {
        const int32_t count = start[b + 1] - start[b];
        splat_gradient *sums = calloc((size_t)count + 1, sizeof *sums);
        float *out = gradient + (size_t)PARAMETERS * start[b];
        splat_view view;
        if (open_view(&view, &of, b, splats) && sums != NULL) {
            splat_view_differentiate(&view, rgb + b * samples, rgb_gradient + b * samples, sums);
            for (int32_t n = 0; n < count; n++, out += PARAMETERS) {
                const splat_gradient *g = &sums[n];
                const double of_splat[PARAMETERS] = {g->x,       g->y,         g->a,         g->b,        g->c,
                                                     g->opacity, g->colour[0], g->colour[1], g->colour[2]};
                for (int k = 0; k < PARAMETERS; k++) {
                    out[k] = (float)of_splat[k];
                }
            }
        } else {
            good = 0;
        }
        splat_view_close(&view);
        free(sums);
    }
    return good;
}

/* --- refinement -------------------------------------------------------------------------------------------------- */

/* Refines like runtime/refine/refine.c (runtime/SPEC.md, "Refinement"), but in floats: nothing is rounded, the six
 * equations are solved exactly, and a splat's own axes are any factor of its covariance, which suffices in one view. */
#define UNKNOWNS 6
#define MOMENTS 15
#define DILATION ((float)SPLAT_LOW_PASS)
#define VARIANCE_LEAST 0.02f
#define COLOUR_STEP 0.8125f
#define SHARE_FIRST 0.171875f /* of the Gauss-Newton step */
#define SHARE_LEAST 0.03125f
#define SHARE_MOST 0.5f
#define ASKED_MOST 2.0f
#define RELATIVE_DAMPING 0.1875f
#define DAMPING (64.0f / 65025.0f)
#define MOMENTUM 0.1875f /* of the previous pass */
#define OPACITY_STEP_MOST 0.5f
#define SHIFT_MOST 0.5f
#define SHAPE_MOST 0.1f

/* Sums over the pixels of one splat: w r, w, (g . r) e^ij for i + j <= 2, |g|^2 e^ij for i + j <= 4. */
typedef struct sums {
    float colour[3], weight, gradient[UNKNOWNS], curvature[MOMENTS];
} sums;

/* Lower Cholesky factor of the covariance less the dilation, and K = L^T S^-1: own coordinates e = K d. */
typedef struct axes {
    float l11, l21, l22, k[2][2];
} axes;

static axes axes_of(float ca, float cb, float cc)
{
    float det = ca * cc - cb * cb;
    float xx = fmaxf(cc / det - DILATION, VARIANCE_LEAST), xy = -cb / det;
    float yy = fmaxf(ca / det - DILATION, VARIANCE_LEAST);
    axes a;
    a.l11 = sqrtf(xx);
    a.l21 = xy / a.l11;
    a.l22 = sqrtf(fmaxf(yy - a.l21 * a.l21, VARIANCE_LEAST));
    a.k[0][0] = a.l11 * ca + a.l21 * cb;
    a.k[0][1] = a.l11 * cb + a.l21 * cc;
    a.k[1][0] = a.l22 * cb;
    a.k[1][1] = a.l22 * cc;
    return a;
}

/* A tile, row by row: what no splat so far has drawn, and what the picture lacks, 0 where a pixel has no say. */
typedef struct tile {
    float transmittance[SPLAT_TILE][SPLAT_TILE];
    float behind[SPLAT_TILE][3][SPLAT_TILE], residual[SPLAT_TILE][3][SPLAT_TILE];
} tile;

static void add_row(const splat *s, const axes *a, float left, float dy, float T[SPLAT_TILE],
                    float behind[3][SPLAT_TILE], float residual[3][SPLAT_TILE], sums *total)
{
    float alpha[SPLAT_TILE], distance[SPLAT_TILE];
    splat_alphas(s, (float)ALPHA_LEAST, left, dy, T, alpha, distance);
    float colour[3] = {0}, weight = 0, b[UNKNOWNS] = {0}, h[MOMENTS] = {0};
    for (int i = 0; i < SPLAT_TILE; i++) {
        float w = T[i] * alpha[i], after = T[i] - w, gr = 0, gg = 0;
        for (int c = 0; c < 3; c++) {
            behind[c][i] -= w * s->colour[c];
            float g = w * (s->colour[c] - fminf(behind[c][i] / fmaxf(after, 1e-5f), 1.0f));
            gr += g * residual[c][i];
            gg += g * g;
            colour[c] += w * residual[c][i];
        }
        float dx = distance[i];
        float x = a->k[0][0] * dx + a->k[0][1] * dy, y = a->k[1][0] * dx + a->k[1][1] * dy;
        float xx = x * x, xy = x * y, yy = y * y;
        weight += w;
        b[0] += gr;
        b[1] += gr * x;
        b[2] += gr * y;
        b[3] += gr * xx;
        b[4] += gr * xy;
        b[5] += gr * yy;
        h[0] += gg;
        h[1] += gg * x;
        h[2] += gg * y;
        h[3] += gg * xx;
        h[4] += gg * xy;
        h[5] += gg * yy;
        h[6] += gg * xx * x;
        h[7] += gg * xx * y;
        h[8] += gg * yy * x;
        h[9] += gg * yy * y;
        h[10] += gg * xx * xx;
        h[11] += gg * xx * xy;
        h[12] += gg * xx * yy;
        h[13] += gg * yy * xy;
        h[14] += gg * yy * yy;
        T[i] = after;
    }
    for (int c = 0; c < 3; c++) {
        total->colour[c] += colour[c];
    }
    total->weight += weight;
    for (int k = 0; k < UNKNOWNS; k++) {
        total->gradient[k] += b[k];
    }
    for (int k = 0; k < MOMENTS; k++) {
        total->curvature[k] += h[k];
    }
}

static void load_tile(const splat_view *view, uint32_t left, uint32_t top, const float *rgb, const float *wanted,
                      const uint8_t *counts, tile *out)
{
    *out = (tile){0}; /* beyond the picture's border nothing counts */
    for (uint32_t j = 0; j < SPLAT_TILE && top + j < view->camera.height; j++) {
        for (uint32_t i = 0; i < SPLAT_TILE && left + i < view->camera.width; i++) {
            const size_t pixel = (size_t)(top + j) * view->camera.width + left + i;
            out->transmittance[j][i] = 1;
            for (size_t c = 0; c < 3; c++) {
                out->behind[j][c][i] = rgb[pixel * 3 + c];
                out->residual[j][c][i] = counts[pixel] ? wanted[pixel * 3 + c] - rgb[pixel * 3 + c] : 0;
            }
        }
    }
}

static void gather(const splat_view *view, const float *rgb, const float *wanted, const uint8_t *counts, sums *out)
{
    for (uint32_t n = 0; n < view->across * view->down; n++) {
        const uint32_t left = n % view->across * SPLAT_TILE, top = n / view->across * SPLAT_TILE;
        tile t;
        load_tile(view, left, top, rgb, wanted, counts, &t);
        for (uint32_t at = view->first[n]; at < view->first[n + 1]; at++) {
            const splat *s = &view->splats[view->list[at]];
            const axes a = axes_of(s->a, s->b, s->c);
            int32_t first, last;
            splat_rows(s, (int32_t)top, &first, &last);
            for (int32_t j = first; j <= last; j++) {
                add_row(s, &a, (float)left, (float)((int32_t)top + j) - s->y, t.transmittance[j], t.behind[j],
                        t.residual[j], &out[view->list[at]]);
            }
        }
    }
}

/* The damped normal equations in phi = (1, x, y, xx - 1/2, 2 xy, yy - 1/2), by Gaussian elimination; `squares`: the
 * diagonal without its damping. */
static void solve(const sums *s, float step[UNKNOWNS], float squares[UNKNOWNS])
{
    const float *h = s->curvature, *r = s->gradient;
    float m[UNKNOWNS][UNKNOWNS + 1] = {{h[0]},
                                       {h[1], h[3]},
                                       {h[2], h[4], h[5]},
                                       {h[3] - h[0] / 2, h[6] - h[1] / 2, h[7] - h[2] / 2, h[10] - h[3] + h[0] / 4},
                                       {2 * h[4], 2 * h[7], 2 * h[8], 2 * h[11] - h[4], 4 * h[12]},
                                       {h[5] - h[0] / 2, h[8] - h[1] / 2, h[9] - h[2] / 2,
                                        h[12] - h[3] / 2 - h[5] / 2 + h[0] / 4, 2 * h[13] - h[4],
                                        h[14] - h[5] + h[0] / 4}};
    const float right[UNKNOWNS] = {r[0], r[1], r[2], r[3] - r[0] / 2, 2 * r[4], r[5] - r[0] / 2};
    for (int i = 0; i < UNKNOWNS; i++) {
        for (int j = i + 1; j < UNKNOWNS; j++) {
            m[i][j] = m[j][i];
        }
        squares[i] = fmaxf(m[i][i], 0);
        m[i][i] = squares[i] * (1 + RELATIVE_DAMPING) + DAMPING;
        m[i][UNKNOWNS] = right[i];
    }
    for (int i = 0; i < UNKNOWNS; i++) { /* positive definite: no pivoting */
        for (int k = i + 1; k < UNKNOWNS; k++) {
            float f = m[k][i] / m[i][i];
            for (int j = i; j <= UNKNOWNS; j++) {
                m[k][j] -= f * m[i][j];
            }
        }
    }
    for (int i = UNKNOWNS - 1; i >= 0; i--) {
        float x = m[i][UNKNOWNS];
        for (int j = i + 1; j < UNKNOWNS; j++) {
            x -= m[i][j] * step[j];
        }
        step[i] = x / m[i][i];
    }
}

static float held(float x, float most)
{
    return x > most ? most : x < -most ? -most : x == x ? x : 0;
}

/* A pass's changes of one splat: red, green, blue; log opacity, shift along its two axes, log scale and shear; and the
 * share of the Gauss-Newton step that was taken. */
#define CHANGES (3 + UNKNOWNS + 1)
#define SHARE (3 + UNKNOWNS)

static float share_of(const float wanted[UNKNOWNS], const float squares[UNKNOWNS], const float before[CHANGES])
{
    float last = before[SHARE], again = 0, squared = 0;
    if (last == 0) {
        return SHARE_FIRST;
    }
    for (int k = 0; k < UNKNOWNS; k++) {
        again += squares[k] * before[3 + k] * held(wanted[k], ASKED_MOST);
        squared += squares[k] * before[3 + k] * before[3 + k];
    }
    if (!(squared > 0)) {
        return last;
    }
    float answered = squared - again * last;
    float share = answered > 0 ? last * squared / answered : 2 * last;
    return fminf(fmaxf(share, fmaxf(last / 4, SHARE_LEAST)), fminf(2 * last, SHARE_MOST));
}

/* Corrects a splat. `change`: the changes of the previous pass, 0 in the first; on return this pass's. */
static void correct(const sums *z, float *change, float *s)
{
    float before[CHANGES];
    memcpy(before, change, sizeof before);
    memset(change, 0, sizeof before);
    if (!(z->weight > 0)) {
        return;
    }
    float step[UNKNOWNS], squares[UNKNOWNS];
    solve(z, step, squares);
    step[0] -= (step[3] + step[5]) / 2;
    change[SHARE] = share_of(step, squares, before);
    const float most[UNKNOWNS] = {OPACITY_STEP_MOST, SHIFT_MOST, SHIFT_MOST, SHAPE_MOST, SHAPE_MOST, SHAPE_MOST};
    for (int c = 0; c < 3; c++) {
        change[c] = COLOUR_STEP * z->colour[c] / z->weight + MOMENTUM * before[c];
        s[6 + c] = fminf(fmaxf(s[6 + c] + change[c], 0), 1);
    }
    for (int k = 0; k < UNKNOWNS; k++) {
        change[3 + k] = held(held(change[SHARE] * step[k], most[k]) + MOMENTUM * before[3 + k], 0.5f);
    }
    const float *shift = change + 4;
    float a = change[6], b = change[7], c = change[8];
    axes l = axes_of(s[2], s[3], s[4]);
    s[0] += l.l11 * shift[0];
    s[1] += l.l21 * shift[0] + l.l22 * shift[1];
    s[5] = fminf(fmaxf(s[5] * expf(change[3]), fminf(s[5], 1 / 128.0f)), SPLAT_ALPHA_MOST);
    /* L (I + step), squared and dilated again */
    float t00 = l.l11 * (1 + a), t01 = l.l11 * b;
    float t10 = l.l21 * (1 + a) + l.l22 * b, t11 = l.l21 * b + l.l22 * (1 + c);
    float xx = t00 * t00 + t01 * t01 + DILATION, yy = t10 * t10 + t11 * t11 + DILATION;
    float xy = t00 * t10 + t01 * t11, det = xx * yy - xy * xy;
    s[2] = yy / det;
    s[3] = -xy / det;
    s[4] = xx / det;
}

/* Runs one pass of refinement: `rgb` is the output of splat_forward() for `splats`, which are corrected in place
 * towards `wanted`; `counts`, [pictures][height][width], is 0 for ignored pixels; `changes`, [splats][CHANGES], is
 * passed from pass to pass, 0 before the first; NULL: every pass is a first one. */
int splat_refine(int32_t pictures, uint32_t width, uint32_t height, const int32_t *start, float *splats,
                 const int32_t *order, const float *rgb, const float *wanted, const uint8_t *counts, float *changes)
{
    const batch of = {width, height, start, order};
    const size_t pixels = (size_t)width * height;
    int good = 1;
#pragma omp parallel for schedule(dynamic) reduction(&& : good)
    for (int32_t b = 0; b < pictures; b++) {
        const int32_t count = start[b + 1] - start[b];
        sums *totals = calloc((size_t)count + 1, sizeof *totals);
        splat_view view;
        if (open_view(&view, &of, b, splats) && totals != NULL) {
            gather(&view, rgb + b * 3 * pixels, wanted + b * 3 * pixels, counts + b * pixels, totals);
            for (int32_t n = 0; n < count; n++) {
                const size_t at = (size_t)(start[b] + n);
                float none[CHANGES] = {0};
                correct(&totals[n], changes != NULL ? changes + CHANGES * at : none, splats + PARAMETERS * at);
            }
        } else {
            good = 0;
        }
        splat_view_close(&view);
        free(totals);
    }
    return good;
}
