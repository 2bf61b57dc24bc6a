/* SPDX-License-Identifier: Apache-2.0 */
/* Validity of depth, and filling of small holes between measured pixels. */
#include "depth.h"

#include <stdbool.h>

#include "core/fixed.h"

void t3r_depth_validity(t3r_view *view)
{
    size_t count = (size_t)view->width * view->height;
    for (size_t i = 0; i < count; i++) {
        view->validity[i] = view->depth[i] != 0 ? T3R_MEASURED : T3R_NO_DEPTH;
    }
}

/* The measured pixels on both sides of a hole along one axis; gap = 0: none within reach. */
typedef struct bracket {
    size_t first, second;   /* their indices */
    uint32_t before, after; /* their distances, 1.. */
    uint32_t gap;           /* before + after */
} bracket;

/* Finds the bracket of a pixel. at: its index; step: distance of the next pixel on the axis; back, ahead: number of
 * pixels on either side. */
static bracket find_bracket(const uint8_t *validity, size_t at, size_t step, uint32_t back, uint32_t ahead,
                            uint32_t radius)
{
    bracket none = {0};
    bracket found = {0};

    for (uint32_t i = 1; i <= T3R_MIN(radius, back) && found.before == 0; i++) {
        if (t3r_is_reliable(validity[at - i * step])) {
            found.first = at - i * step;
            found.before = i;
        }
    }
    if (found.before == 0) {
        return none;
    }
    for (uint32_t i = 1; i <= T3R_MIN(radius, ahead) && found.after == 0; i++) {
        if (t3r_is_reliable(validity[at + i * step])) {
            found.second = at + i * step;
            found.after = i;
        }
    }
    if (found.after == 0) {
        return none;
    }
    found.gap = found.before + found.after;
    return found;
}

/* Returns |dr| + |dg| + |db|. */
static int32_t colour_distance(const t3r_view *view, size_t a, size_t b)
{
    int32_t sum = 0;
    for (uint32_t c = 0; c < 3; c++) {
        sum += t3r_abs32((int32_t)view->colour[c][a] - (int32_t)view->colour[c][b]);
    }
    return sum;
}

static uint16_t depth_between(const t3r_view *view, size_t at, const bracket *between)
{
    int32_t first = view->depth[between->first];
    int32_t second = view->depth[between->second];
    int32_t before = (int32_t)between->before;
    int32_t after = (int32_t)between->after;

    if (t3r_same_surface(view->depth[between->first], view->depth[between->second])) {
        return (uint16_t)t3r_round_div64((int64_t)first * after + (int64_t)second * before, before + after);
    }
    int32_t to_first = colour_distance(view, at, between->first);
    int32_t to_second = colour_distance(view, at, between->second);
    if (to_first == to_second) {
        return (uint16_t)(before <= after ? first : second);
    }
    return (uint16_t)(to_first < to_second ? first : second);
}

typedef struct fill_job {
    const t3r_view *view;
    uint32_t radius;
} fill_job;

/* Gives depths to the pixels of rows that have none, 0 where nothing brackets them. Validity follows later, because
 * this reads that of other rows. */
static void fill_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const fill_job *job = context;
    const t3r_view *view = job->view;
    const uint32_t width = view->width, height = view->height;
    for (uint32_t y = begin; y < end; y++) {
        for (uint32_t x = 0; x < width; x++) {
            size_t at = (size_t)y * width + x;
            if (t3r_has_depth(view->validity[at])) {
                continue;
            }
            bracket across = find_bracket(view->validity, at, 1, x, width - 1 - x, job->radius);
            bracket along = find_bracket(view->validity, at, width, y, height - 1 - y, job->radius);
            bool vertical = along.gap != 0 && (across.gap == 0 || along.gap < across.gap);
            const bracket *between = vertical ? &along : &across;
            view->depth[at] = between->gap != 0 ? depth_between(view, at, between) : 0;
        }
    }
}

static void mark_filled(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const fill_job *job = context;
    const t3r_view *view = job->view;
    for (size_t i = (size_t)begin * view->width; i < (size_t)end * view->width; i++) {
        const bool filled = !t3r_has_depth(view->validity[i]) && view->depth[i] != 0;
        view->validity[i] = filled ? T3R_FILLED : view->validity[i];
    }
}

void t3r_depth_fill(const t3r_view *view, uint32_t radius, const t3r_workers *workers)
{
    fill_job job = {view, radius};
    if (radius > 0) {
        t3r_run_rows(workers, view->height, fill_rows, &job);
        t3r_run_rows(workers, view->height, mark_filled, &job);
    }
}
