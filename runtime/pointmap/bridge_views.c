/* SPDX-License-Identifier: Apache-2.0 */
/* Bridging across views: takes depth measured by other views, and checks bridges against them. */
#include "bridge.h"

#include <stdbool.h>

#include "core/fixed.h"
#include "reproject.h"

/* Returns the smallest depth step whose depth is at least z > 0, 0 when there is none. */
static uint16_t step_at(t3r_depth_scale scale, int32_t z_q20)
{
    if (t3r_depth_q20(scale, UINT16_MAX) < z_q20) {
        return 0;
    }
    /* the largest step reaches z, so z 2^shift is below its product of 2^48 and a half, and there is none below 1 */
    const uint64_t most = ((uint64_t)(uint32_t)z_q20 << scale.shift) + scale.mantissa - 1;
    const uint64_t half = scale.shift > 0 ? UINT64_C(1) << (scale.shift - 1) : 0;
    return (uint16_t)((most - half) / scale.mantissa);
}

/* Whether the pixel takes depth from other views. */
static bool takes_depth(const t3r_view *view, size_t pixel)
{
    return !t3r_has_depth(view->validity[pixel]) || t3r_is_lent(view->validity[pixel]);
}

/* Gives the pixel a depth from another view; of several points on it, the nearest. */
static void lend(const t3r_pointmap *to, size_t pixel, int32_t z_q20)
{
    const t3r_view *view = to->view;
    uint16_t step = step_at(to->scale, z_q20);
    if (step != 0 && (!t3r_has_depth(view->validity[pixel]) || step < view->depth[pixel])) {
        view->depth[pixel] = step;
        view->validity[pixel] = t3r_marked(T3R_BRIDGED, T3R_MARK_LENT);
    }
}

typedef struct lend_job {
    t3r_pointmap from, to;
    const t3r_kernels *kernels;
    uint32_t *place; /* for each pixel of `from`: the pixel that takes its depth, or T3R_NO_PIXEL */
} lend_job;

static void locate(const lend_job *job, const t3r_unprojection *from, t3r_points *points, t3r_places *places)
{
    const t3r_pinhole to = t3r_pinhole_of(job->to.view);
    job->kernels->unproject(from, points);
    job->kernels->locate(&to, points, places);
}

static void find_borrowers(const lend_job *job, const t3r_unprojection *from, t3r_points *points)
{
    t3r_places places;
    locate(job, from, points, &places);
    for (uint32_t i = 0; i < points->count; i++) {
        if (places.pixel[i] != T3R_NO_PIXEL && takes_depth(job->to.view, places.pixel[i])) {
            job->place[(size_t)points->v[i] * job->from.view->width + points->u[i]] = places.pixel[i];
        }
    }
    points->count = 0;
}

/* Finds the receiving pixels of all rows first: several pixels may fall on one, so depth is passed on only later. */
static void find_borrowing_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const lend_job *job = context;
    const t3r_view *view = job->from.view;
    const t3r_unprojection from = t3r_unprojection_of(&job->from);
    t3r_points points = {0};
    for (uint32_t y = begin; y < end; y++) {
        for (uint32_t x = 0; x < view->width; x++) {
            const size_t pixel = (size_t)y * view->width + x;
            job->place[pixel] = T3R_NO_PIXEL;
            if (t3r_is_reliable(view->validity[pixel])) {
                t3r_add_pixel(&points, view, x, y);
            }
            if (t3r_is_full(&points)) {
                find_borrowers(job, &from, &points);
            }
        }
        find_borrowers(job, &from, &points);
    }
}

static void lend_points(const lend_job *job, const t3r_unprojection *from, t3r_points *points)
{
    t3r_places places;
    locate(job, from, points, &places);
    for (uint32_t i = 0; i < points->count; i++) {
        lend(&job->to, places.pixel[i], places.z_q20[i]);
    }
    points->count = 0;
}

/* Passes depth on to the pixels of rows. */
static void lend_to_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const lend_job *job = context;
    const t3r_view *view = job->from.view;
    const t3r_unprojection from = t3r_unprojection_of(&job->from);
    const uint32_t width = job->to.view->width, first = begin * width, taken = (end - begin) * width;
    t3r_points points = {0};
    for (uint32_t y = 0; y < view->height; y++) {
        for (uint32_t x = 0; x < view->width; x++) {
            if (job->place[(size_t)y * view->width + x] - first < taken) { /* unsigned: other rows wrap and fail */
                t3r_add_pixel(&points, view, x, y);
            }
            if (t3r_is_full(&points)) {
                lend_points(job, &from, &points);
            }
        }
    }
    lend_points(job, &from, &points);
}

static bool has_holes(const t3r_view *view)
{
    const size_t pixels = (size_t)view->width * view->height;
    size_t pixel = 0;
    while (pixel < pixels && !takes_depth(view, pixel)) {
        pixel++;
    }
    return pixel < pixels;
}

