/* SPDX-License-Identifier: Apache-2.0 */
/* The differentiable splatter of the training: splats of an image plane, blended front to back, with derivatives.
 *
 * It draws the same pictures as runtime/raster (alpha = min(0.99, opacity exp(-q)), skipped below 1/255, pixels closed
 * below a transmittance of 1e-4), in float32. A splat is nine floats: centre x, y; conic a, b, c with q = (a dx^2 + 2 b
 * dx dy + c dy^2) / 2; opacity; red, green, blue. OpenMP threads draw the pictures of a batch, one thread per picture,
 * so that sums have one order and training is deterministic. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define SIDE 16
#define PARAMETERS 9
#define ALPHA_MOST 0.99f
#ifndef ALPHA_LEAST /* a test lowers it: the cut has no derivative */
#define ALPHA_LEAST (1.0f / 255.0f)
#endif
#define STOP 1e-4f

typedef struct picture {
    int32_t width, height, tiles_across, tiles;
    const float *splats;
    int32_t *first; /* tiles + 1 places in `list` */
    int32_t *list;  /* splats of each tile, front to back */
} picture;

typedef struct box {
    int32_t x0, y0, x1, y1; /* tiles, inclusive; x1 < x0: none */
} box;

static int32_t clamp_tile(float pixel, int32_t tiles)
{
    float t = floorf(pixel / SIDE);
    return t < 0 ? 0 : t > (float)(tiles - 1) ? tiles - 1 : (int32_t)t;
}

static box reach(const picture *p, const float *s)
{
    box none = {0, 0, -1, -1};
    float level = 2 * logf(s[5] / ALPHA_LEAST), det = s[2] * s[4] - s[3] * s[3];
    if (!(s[5] > ALPHA_LEAST) || !(det > 0)) {
        return none;
    }
    float rx = sqrtf(level * s[4] / det), ry = sqrtf(level * s[2] / det);
    if (s[0] + rx < 0 || s[1] + ry < 0 || s[0] - rx > p->width - 1 || s[1] - ry > p->height - 1) {
        return none;
    }
    int32_t down = p->tiles / p->tiles_across;
    return (box){clamp_tile(s[0] - rx, p->tiles_across), clamp_tile(s[1] - ry, down),
                 clamp_tile(s[0] + rx, p->tiles_across), clamp_tile(s[1] + ry, down)};
}

/* Bins the splats; 0 if out of memory. */
static int bin(picture *p, const int32_t *order, int32_t count)
{
    p->first = calloc((size_t)p->tiles + 2, sizeof *p->first);
    p->list = NULL;
    if (p->first == NULL) {
        return 0;
    }
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t n = 0; n < count; n++) {
            box b = reach(p, p->splats + (size_t)PARAMETERS * order[n]);
            for (int32_t y = b.y0; y <= b.y1; y++) {
                for (int32_t x = b.x0; x <= b.x1; x++) {
                    int32_t *at = &p->first[y * p->tiles_across + x + 2 - pass];
                    if (pass == 1) {
                        p->list[*at] = order[n];
                    }
                    (*at)++;
                }
            }
        }
        if (pass == 0) {
            for (int32_t t = 1; t <= p->tiles; t++) {
                p->first[t + 1] += p->first[t];
            }
            p->list = malloc(((size_t)p->first[p->tiles + 1] + 1) * sizeof *p->list);
            if (p->list == NULL) {
                free(p->first);
                return 0;
            }
        }
    }
    return 1;
}

typedef struct tile {
    float colour[3][SIDE][SIDE];
    float transmittance[SIDE][SIDE];
} tile;

/* Computes exp(-q) * opacity with the rasterizer's cuts, over a row of 16 pixels */
static inline void alphas(const float *s, float dy, float left, float transmittance[SIDE], float alpha[SIDE],
                          float decay[SIDE])
{
    for (int i = 0; i < SIDE; i++) {
        float dx = left + (float)i - s[0];
        float q = 0.5f * (s[2] * dx * dx + s[4] * dy * dy) + s[3] * dx * dy;
        float e = expf(-q);
        float a = s[5] * e;
        a = a > ALPHA_MOST ? ALPHA_MOST : a;
        a = a < ALPHA_LEAST || transmittance[i] < STOP ? 0.0f : a;
        alpha[i] = a;
        decay[i] = e;
    }
}

/* Computes the rows of the tile at `top` that the splat may reach. */
static void rows_of(const float *s, float top, int *first, int *last)
{
    float ry = sqrtf(2 * logf(s[5] / ALPHA_LEAST) * s[2] / (s[2] * s[4] - s[3] * s[3]));
    float a = ceilf(s[1] - ry - top), b = floorf(s[1] + ry - top);
    *first = a < 0 ? 0 : a > SIDE ? SIDE : (int)a;
    *last = b > SIDE - 1 ? SIDE - 1 : b < -1 ? -1 : (int)b;
}

