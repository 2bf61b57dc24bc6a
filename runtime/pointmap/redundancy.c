/* SPDX-License-Identifier: Apache-2.0 */
#include "redundancy.h"

#include <stdbool.h>

#include "core/fixed.h"
#include "reproject.h"

/* Whether the projected pixel's z / f is at most 17/16 of the pixel's own, or below 16/17 (redundancy.h).
 * Cross-multiplied: z < 2^31, f in Q8 < 2^23. */
static bool fine_enough(const t3r_view *view, int32_t z_q20, const t3r_view *other, int32_t other_z_q20, bool earlier)
{
    int64_t focal = ((int64_t)view->fx_q16 + view->fy_q16) >> 8;
    int64_t other_focal = ((int64_t)other->fx_q16 + other->fy_q16) >> 8;
    int64_t here = z_q20 * other_focal, there = other_z_q20 * focal;
    return earlier ? 16 * there <= 17 * here : 17 * there < 16 * here;
}

/* Whether the pixel of `to` shows the surface of a point that `from` has at depth z, finely enough to cover it. */
static bool covers(const t3r_pointmap *from, int32_t z_q20, const t3r_pointmap *to, uint32_t pixel,
                   int32_t projected_z_q20, bool earlier)
{
    uint8_t validity = to->view->validity[pixel];
    if (!t3r_is_measured(validity) || t3r_is_covered(validity) || t3r_is_doubtful(validity)) {
        return false;
    }
    int32_t there = t3r_depth_q20(to->scale, to->view->depth[pixel]);
    return t3r_is_one_surface(projected_z_q20, there, 32) &&
           fine_enough(from->view, z_q20, to->view, projected_z_q20, earlier);
}

typedef struct covered_job {
    t3r_pointmap maps[T3R_MAX_VIEWS];
    uint32_t count, v;
    const t3r_kernels *kernels;
    uint32_t *witness; /* for each pixel: (view x pixels of a view + pixel + 1) of the covering pixel, or 0 */
} covered_job;

/* Marks covered points, records the first covering view, and empties the batch. */
static void find_covered(const covered_job *job, t3r_points *points, const t3r_unprojection *unprojection)
{
    const t3r_pointmap *from = &job->maps[job->v];
    const t3r_view *view = from->view;
    const uint32_t pixels = view->width * view->height;
    job->kernels->unproject(unprojection, points);
    for (uint32_t w = 0; w < job->count; w++) {
        if (w == job->v) {
            continue;
        }
        const t3r_pinhole other = t3r_pinhole_of(job->maps[w].view);
        t3r_places places;
        job->kernels->locate(&other, points, &places);
        for (uint32_t i = 0; i < points->count; i++) {
            const size_t pixel = (size_t)points->v[i] * view->width + points->u[i];
            if (places.pixel[i] != T3R_NO_PIXEL && job->witness[pixel] == 0 &&
                covers(from, t3r_depth_q20(from->scale, points->depth[i]), &job->maps[w], places.pixel[i],
                       places.z_q20[i], w < job->v)) {
                view->validity[pixel] = t3r_marked(view->validity[pixel], T3R_MARK_COVERED);
                job->witness[pixel] = w * pixels + places.pixel[i] + 1; /* at most 2^4 x 2^24 */
            }
        }
    }
    points->count = 0;
}

/* Marks covered pixels of rows. Covering pixels are marked later, because they lie in other views, where another task
 * may mark the same byte. */
static void mark_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const covered_job *job = context;
    const t3r_view *view = job->maps[job->v].view;
    const t3r_unprojection from = t3r_unprojection_of(&job->maps[job->v]);
    t3r_points points = {0};
    for (uint32_t y = begin; y < end; y++) {
        for (uint32_t x = 0; x < view->width; x++) {
            const size_t pixel = (size_t)y * view->width + x;
            job->witness[pixel] = 0;
            if (t3r_is_known(view->validity[pixel])) {
                t3r_add_pixel(&points, view, x, y);
            }
            if (t3r_is_full(&points)) {
                find_covered(job, &points, &from);
            }
        }
        find_covered(job, &points, &from);
    }
}

uint32_t t3r_mark_covered(const t3r_view *views, uint32_t count, uint32_t v, int32_t exponent,
                          const t3r_pointmap_work *work)
{
    const uint32_t pixels = views[v].width * views[v].height;
    covered_job job = {.count = count, .v = v, .kernels = work->kernels, .witness = work->pixels};
    t3r_pointmaps_of(views, count, exponent, job.maps);
    t3r_run_rows(&work->workers, views[v].height, mark_rows, &job);
    uint32_t marked = 0;
    for (uint32_t i = 0; i < pixels; i++) {
        if (job.witness[i] != 0) {
            uint32_t w = (job.witness[i] - 1) / pixels;
            uint8_t *witness = &views[w].validity[job.witness[i] - 1 - w * pixels];
            *witness = t3r_marked(*witness, T3R_MARK_WITNESS);
            marked++;
        }
    }
    return marked;
}

void t3r_clear_witnesses(const t3r_view *views, uint32_t count)
{
    for (uint32_t v = 0; v < count; v++) {
        size_t pixels = (size_t)views[v].width * views[v].height;
        for (size_t i = 0; i < pixels; i++) {
            views[v].validity[i] &= (uint8_t)~T3R_MARK_WITNESS;
        }
    }
}
