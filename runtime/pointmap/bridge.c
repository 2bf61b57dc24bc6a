/* SPDX-License-Identifier: Apache-2.0 */
#include "bridge.h"

#include "core/fixed.h"
#include "core/memory.h"

/* Axes on which a hole is bracketed: its row, and three that lead to the rows above and below. */
#define AXES 4
#define SLANTED (AXES - 1)

/* Columns to the right, of the pixel in the row above, on the column and both diagonals; the other way below. */
static const int32_t upwards[SLANTED] = {0, -1, 1};

/* Holds the neighbours by which a pixel finds the ends of its hole. */
typedef struct reach {
    uint8_t ends;           /* 1: holes end here */
    uint8_t steps[SLANTED]; /* if not: from here to the first end above, 0 = none; on the way back below */
} reach;
_Static_assert(sizeof(reach) == sizeof(uint32_t), "the work memory has four bytes a pixel");

typedef struct bridge_job {
    const t3r_view *view;
    reach *reaches; /* one per pixel */
    uint32_t radius;
} bridge_job;

/* Whether the pixel ends a hole. Planes of a restored arena may hold anything, so known pixels count only with a
 * depth. */
static bool ends_hole(const t3r_view *view, size_t pixel)
{
    uint8_t validity = view->validity[pixel];
    return view->depth[pixel] != 0 && (t3r_is_known(validity) || t3r_is_lent(validity));
}

static void find_ends(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const bridge_job *job = context;
    const size_t width = job->view->width;
    for (size_t i = begin * width; i < end * width; i++) {
        job->reaches[i].ends = ends_hole(job->view, i);
    }
}

/* Returns the steps from (x, y) to the first end, 1..radius, or 0 if there is none. */
static uint8_t walk(const bridge_job *job, uint32_t x, uint32_t y, int32_t dx, int32_t dy)
{
    const uint32_t width = job->view->width, height = job->view->height;
    for (uint32_t i = 1; i <= job->radius; i++) {
        x += (uint32_t)dx; /* beyond the left or upper border it wraps to a large number */
        y += (uint32_t)dy;
        if (x >= width || y >= height) {
            return 0;
        }
        if (job->reaches[(size_t)y * width + x].ends != 0) {
            return (uint8_t)i;
        }
    }
    return 0;
}

/* Returns the same from the reach of the next pixel. */
static uint8_t step_from(const bridge_job *job, uint32_t axis, uint32_t x, uint32_t y)
{
    if (x >= job->view->width) { /* only inner rows of a task come here, so y is in the picture */
        return 0;
    }
    const reach *next = &job->reaches[(size_t)y * job->view->width + x];
    if (next->ends != 0) {
        return 1;
    }
    return next->steps[axis] == 0 || next->steps[axis] >= job->radius ? 0 : (uint8_t)(next->steps[axis] + 1);
}

/* Computes the steps to the rows above (dy -1) or below (1). begins: the next row is another task's. */
static void find_steps(const bridge_job *job, uint32_t x, uint32_t y, int32_t dy, bool begins, uint8_t steps[SLANTED])
{
    for (uint32_t k = 0; k < SLANTED; k++) {
        const int32_t dx = -dy * upwards[k];
        steps[k] = !begins              ? step_from(job, k, x + (uint32_t)dx, y + (uint32_t)dy)
                   : T3R_FEATURE_EXTRAS ? walk(job, x, y, dx, dy)
                                        : 0; /* one worker's task has all rows: nothing is beyond */
    }
}

/* Depth is interpolated as 1 / depth, which is linear on planes. */
static int64_t inverse_q36(uint16_t depth)
{
    return t3r_round_div64((int64_t)1 << 36, depth);
}

/* Returns the depth of a pixel from the ends of its hole, 0 without any: on each axis `before` and `after` steps away,
 * 0 = no end. */