static void draw_tile(const picture *p, int32_t t, tile *out)
{
    float left = (float)(t % p->tiles_across * SIDE), top = (float)(t / p->tiles_across * SIDE);
    memset(out->colour, 0, sizeof out->colour);
    for (int j = 0; j < SIDE; j++) {
        for (int i = 0; i < SIDE; i++) {
            out->transmittance[j][i] = 1.0f;
        }
    }
    for (int32_t n = p->first[t]; n < p->first[t + 1]; n++) {
        const float *s = p->splats + (size_t)PARAMETERS * p->list[n];
        int first, last;
        rows_of(s, top, &first, &last);
        for (int j = first; j <= last; j++) {
            float alpha[SIDE], decay[SIDE];
            float *T = out->transmittance[j];
            alphas(s, top + (float)j - s[1], left, T, alpha, decay);
            for (int i = 0; i < SIDE; i++) {
                float w = T[i] * alpha[i];
                out->colour[0][j][i] += w * s[6];
                out->colour[1][j][i] += w * s[7];
                out->colour[2][j][i] += w * s[8];
                T[i] -= w;
            }
        }
    }
}

static picture picture_of(int32_t width, int32_t height, const float *splats)
{
    int32_t across = (width + SIDE - 1) / SIDE, down = (height + SIDE - 1) / SIDE;
    return (picture){width, height, across, across * down, splats, NULL, NULL};
}

static void copy_tile(const picture *p, int32_t t, const tile *from, float *rgb)
{
    int32_t x0 = t % p->tiles_across * SIDE, y0 = t / p->tiles_across * SIDE;
    size_t plane = (size_t)p->width * p->height;
    for (int c = 0; c < 3; c++) {
        for (int32_t j = 0; j < SIDE && y0 + j < p->height; j++) {
            for (int32_t i = 0; i < SIDE && x0 + i < p->width; i++) {
                rgb[c * plane + (size_t)(y0 + j) * p->width + x0 + i] = from->colour[c][j][i];
            }
        }
    }
}

/* Draws `pictures` pictures of width x height. Splats of picture b are start[b]..start[b + 1] - 1 of `splats`; `order`
 * lists each picture's, front to back, counted from its start. rgb: [pictures][3][height][width]. 0 = out of memory. */
int splat_forward(int32_t pictures, int32_t width, int32_t height, const int32_t *start, const float *splats,
                  const int32_t *order, float *rgb)
{
    int good = 1;
#pragma omp parallel for schedule(dynamic) reduction(&& : good)
    for (int32_t b = 0; b < pictures; b++) {
        picture p = picture_of(width, height, splats + (size_t)PARAMETERS * start[b]);
        if (!bin(&p, order + start[b], start[b + 1] - start[b])) {
            good = 0;
            continue;
        }
        for (int32_t t = 0; t < p.tiles; t++) {
            tile out;
            draw_tile(&p, t, &out);
            copy_tile(&p, t, &out, rgb + (size_t)b * 3 * width * height);
        }
        free(p.first);
        free(p.list);
    }
    return good;
}

/* Loads a tile's pixels of a planar picture; zeros beyond the border. */
static void load_tile(const picture *p, int32_t t, const float *rgb, float out[3][SIDE][SIDE])
{
    int32_t x0 = t % p->tiles_across * SIDE, y0 = t / p->tiles_across * SIDE;
    size_t plane = (size_t)p->width * p->height;
    memset(out, 0, sizeof(float) * 3 * SIDE * SIDE);
    for (int c = 0; c < 3; c++) {
        for (int32_t j = 0; j < SIDE && y0 + j < p->height; j++) {
            for (int32_t i = 0; i < SIDE && x0 + i < p->width; i++) {
                out[c][j][i] = rgb[c * plane + (size_t)(y0 + j) * p->width + x0 + i];
            }
        }
    }
}

/* Draws the tile again and sums each splat's derivatives on the way. The colour behind a splat is the finished colour
 * minus the colour drawn so far, so no second walk back to front is needed: dC / d alpha = T c - (C - C_drawn) / (1 -
 * alpha). */
