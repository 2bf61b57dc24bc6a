/* SPDX-License-Identifier: Apache-2.0 */
#include "surroundings.h"

#include "core/cut.h"
#include "core/fixed.h"
#include "core/memory.h"
#include "surface.h"

/* Sweeps over the picture: down, up, down, up. Paths with more bends are found as longer ones. */
#define SWEEPS 4
/* Length of a straight and of a diagonal step to a neighbour, and of each level of luma on it. */
#define STRAIGHT 5
#define DIAGONAL 7
#define LEVEL 5
#define CELLS T3R_SURROUNDINGS_CELLS_
/* Two square pixels, so that a slope needs more than one row or column. */
#define SPREAD_Q4 32

_Static_assert(sizeof(t3r_surface_sums) == T3R_SURFACE_SUMS_BYTES_, "the arena's table knows the sums' size");

/* A view being filled. */
typedef struct filling {
    const t3r_view *view;
    uint32_t cell, columns, rows; /* side of a cell in pixels; numbers of cells, at most CELLS */
    t3r_surface_sums *sums;
    uint32_t *source; /* pixel whose depth is taken */
    uint16_t *cost;   /* length of the path from it; UINT16_MAX = none yet, or longer */
    uint8_t *luma;
} filling;

static bool shows(const t3r_view *view, size_t i)
{
    return (view->colour[0][i] | view->colour[1][i] | view->colour[2][i]) != 0;
}

/* ---- the nearest pixel with depth -------------------------------------------------------------------------------- */

void t3r_luma_of_view(const t3r_view *view, uint8_t *restrict luma)
{
    const size_t pixels = T3R_PIXELS_(view->width, view->height);
    const uint8_t *r = view->colour[0], *g = view->colour[1], *b = view->colour[2];
    for (size_t i = 0; i < pixels; i++) {
        luma[i] = (uint8_t)((77 * r[i] + 150 * g[i] + 29 * b[i] + 128) >> 8);
    }
}

static void begin(const filling *f)
{
    const size_t pixels = T3R_PIXELS_(f->view->width, f->view->height);
    const uint16_t *depth = f->view->depth;
    uint32_t *restrict source = f->source;
    uint16_t *restrict cost = f->cost;
    for (size_t i = 0; i < pixels; i++) {
        source[i] = (uint32_t)i;
        cost[i] = depth[i] != 0 ? 0 : UINT16_MAX;
    }
    t3r_luma_of_view(f->view, f->luma);
}

/* Gives pixel `to` the source of pixel `from`, if the path through it is shorter. */
static inline void offer(const filling *f, size_t to, size_t from, uint32_t step)
{
    const int32_t level = t3r_abs32((int32_t)f->luma[to] - f->luma[from]);
    const uint32_t cost = f->cost[from] + step + LEVEL * (uint32_t)level, own = f->cost[to];
    const uint32_t source = f->source[cost < own ? from : to];
    f->cost[to] = (uint16_t)T3R_MIN(cost, own);
    f->source[to] = source;
}

/* Sweeps a hole, pixels from..end - 1 of a row: from the sweep's last row, then along the row both ways. */
static void sweep_hole(const filling *f, size_t row, size_t before, uint32_t from, uint32_t end, bool first)
{
    const uint32_t width = f->view->width;
    for (uint32_t x = from; x < end && !first; x++) {
        offer(f, row + x, before + x, STRAIGHT);
        if (x > 0) {
            offer(f, row + x, before + x - 1, DIAGONAL);
        }
        if (x + 1 < width) {
            offer(f, row + x, before + x + 1, DIAGONAL);
        }
    }
    for (uint32_t x = T3R_MAX(from, 1); x < end; x++) {
        offer(f, row + x, row + x - 1, STRAIGHT);
    }
    for (uint32_t x = T3R_MIN(end, width - 1); x-- > from;) {
        offer(f, row + x, row + x + 1, STRAIGHT);
    }
}

/* Whether any of `count` pixels has no depth. */
static bool any_hole(const uint16_t *cost, uint32_t count)
{
    uint16_t any = 0;
    for (uint32_t i = 0; i < count; i++) {
        any |= cost[i];
    }
    return any != 0;
}

/* Sweeps one row. Pixels with depth have cost 0 and keep their depth, so each hole of the row is independent. */
static void sweep_row(const filling *f, uint32_t y, bool first, bool down)
{
    const uint32_t width = f->view->width;
    const size_t row = (size_t)y * width, before = down ? row - width : row + width; /* unused in the first row */
    const uint16_t *cost = f->cost + row;
    for (uint32_t x = 0; x < width; x++) {
        while (width - x > 16 && !any_hole(cost + x, 16)) {
            x += 16;
        }
        const uint32_t from = x;
        while (x < width && cost[x] != 0) {
            x++;
        }
        if (x > from) {
            sweep_hole(f, row, before, from, x, first);
        }
    }
}

/* ---- slopes ------------------------------------------------------------------------------------------------------ */

static size_t cell_of(const filling *f, uint32_t x, uint32_t y)
{
    return (size_t)(y / f->cell) * f->columns + x / f->cell;
}

/* Adds `count` pixels of a row of a cell; the first is x0 right of the cell's middle, all are y below it. */
static void sum_row(t3r_surface_sums *s, const uint16_t *depth, uint32_t count, int32_t x0, int64_t y)
{
    /* at most 2^9 pixels, |x| at most 2^8, i at most 2^24 */
    int32_t n = 0, x = 0, xx = 0;
    int64_t i = 0, xi = 0;
    for (uint32_t u = 0; u < count; u++) {
        if (depth[u] != 0) {
            const int32_t at = x0 + (int32_t)u;
            const int64_t inverse = t3r_inverse_depth_q30(depth[u]);
            n++;
            x += at;
            xx += at * at;
            i += inverse;
            xi += at * inverse;
        }
    }
    /* at most 2^18 pixels a cell: sums of x i below 2^50 */
    s->n += n;
    s->x += x;
    s->y += n * y;
    s->i += i;
    s->xx += xx;
    s->xy += x * y;
    s->yy += n * y * y;
    s->xi += xi;
    s->yi += i * y;
}

