#include "redundancy.h"

#include <stdbool.h>

#include "core/fixed.h"
#include "reproject.h"

/* z / f of the projected pixel against the pixel's own, cross-multiplied: z < 2^31, f in Q8 < 2^23. */
static bool fine_enough(const t3r_view *view, int32_t z_q20, const t3r_view *other, int32_t other_z_q20, bool earlier)
{
    int64_t focal = ((int64_t)view->fx_q16 + view->fy_q16) >> 8;
    int64_t other_focal = ((int64_t)other->fx_q16 + other->fy_q16) >> 8;
    int64_t here = z_q20 * other_focal, there = other_z_q20 * focal;
    return earlier ? 16 * there <= 17 * here : 17 * there < 16 * here;
}

static bool same_surface_q20(int32_t a, int32_t b)
{
    return 32 * t3r_abs64((int64_t)a - b) <= T3R_MIN(a, b);
}

static bool covers(const t3r_pointmap *from, uint32_t x, uint32_t y, const t3r_pointmap *to, bool earlier,
                   t3r_projected_pixel *projected)
{
    if (!t3r_reproject(from, x, y, to, projected)) {
        return false;
    }
    uint8_t validity = to->view->validity[projected->pixel];
    if (!t3r_is_measured(validity) || t3r_is_covered(validity) || t3r_is_doubtful(validity)) {
        return false;
    }
    int32_t there = t3r_depth_q20(to->scale, to->view->depth[projected->pixel]);
    int32_t z = t3r_depth_q20(from->scale, from->view->depth[(size_t)y * from->view->width + x]);
    return same_surface_q20(projected->z_q20, there) && fine_enough(from->view, z, to->view, projected->z_q20, earlier);
}

typedef struct covered_job {
    t3r_pointmap maps[T3R_MAX_VIEWS];
    uint32_t count, v;
    uint32_t *witness; /* of each pixel the one that covers it: view x pixels of a view + pixel + 1, or 0 */
} covered_job;

/* Marks what is covered. The witnesses lie in other views, where another task may mark the same byte: later. */
static void mark_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const covered_job *job = context;
    const t3r_view *view = job->maps[job->v].view;
    const uint32_t pixels = view->width * view->height;
    for (uint32_t y = begin; y < end; y++) {
        for (uint32_t x = 0; x < view->width; x++) {
            const size_t pixel = (size_t)y * view->width + x;
            job->witness[pixel] = 0;
            for (uint32_t w = 0; w < job->count && job->witness[pixel] == 0; w++) {
                t3r_projected_pixel projected;
                if (w != job->v && t3r_is_known(view->validity[pixel]) &&
                    covers(&job->maps[job->v], x, y, &job->maps[w], w < job->v, &projected)) {
                    view->validity[pixel] = t3r_marked(view->validity[pixel], T3R_MARK_COVERED);
                    job->witness[pixel] = w * pixels + (uint32_t)projected.pixel + 1; /* at most 2^4 x 2^24 */
                }
            }
        }
    }
}

uint32_t t3r_mark_covered(const t3r_view *views, uint32_t count, uint32_t v, int32_t exponent,
                          const t3r_pointmap_work *work)
{
    const uint32_t pixels = views[v].width * views[v].height;
    covered_job job = {.count = count, .v = v, .witness = work->pixels};
    t3r_pointmaps_of(views, count, exponent, job.maps);
    t3r_run_rows(&work->workers, views[v].height, mark_rows, &job);
    uint32_t marked = 0;
    for (uint32_t i = 0; i < pixels; i++) {
        if (job.witness[i] != 0) {
            uint8_t *witness = &views[(job.witness[i] - 1) / pixels].validity[(job.witness[i] - 1) % pixels];
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