static void tile_backward(const picture *p, int32_t t, float final[3][SIDE][SIDE], float g[3][SIDE][SIDE], float *out)
{
    float left = (float)(t % p->tiles_across * SIDE), top = (float)(t / p->tiles_across * SIDE);
    float T[SIDE][SIDE];
    for (int j = 0; j < SIDE; j++) {
        for (int i = 0; i < SIDE; i++) {
            T[j][i] = 1.0f;
        }
    }
    for (int32_t n = p->first[t]; n < p->first[t + 1]; n++) {
        const float *s = p->splats + (size_t)PARAMETERS * p->list[n];
        float *d = out + (size_t)PARAMETERS * p->list[n];
        int first, last;
        rows_of(s, top, &first, &last);
        float sum[PARAMETERS] = {0};
        for (int j = first; j <= last; j++) {
            float alpha[SIDE], decay[SIDE];
            float dy = top + (float)j - s[1];
            alphas(s, dy, left, T[j], alpha, decay);
            float dr = 0, dg = 0, db = 0, dop = 0, dmx = 0, dmy = 0, da = 0, dbb = 0, dc = 0;
            for (int i = 0; i < SIDE; i++) {
                float w = T[j][i] * alpha[i];
                final[0][j][i] -= w * s[6]; /* from here on: the colour still behind */
                final[1][j][i] -= w * s[7];
                final[2][j][i] -= w * s[8];
                float front = g[0][j][i] * s[6] + g[1][j][i] * s[7] + g[2][j][i] * s[8];
                float behind = g[0][j][i] * final[0][j][i] + g[1][j][i] * final[1][j][i] + g[2][j][i] * final[2][j][i];
                float d_alpha = T[j][i] * front - behind / (1.0f - alpha[i]);
                float d_q = -d_alpha * alpha[i];
                d_alpha = alpha[i] == 0.0f || alpha[i] == ALPHA_MOST ? 0.0f : d_alpha;
                d_q = alpha[i] == 0.0f || alpha[i] == ALPHA_MOST ? 0.0f : d_q;
                float dx = left + (float)i - s[0];
                dr += w * g[0][j][i];
                dg += w * g[1][j][i];
                db += w * g[2][j][i];
                dop += d_alpha * decay[i];
                dmx -= d_q * (s[2] * dx + s[3] * dy);
                dmy -= d_q * (s[3] * dx + s[4] * dy);
                da += 0.5f * d_q * dx * dx;
                dbb += d_q * dx * dy;
                dc += 0.5f * d_q * dy * dy;
                T[j][i] -= w;
            }
            sum[0] += dmx;
            sum[1] += dmy;
            sum[2] += da;
            sum[3] += dbb;
            sum[4] += dc;
            sum[5] += dop;
            sum[6] += dr;
            sum[7] += dg;
            sum[8] += db;
        }
        for (int k = 0; k < PARAMETERS; k++) {
            d[k] += sum[k];
        }
    }
}

/* Computes derivatives of a loss with respect to every parameter, from its derivatives with respect to the picture;
 * `rgb` is the output of splat_forward(). gradient: like splats. */
int splat_backward(int32_t pictures, int32_t width, int32_t height, const int32_t *start, const float *splats,
                   const int32_t *order, const float *rgb, const float *rgb_gradient, float *gradient)
{
    int good = 1;
    size_t plane = (size_t)3 * width * height;
#pragma omp parallel for schedule(dynamic) reduction(&& : good)
    for (int32_t b = 0; b < pictures; b++) {
        picture p = picture_of(width, height, splats + (size_t)PARAMETERS * start[b]);
        float *out = gradient + (size_t)PARAMETERS * start[b];
        memset(out, 0, sizeof(float) * PARAMETERS * (size_t)(start[b + 1] - start[b]));
        if (!bin(&p, order + start[b], start[b + 1] - start[b])) {
            good = 0;
            continue;
        }
        for (int32_t t = 0; t < p.tiles; t++) {
            float final[3][SIDE][SIDE], g[3][SIDE][SIDE];
            load_tile(&p, t, rgb + b * plane, final);
            load_tile(&p, t, rgb_gradient + b * plane, g);
            tile_backward(&p, t, final, g, out);
        }
        free(p.first);
        free(p.list);
    }
    return good;
}

/* --- refinement -------------------------------------------------------------------------------------------------- */

/* Refines like runtime/refine/refine.c (runtime/SPEC.md, "Refinement"), but in floats: nothing is rounded, the six
 * equations are solved exactly, and a splat's own axes are any factor of its covariance, which suffices in one view. */
#define UNKNOWNS 6
#define MOMENTS 15
#define DILATION 0.3f
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

static axes axes_of(const float *s)
{
    float det = s[2] * s[4] - s[3] * s[3];
    float xx = fmaxf(s[4] / det - DILATION, VARIANCE_LEAST), xy = -s[3] / det;
    float yy = fmaxf(s[2] / det - DILATION, VARIANCE_LEAST);
    axes a;
    a.l11 = sqrtf(xx);
    a.l21 = xy / a.l11;
    a.l22 = sqrtf(fmaxf(yy - a.l21 * a.l21, VARIANCE_LEAST));
    a.k[0][0] = a.l11 * s[2] + a.l21 * s[3];
    a.k[0][1] = a.l11 * s[3] + a.l21 * s[4];
    a.k[1][0] = a.l22 * s[3];
    a.k[1][1] = a.l22 * s[4];
    return a;
}

