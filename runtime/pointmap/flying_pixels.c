#include "flying_pixels.h"

#include <stdbool.h>

#include "depth/depth.h"
#include "core/fixed.h"
#include "contradiction.h"

static bool lies_between(const t3r_view *view, size_t pixel, size_t before, size_t after)
{
    uint16_t here = view->depth[pixel];
    if (t3r_same_surface(view->depth[before], here) || t3r_same_surface(here, view->depth[after])) {
        return false; /* the usual case */
    }
    if (!t3r_is_measured(view->validity[before]) || !t3r_is_measured(view->validity[after])) {
        return false;
    }
    uint16_t near = T3R_MIN(view->depth[before], view->depth[after]);
    uint16_t deep = T3R_MAX(view->depth[before], view->depth[after]);
    return near < here && here < deep;
}

static bool between_surfaces(const t3r_view *view, uint32_t x, uint32_t y)
{
    size_t pixel = (size_t)y * view->width + x;
    return t3r_is_measured(view->validity[pixel]) &&
           ((x > 0 && x + 1 < view->width && lies_between(view, pixel, pixel - 1, pixel + 1)) ||
            (y > 0 && y + 1 < view->height && lies_between(view, pixel, pixel - view->width, pixel + view->width)));
}

/* Finds the flying pixels of rows. Marks follow later, because this reads the validity of neighbours. */
static void find_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const t3r_contradictions *job = context;
    const t3r_view *view = job->maps[job->v].view;
    const t3r_unprojection from = t3r_unprojection_of(&job->maps[job->v]);
    t3r_points points = {0};
    for (uint32_t y = begin; y < end; y++) {
        for (uint32_t x = 0; x < view->width; x++) {
            const size_t pixel = (size_t)y * view->width + x;
            const bool is_bridged = t3r_is_bridged(view->validity[pixel]);
            job->is_flying[pixel] = !is_bridged && between_surfaces(view, x, y);
            if (t3r_has_depth(view->validity[pixel]) && !is_bridged && job->is_flying[pixel] == 0) {
                t3r_add_pixel(&points, view, x, y);
            }
            if (t3r_is_full(&points)) {
                t3r_find_contradicted(job, &points, &from);
            }
        }
        t3r_find_contradicted(job, &points, &from);
    }
}

uint32_t t3r_mark_flying(const t3r_view *views, uint32_t count, uint32_t v, int32_t exponent, bool guessed,
                         const t3r_pointmap_work *work)
{
    const t3r_view *view = &views[v];
    t3r_contradictions job = {
        .count = count, .v = v, .guessed = guessed, .kernels = work->kernels, .is_flying = (uint8_t *)work->pixels};
    t3r_pointmaps_of(views, count, exponent, job.maps);
    t3r_run_rows(&work->workers, view->height, find_rows, &job);
    uint32_t marked = 0;
    for (size_t i = 0; i < (size_t)view->width * view->height; i++) {
        view->validity[i] |= job.is_flying[i] != 0 ? T3R_MARK_DOUBTFUL : 0;
        marked += job.is_flying[i];
    }
    return marked;
}
