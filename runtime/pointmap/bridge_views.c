/* SPDX-License-Identifier: Apache-2.0 */
/* Bridging across views: takes depth measured by other views, and checks bridges against them. */
#include "bridge.h"

#include <stdbool.h>

#include "core/fixed.h"
#include "reproject.h"

/* Returns the smallest depth step whose depth is at least z, 0 when there is none. Depth rises with the step. */
static uint16_t step_at(t3r_depth_scale scale, int32_t z_q20)
{
    uint32_t low = 0, high = UINT16_MAX + 1u;
    while (high - low > 1) {
        uint32_t middle = (low + high) / 2;
        if (t3r_depth_q20(scale, (uint16_t)middle) >= z_q20) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return (uint16_t)high;
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

static void find_borrowers(const lend_job *job, t3r_points *points, const t3r_unprojection *from)
{
    const t3r_pinhole to = t3r_pinhole_of(job->to.view);
    t3r_places places;
    job->kernels->unproject(from, points);
    job->kernels->locate(&to, points, &places);
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
                find_borrowers(job, &points, &from);
            }
        }
        find_borrowers(job, &points, &from);
    }
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
        for (uint32_t y = 0; y < views[w].height; y++) {
            for (uint32_t x = 0; x < views[w].width; x++) {
                t3r_projected_pixel projected;
                if (job.place[(size_t)y * views[w].width + x] != T3R_NO_PIXEL &&
                    t3r_reproject(&job.from, x, y, &job.to, &projected)) {
                    lend(&job.to, projected.pixel, projected.z_q20);
                }
            }
        }
    }
}

/* Returns the validity of a bridged pixel, or of one with another view's depth, after comparison with view `to`. */
static uint8_t judge(uint8_t validity, const t3r_pointmap *to, const t3r_projected_pixel *projected, bool settled)
{
    uint8_t there = to->view->validity[projected->pixel];
    bool known = t3r_is_known(there), bridged = t3r_is_bridged(there) && !t3r_is_marked(there);
    if (!known && !(settled && bridged)) {
        return validity;
    }
    int64_t behind = (int64_t)projected->z_q20 - t3r_depth_q20(to->scale, to->view->depth[projected->pixel]);
    if (known && 16 * -behind > projected->z_q20) {
        return T3R_NO_DEPTH;
    }
    return 16 * t3r_abs64(behind) <= projected->z_q20 ? t3r_marked(T3R_BRIDGED, T3R_MARK_COVERED) : validity;
}

typedef struct settle_job {
    t3r_pointmap maps[T3R_MAX_VIEWS];
    uint32_t count, v, settled;
    uint32_t bridged[T3R_MAX_WORKERS]; /* one per worker */
} settle_job;

/* Reads and writes of the own view only the pixel itself, so rows are independent. */
static void settle_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    settle_job *job = context;
    const t3r_view *view = job->maps[job->v].view;
    for (uint32_t y = begin; y < end; y++) {
        for (uint32_t x = 0; x < view->width; x++) {
            size_t pixel = (size_t)y * view->width + x;
            uint8_t validity = view->validity[pixel];
            if (!t3r_is_bridged(validity) || t3r_is_covered(validity)) {
                continue;
            }
            if (t3r_is_lent(validity)) {
                validity = t3r_marked(T3R_BRIDGED, T3R_MARK_COVERED);
            }
            for (uint32_t w = 0; w < job->count && t3r_has_depth(validity); w++) {
                t3r_projected_pixel projected;
                if (w != job->v && t3r_reproject(&job->maps[job->v], x, y, &job->maps[w], &projected)) {
                    validity = judge(validity, &job->maps[w], &projected, (job->settled >> w & 1) != 0);
                }
            }
            view->validity[pixel] = validity;
            view->depth[pixel] = t3r_has_depth(validity) ? view->depth[pixel] : 0;
            job->bridged[worker] += t3r_has_depth(validity) && !t3r_is_covered(validity);
        }
    }
}

uint32_t t3r_bridge_settle(const t3r_view *views, uint32_t count, uint32_t v, int32_t exponent, uint32_t settled,
                           const t3r_pointmap_work *work)
{
    settle_job job = {.count = count, .v = v, .settled = settled};
    t3r_pointmaps_of(views, count, exponent, job.maps);
    t3r_run_rows(&work->workers, views[v].height, settle_rows, &job);
    uint32_t bridged = 0;
    for (uint32_t w = 0; w < work->workers.count; w++) {
        bridged += job.bridged[w];
    }
    return bridged;
}