static void add_row(const float *s, const axes *a, float left, float dy, float T[SIDE], float behind[3][SIDE],
                    float residual[3][SIDE], sums *total)
{
    float alpha[SIDE], decay[SIDE];
    alphas(s, dy, left, T, alpha, decay);
    float colour[3] = {0}, weight = 0, b[UNKNOWNS] = {0}, h[MOMENTS] = {0};
    for (int i = 0; i < SIDE; i++) {
        float w = T[i] * alpha[i], after = T[i] - w, gr = 0, gg = 0;
        for (int c = 0; c < 3; c++) {
            behind[c][i] -= w * s[6 + c];
            float g = w * (s[6 + c] - fminf(behind[c][i] / fmaxf(after, 1e-5f), 1.0f));
            gr += g * residual[c][i];
            gg += g * g;
            colour[c] += w * residual[c][i];
        }
        float dx = left + (float)i - s[0];
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

static void gather_tile(const picture *p, int32_t t, float behind[3][SIDE][SIDE], float residual[3][SIDE][SIDE],
                        sums *out)
{
    float left = (float)(t % p->tiles_across * SIDE), top = (float)(t / p->tiles_across * SIDE);
    float T[SIDE][SIDE];
    for (int j = 0; j < SIDE; j++) {
        for (int i = 0; i < SIDE; i++) { /* beyond the picture's border nothing counts */
            T[j][i] = left + (float)i < (float)p->width && top + (float)j < (float)p->height ? 1.0f : 0.0f;
        }
    }
    for (int32_t n = p->first[t]; n < p->first[t + 1]; n++) {
        const float *s = p->splats + (size_t)PARAMETERS * p->list[n];
        axes a = axes_of(s);
        int first, last;
        rows_of(s, top, &first, &last);
        for (int j = first; j <= last; j++) {
            float behind_row[3][SIDE], residual_row[3][SIDE];
            for (int c = 0; c < 3; c++) {
                memcpy(behind_row[c], behind[c][j], sizeof behind_row[c]);
                memcpy(residual_row[c], residual[c][j], sizeof residual_row[c]);
            }
            add_row(s, &a, left, top + (float)j - s[1], T[j], behind_row, residual_row, &out[p->list[n]]);
            for (int c = 0; c < 3; c++) {
                memcpy(behind[c][j], behind_row[c], sizeof behind_row[c]);
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
    axes l = axes_of(s);
    s[0] += l.l11 * shift[0];
    s[1] += l.l21 * shift[0] + l.l22 * shift[1];
    s[5] = fminf(fmaxf(s[5] * expf(change[3]), fminf(s[5], 1 / 128.0f)), ALPHA_MOST);
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
int splat_refine(int32_t pictures, int32_t width, int32_t height, const int32_t *start, float *splats,
                 const int32_t *order, const float *rgb, const float *wanted, const uint8_t *counts, float *changes)
{
    int good = 1;
    size_t pixels = (size_t)width * height;
#pragma omp parallel for schedule(dynamic) reduction(&& : good)
    for (int32_t b = 0; b < pictures; b++) {
        picture p = picture_of(width, height, splats + (size_t)PARAMETERS * start[b]);
        int32_t count = start[b + 1] - start[b];
        sums *totals = calloc((size_t)count + 1, sizeof *totals);
        if (totals == NULL || !bin(&p, order + start[b], count)) {
            free(totals);
            good = 0;
            continue;
        }
        for (int32_t t = 0; t < p.tiles; t++) {
            float behind[3][SIDE][SIDE], residual[3][SIDE][SIDE];
            load_tile(&p, t, rgb + b * 3 * pixels, behind);
            load_tile(&p, t, wanted + b * 3 * pixels, residual);
            int32_t x0 = t % p.tiles_across * SIDE, y0 = t / p.tiles_across * SIDE;
            for (int32_t j = 0; j < SIDE && y0 + j < height; j++) {
                for (int32_t i = 0; i < SIDE && x0 + i < width; i++) {
                    float says = counts[b * pixels + (size_t)(y0 + j) * width + x0 + i] ? 1 : 0;
                    for (int c = 0; c < 3; c++) {
                        residual[c][j][i] = says * (residual[c][j][i] - behind[c][j][i]);
                    }
                }
            }
            gather_tile(&p, t, behind, residual, totals);
        }
        for (int32_t n = 0; n < count; n++) {
            size_t at = (size_t)(start[b] + n);
            float none[CHANGES] = {0};
            correct(&totals[n], changes != NULL ? changes + CHANGES * at : none, splats + PARAMETERS * at);
        }
        free(totals);
        free(p.first);
        free(p.list);
    }
    return good;
}