static void sum_cells(const filling *f)
{
    const t3r_view *view = f->view;
    const int32_t middle = (int32_t)f->cell / 2;
    memset(f->sums, 0, (size_t)f->columns * f->rows * sizeof *f->sums);
    for (uint32_t v = 0; v < view->height; v++) {
        const uint16_t *depth = view->depth + (size_t)v * view->width;
        for (uint32_t u = 0; u < view->width; u += f->cell) {
            sum_row(&f->sums[cell_of(f, u, v)], depth + u, T3R_MIN(f->cell, view->width - u), -middle,
                    (int32_t)(v % f->cell) - middle);
        }
    }
}

/* Adds the sums of another cell, relative to a place dx, dy away from its middle. */
static void add_moved(t3r_surface_sums *to, const t3r_surface_sums *s, int64_t dx, int64_t dy)
{
    to->n += s->n;
    to->x += s->x + s->n * dx;
    to->y += s->y + s->n * dy;
    to->i += s->i;
    to->xx += s->xx + 2 * dx * s->x + s->n * dx * dx;
    to->xy += s->xy + dx * s->y + dy * s->x + s->n * dx * dy;
    to->yy += s->yy + 2 * dy * s->y + s->n * dy * dy;
    to->xi += s->xi + dx * s->i;
    to->yi += s->yi + dy * s->i;
}

/* Fits a plane to one over depth in a cell and the eight around it, by least squares. */
static t3r_surface_slope fit(const filling *f, uint32_t column, uint32_t row)
{
    t3r_surface_sums s = {0};
    for (uint32_t r = row > 0 ? row - 1 : 0; r <= row + 1 && r < f->rows; r++) {
        for (uint32_t c = column > 0 ? column - 1 : 0; c <= column + 1 && c < f->columns; c++) {
            add_moved(&s, &f->sums[(size_t)r * f->columns + c], ((int64_t)c - column) * f->cell,
                      ((int64_t)r - row) * f->cell);
        }
    }
    /* n below 2^21.2, |x| below 2^9.6 */
    return s.n == 0 ? (t3r_surface_slope){0, 0} : t3r_surface_slope_of(&s, SPREAD_Q4);
}

/* ---- depth ------------------------------------------------------------------------------------------------------- */

/* Returns the depth at (u, v) of the plane through the source pixel, clamped to half and twice the pixel's depth. */
static uint16_t extend(const filling *f, const t3r_surface_slope *slopes, uint32_t u, uint32_t v)
{
    const t3r_view *view = f->view;
    const uint32_t source = f->source[(size_t)v * view->width + u];
    const uint32_t x = source % view->width, y = source / view->width;
    const t3r_surface_slope s = slopes[cell_of(f, x, y)];
    const int64_t own = t3r_inverse_depth_q30(view->depth[source]);
    /* Each cell has its slope. NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult) */
    const int64_t grown = ((int64_t)u - x) * s.x_q8 + ((int64_t)v - y) * s.y_q8; /* below 2^44 */
    const int64_t there = t3r_clamp64(own + t3r_round_shift64(grown, 8), (own + 1) / 2, 2 * own);
    return (uint16_t)t3r_clamp64(t3r_round_div64(view->depth[source] * own, there), 1, UINT16_MAX);
}

static void finish(const filling *f, t3r_depth_source source)
{
    const t3r_view *view = f->view;
    t3r_surface_slope slopes[CELLS * CELLS];
    for (uint32_t row = 0; row < f->rows; row++) {
        for (uint32_t column = 0; column < f->columns; column++) {
            slopes[(size_t)row * f->columns + column] = fit(f, column, row);
        }
    }
    for (uint32_t v = 0; v < view->height; v++) {
        for (uint32_t u = 0; u < view->width; u++) {
            const size_t i = (size_t)v * view->width + u;
            if (f->cost[i] == UINT16_MAX || f->cost[i] == 0) {
                continue; /* no source, or has depth */
            }
            if (shows(view, i)) {
                view->depth[i] = extend(f, slopes, u, v);
                view->validity[i] = (uint8_t)source;
            }
        }
    }
}

const uint16_t *t3r_fill_surroundings(const t3r_view *view, t3r_depth_source source, void *work)
{
    const size_t pixels = T3R_PIXELS_(view->width, view->height);
    t3r_cut cut = t3r_cut_of(work, T3R_SURROUNDINGS_BYTES_(view->width, view->height));
    filling f = {.view = view, .cost = t3r_take(&cut, pixels * sizeof *f.cost)};
    f.sums = t3r_take(&cut, T3R_SURROUNDINGS_CELLS_BYTES_);
    f.cell = (T3R_MAX(view->width, view->height) + CELLS - 1) / CELLS;
    f.columns = (view->width + f.cell - 1) / f.cell;
    f.rows = (view->height + f.cell - 1) / f.cell;
    f.source = t3r_take(&cut, pixels * sizeof *f.source);
    f.luma = t3r_take(&cut, pixels);
    begin(&f);
    sum_cells(&f);
    for (uint32_t sweep = 0; sweep < SWEEPS; sweep++) {
        for (uint32_t i = 0; i < view->height; i++) {
            sweep_row(&f, sweep % 2 == 0 ? i : view->height - 1 - i, i == 0, sweep % 2 == 0);
        }
    }
    finish(&f, source);
    return f.cost;
}
