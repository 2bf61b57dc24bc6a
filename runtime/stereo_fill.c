#include "stereo_fill.h"

#include "fixed.h"
#include "stereo.h"

/* Sweeps over the picture: down, up, down, up. Ways with more bends than that are found as longer ones. */
#define SWEEPS 4
/* The length of a step to a neighbour, straight and diagonal, and of a level of luma on it. */
#define STRAIGHT 5
#define DIAGONAL 7
#define LEVEL 5

/* Planes of a view being filled. */
typedef struct filling {
    const t3r_view *view;
    uint16_t *cost; /* the length of the way to the pixel whose depth is taken; UINT16_MAX = none yet, or longer */
    uint8_t *luma;
} filling;

static bool shows(const t3r_view *view, size_t i)
{
    return (view->colour[0][i] | view->colour[1][i] | view->colour[2][i]) != 0;
}

static void begin(const filling *f)
{
    const t3r_view *view = f->view;
    const size_t pixels = T3R_PIXELS_(view->width, view->height);
    for (size_t i = 0; i < pixels; i++) {
        f->cost[i] = view->depth[i] != 0 ? 0 : UINT16_MAX;
        f->luma[i] =
            (uint8_t)((77 * view->colour[0][i] + 150 * view->colour[1][i] + 29 * view->colour[2][i] + 128) >> 8);
    }
}

/* Pixel `to` takes what pixel `from` has, if the way by it is shorter. */
static void offer(const filling *f, size_t to, size_t from, uint32_t step)
{
    const int32_t level = t3r_abs32((int32_t)f->luma[to] - f->luma[from]);
    const uint32_t cost = f->cost[from] + step + LEVEL * (uint32_t)level;
    if (cost < f->cost[to]) {
        f->cost[to] = (uint16_t)cost;
        f->view->depth[to] = f->view->depth[from];
    }
}

/* One row, from the row before it on the sweep and along itself both ways. */
static void sweep_row(const filling *f, uint32_t y, bool first, bool down)
{
    const uint32_t width = f->view->width;
    const size_t row = (size_t)y * width, before = down ? row - width : row + width; /* unused of the first */
    for (uint32_t x = 0; x < width && !first; x++) {
        offer(f, row + x, before + x, STRAIGHT);
        if (x > 0) {
            offer(f, row + x, before + x - 1, DIAGONAL);
        }
        if (x + 1 < width) {
            offer(f, row + x, before + x + 1, DIAGONAL);
        }
    }
    for (uint32_t x = 1; x < width; x++) {
        offer(f, row + x, row + x - 1, STRAIGHT);
    }
    for (uint32_t x = width - 1; x-- > 0;) {
        offer(f, row + x, row + x + 1, STRAIGHT);
    }
}

void t3r_stereo_fill(const t3r_view *view, void *work)
{
    const size_t pixels = T3R_PIXELS_(view->width, view->height);
    const filling f = {.view = view, .cost = work, .luma = (uint8_t *)work + pixels * sizeof(uint16_t)};
    begin(&f);
    for (uint32_t sweep = 0; sweep < SWEEPS; sweep++) {
        for (uint32_t i = 0; i < view->height; i++) {
            sweep_row(&f, sweep % 2 == 0 ? i : view->height - 1 - i, i == 0, sweep % 2 == 0);
        }
    }
    for (size_t i = 0; i < pixels; i++) {
        if (!shows(view, i)) {
            view->depth[i] = 0;
            view->confidence[i] = T3R_STEREO_NONE;
        } else if (view->depth[i] != 0 && view->confidence[i] == T3R_STEREO_NONE) {
            view->confidence[i] = T3R_STEREO_FILLED;
        }
    }
}
