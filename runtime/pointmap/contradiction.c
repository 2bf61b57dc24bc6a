#include "contradiction.h"

#include "core/fixed.h"

/* Whether the pixel counts as evidence: measured pixels, or with `filled` all with depth. */
static bool counts(uint8_t validity, bool filled)
{
    return filled ? t3r_has_depth(validity) : t3r_is_measured(validity);
}

/* Whether the depth of `to` at the pixel is larger than z by more than 1/16. */
static bool is_behind(const t3r_pointmap *to, size_t pixel, int32_t z_q20)
{
    return 16 * ((int64_t)t3r_depth_q20(to->scale, to->view->depth[pixel]) - z_q20) > z_q20;
}

bool t3r_seen_through(const t3r_pointmap *to, const t3r_projected_pixel *projected, bool filled)
{
    const t3r_view *view = to->view;
    const int32_t z_q20 = projected->z_q20;
    if (!counts(view->validity[projected->pixel], filled) || !is_behind(to, projected->pixel, z_q20)) {
        return false; /* the usual case */
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

void t3r_find_contradicted(const t3r_contradictions *job, t3r_points *points, const t3r_unprojection *from)
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
