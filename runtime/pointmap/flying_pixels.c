#include "flying_pixels.h"

#include <stdbool.h>

#include "depth/depth.h"
#include "core/fixed.h"
#include "reproject.h"

static bool lies_between(const t3r_view *view, size_t pixel, size_t before, size_t after)
{
    uint16_t here = view->depth[pixel];
    if (t3r_same_surface(view->depth[before], here) || t3r_same_surface(here, view->depth[after])) {
        return false; /* as a rule */
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

/* Whether a pixel counts as evidence: measured ones do, with `filled` all with depth. */
static bool counts(uint8_t validity, bool filled)
{
    return filled ? t3r_has_depth(validity) : t3r_is_measured(validity);
}

/* Whether what `to` has at a pixel is deeper than z by more than 1/16. */
static bool is_behind(const t3r_pointmap *to, size_t pixel, int32_t z_q20)
{
    return 16 * ((int64_t)t3r_depth_q20(to->scale, to->view->depth[pixel]) - z_q20) > z_q20;
}

bool t3r_seen_through(const t3r_pointmap *to, const t3r_projected_pixel *projected, bool filled)
{
    const t3r_view *view = to->view;
    const int32_t z_q20 = projected->z_q20;
    if (!counts(view->validity[projected->pixel], filled) || !is_behind(to, projected->pixel, z_q20)) {
        return false; /* as a rule */
    }
    uint32_t u = (uint32_t)(projected->pixel % view->width), v = (uint32_t)(projected->pixel / view->width);
    if (u == 0 || v == 0 || u + 1 == view->width || v + 1 == view->height) {
        return false;
    }
    for (uint32_t y = v - 1; y <= v + 1; y++) {
        for (uint32_t x = u - 1; x <= u + 1; x++) {
            size_t pixel = (size_t)y * view->width + x;
            if (counts(view->validity[pixel], filled) && !is_behind(to, pixel, z_q20)) {
                return false;
            }
        }
    }
    return true;
}

typedef struct flying_job {
    t3r_pointmap maps[T3R_MAX_VIEWS];
    uint32_t count, v;
    bool guessed;
    const t3r_kernels *kernels;
    uint8_t *is_flying; /* of each pixel */
} flying_job;

/* Of the points those through which another view sees; then there are none. */
static void find_contradicted(const flying_job *job, t3r_points *points, const t3r_unprojection *from)
{
    const t3r_view *view = job->maps[job->v].view;
    job->kernels->unproject(from, points);
    for (uint32_t w = 0; w < job->count; w++) {
        if (w == job->v) {
            continue;
        }
        const t3r_pinhole other = t3r_pinhole_of(job->maps[w].view);
        t3r_places places;
        job->kernels->locate(&other, points, &places);
        for (uint32_t i = 0; i < points->count; i++) {
            const size_t pixel = (size_t)points->v[i] * view->width + points->u[i];
            if (places.pixel[i] != T3R_NO_PIXEL && job->is_flying[pixel] == 0) {
                const t3r_projected_pixel projected = {places.pixel[i], places.z_q20[i]};
                const bool filled = job->guessed && !t3r_is_measured(view->validity[pixel]);
                job->is_flying[pixel] = t3r_seen_through(&job->maps[w], &projected, filled);
            }
        }
    }
    points->count = 0;
}

/* Neighbours' validity is read here, so nothing is marked before all pixels are found. */
static void find_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const flying_job *job = context;
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
                find_contradicted(job, &points, &from);
            }
        }
        find_contradicted(job, &points, &from);
    }
}

uint32_t t3r_mark_flying(const t3r_view *views, uint32_t count, uint32_t v, int32_t exponent, bool guessed,
                         const t3r_pointmap_work *work)
{
    const t3r_view *view = &views[v];
    flying_job job = {
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