static uint16_t depth_across(const uint16_t *pixel, ptrdiff_t width, const uint8_t before[AXES],
                             const uint8_t after[AXES])
{
    const ptrdiff_t step[AXES] = {-1, -width, -width - 1, -width + 1}; /* to the ends before the pixel */
    int64_t sum = 0, weights = 0; /* a weight is at most 2^22, an inverse 2^36: together below 2^60 */
    uint32_t narrowest = UINT32_MAX;
    uint16_t farther = 0;
    for (uint32_t k = 0; k < AXES; k++) {
        if (before[k] == 0 || after[k] == 0) {
            continue;
        }
        const uint32_t gap = before[k] + after[k], square = gap * gap * (k < 2 ? 1 : 2); /* squared length: 4..2^20 */
        const uint16_t a = pixel[step[k] * before[k]], b = pixel[-step[k] * after[k]];
        const uint16_t near = T3R_MIN(a, b), deep = T3R_MAX(a, b);
        if (8 * (deep - near) <= near) {
            const int64_t weight = t3r_round_div32(1 << 24, (int32_t)square);
            sum += weight * t3r_round_div64(inverse_q36(a) * after[k] + inverse_q36(b) * before[k], gap);
            weights += weight;
        }
        if (square < narrowest) {
            narrowest = square;
            farther = deep;
        }
    }
    /* a weighted mean of inverses lies between the inverses of 65,535 and of 1 */
    return weights == 0 ? farther : (uint16_t)t3r_round_div64(weights * ((int64_t)1 << 36), sum);
}

/* Returns the steps, or 0 if they are more than the radius. */
static uint8_t within(const bridge_job *job, uint32_t steps)
{
    return (uint8_t)(steps <= job->radius ? steps : 0);
}

/* Goes along a row whose reaches still lead upwards, and turns them downwards. last: the next row is another task's. */
static void bridge_row(const bridge_job *job, uint32_t y, bool last)
{
    const t3r_view *view = job->view;
    const size_t row = (size_t)y * view->width;
    uint32_t left = 0, next = 0; /* steps to the end on the left, 0 = none; column of the one on the right */
    for (uint32_t x = 0; x < view->width; x++) {
        reach *here = &job->reaches[row + x];
        if (here->ends != 0) {
            left = 1;
            continue;
        }
        while (next < view->width && (next < x || job->reaches[row + next].ends == 0)) {
            next++;
        }
        const uint32_t right = next < view->width ? next - x : 0;
        uint8_t before[AXES] = {within(job, left)}, after[AXES] = {within(job, right)};
        memcpy(before + 1, here->steps, sizeof here->steps);
        find_steps(job, x, y, 1, last, after + 1);
        memcpy(here->steps, after + 1, sizeof here->steps);
        if (!t3r_has_depth(view->validity[row + x])) {
            const uint16_t depth = depth_across(&view->depth[row + x], (ptrdiff_t)view->width, before, after);
            if (depth != 0) {
                view->depth[row + x] = depth;
                view->validity[row + x] = T3R_BRIDGED;
            }
        }
        left += left > 0;
    }
}

/* Sweeps down the rows, then up: each pixel's reach follows from its neighbours'. Only the first and the last row of a
 * task look for ends in rows of others. */
static void sweep_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const bridge_job *job = context;
    const uint32_t width = job->view->width;
    for (uint32_t y = begin; y < end; y++) {
        for (uint32_t x = 0; x < width; x++) {
            reach *here = &job->reaches[(size_t)y * width + x];
            if (here->ends == 0) {
                find_steps(job, x, y, -1, y == begin, here->steps);
            }
        }
    }
    for (uint32_t y = end; y-- > begin;) {
        bridge_row(job, y, y + 1 == end);
    }
}

void t3r_bridge_view(const t3r_view *view, uint32_t radius, const t3r_pointmap_work *work)
{
    if (radius > 0) {
        bridge_job job = {view, (reach *)(void *)work->pixels, radius};
        t3r_run_rows(&work->workers, view->height, find_ends, &job);
        t3r_run_rows(&work->workers, view->height, sweep_rows, &job);
    }
}