void t3r_bridge_lend(const t3r_view *views, uint32_t count, uint32_t v, int32_t exponent, const t3r_pointmap_work *work)
{
    for (uint32_t w = 0; w < count && has_holes(&views[v]); w++) {
        lend_job job = {t3r_pointmap_of(&views[w], exponent), t3r_pointmap_of(&views[v], exponent), work->kernels,
                        work->pixels};
        if (w == v) {
            continue;
        }
        t3r_run_rows(&work->workers, views[w].height, find_borrowing_rows, &job);
        t3r_run_rows(&work->workers, views[v].height, lend_to_rows, &job);
    }
}

/* Returns the validity of a bridged pixel, or of one with another view's depth, after comparison with the pixel of view
 * `to` on which its point falls at depth z. */
static uint8_t judge(uint8_t validity, const t3r_pointmap *to, uint32_t pixel, int32_t z_q20, bool settled)
{
    uint8_t there = to->view->validity[pixel];
    bool known = t3r_is_known(there), bridged = t3r_is_bridged(there) && !t3r_is_marked(there);
    if (!known && !(settled && bridged)) {
        return validity;
    }
    int64_t behind = (int64_t)z_q20 - t3r_depth_q20(to->scale, to->view->depth[pixel]);
    if (known && 16 * -behind > z_q20) {
        return T3R_NO_DEPTH;
    }
    return 16 * t3r_abs64(behind) <= z_q20 ? t3r_marked(T3R_BRIDGED, T3R_MARK_COVERED) : validity;
}

typedef struct settle_job {
    t3r_pointmap maps[T3R_MAX_VIEWS];
    const t3r_kernels *kernels;
    uint32_t count, v, settled;
    uint32_t bridged[T3R_MAX_WORKERS]; /* one per worker */
} settle_job;

static void settle_points(settle_job *job, const t3r_unprojection *from, t3r_points *points, uint32_t worker)
{
    const t3r_view *view = job->maps[job->v].view;
    const uint32_t count = points->count;
    uint8_t validity[T3R_POINTS];
    for (uint32_t i = 0; i < count; i++) {
        const uint8_t before = view->validity[(size_t)points->v[i] * view->width + points->u[i]];
        validity[i] = t3r_is_lent(before) ? t3r_marked(T3R_BRIDGED, T3R_MARK_COVERED) : before;
    }
    job->kernels->unproject(from, points);
    for (uint32_t w = 0; w < job->count; w++) {
        if (w == job->v) {
            continue;
        }
        const t3r_pinhole other = t3r_pinhole_of(job->maps[w].view);
        const bool settled = (job->settled >> w & 1) != 0;
        t3r_places places;
        job->kernels->locate(&other, points, &places);
        for (uint32_t i = 0; i < count; i++) {
            if (t3r_has_depth(validity[i]) && places.pixel[i] != T3R_NO_PIXEL) {
                validity[i] = judge(validity[i], &job->maps[w], places.pixel[i], places.z_q20[i], settled);
            }
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        const size_t pixel = (size_t)points->v[i] * view->width + points->u[i];
        view->validity[pixel] = validity[i];
        view->depth[pixel] = t3r_has_depth(validity[i]) ? view->depth[pixel] : 0;
        job->bridged[worker] += t3r_has_depth(validity[i]) && !t3r_is_covered(validity[i]);
    }
    points->count = 0;
}

/* Reads and writes of the own view only the pixel itself, so rows are independent. */
static void settle_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    settle_job *job = context;
    const t3r_view *view = job->maps[job->v].view;
    const t3r_unprojection from = t3r_unprojection_of(&job->maps[job->v]);
    t3r_points points = {0};
    for (uint32_t y = begin; y < end; y++) {
        for (uint32_t x = 0; x < view->width; x++) {
            const uint8_t validity = view->validity[(size_t)y * view->width + x];
            if (t3r_is_bridged(validity) && !t3r_is_covered(validity)) {
                t3r_add_pixel(&points, view, x, y);
            }
            if (t3r_is_full(&points)) {
                settle_points(job, &from, &points, worker);
            }
        }
    }
    settle_points(job, &from, &points, worker);
}

uint32_t t3r_bridge_settle(const t3r_view *views, uint32_t count, uint32_t v, int32_t exponent, uint32_t settled,
                           const t3r_pointmap_work *work)
{
    settle_job job = {.kernels = work->kernels, .count = count, .v = v, .settled = settled};
    t3r_pointmaps_of(views, count, exponent, job.maps);
    t3r_run_rows(&work->workers, views[v].height, settle_rows, &job);
    uint32_t bridged = 0;
    for (uint32_t w = 0; w < work->workers.count; w++) {
        bridged += job.bridged[w];
    }
    return bridged;
}
