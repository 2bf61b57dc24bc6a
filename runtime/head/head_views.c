#include "head_views.h"

#include "core/fixed.h"
#include "pointmap/exposure.h"

#define FUNCTION_OF(HEAD, name, function) [HEAD] = (function),
static t3r_head_rows *const heads[] = {T3R_HEADS(FUNCTION_OF)};
_Static_assert(sizeof heads / sizeof heads[0] == T3R_HEAD_COUNT, "a row in T3R_HEADS for each head");

/* A band is a view's rows `begin`..`end` - 1. */
typedef struct band {
    uint32_t view, begin, end;
    t3r_gaussian *out;
} band;

typedef struct band_job {
    const t3r_runtime *rt;
    const t3r_view *views;
    const t3r_budget_settings *settings;
    band bands[T3R_MAX_WORKERS]; /* of one round */
} band_job;

/* A worker's share of what lies between here and the scene: at least what the plan gives it. */
static size_t work_bytes(const t3r_runtime *rt)
{
    const size_t room = rt->offset[T3R_BUFFER_SCENE] - rt->offset[T3R_BUFFER_HEAD_WORK];
    return room / rt->config.workers / T3R_ARENA_ALIGN * T3R_ARENA_ALIGN;
}

static void *work_of(const t3r_runtime *rt, uint32_t worker)
{
    return (uint8_t *)t3r_buffer_at(rt, T3R_BUFFER_HEAD_WORK) + worker * work_bytes(rt);
}

t3r_head_input t3r_head_input_of(const t3r_runtime *rt, const t3r_view *views, uint32_t view_index,
                                 const t3r_budget_settings *settings)
{
    return (t3r_head_input){
        .kernels = &rt->kernels,
        .map = t3r_pointmap_of(&views[view_index], rt->frame.exponent),
        .view_index = view_index,
        .settings = settings,
        .clusters = t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS),
        .weights = rt->weights,
        .work = work_of(rt, 0),
        .work_bytes = work_bytes(rt),
        .unadapted = rt->ablation.unadapted != 0,
    };
}

/* Colours brought to the mean exposure. */
static void level(t3r_gaussian *gaussians, uint32_t count, const uint16_t gain_q14[3])
{
    for (uint32_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++) {
            gaussians[i].colour_q7[c] = t3r_level_q7(gaussians[i].colour_q7[c], gain_q14[c]);
        }
    }
}

static void make_band(void *context, uint32_t index, uint32_t worker)
{
    const band_job *job = context;
    const t3r_runtime *rt = job->rt;
    const band *b = &job->bands[index];
    t3r_head_input input = t3r_head_input_of(rt, job->views, b->view, job->settings);
    input.work = work_of(rt, worker);
    level(b->out, heads[rt->build.head](&input, b->begin, b->end, b->out), rt->gain_q14[b->view]);
}

static uint32_t count_retained(const t3r_view *view, uint32_t begin, uint32_t end)
{
    uint32_t count = 0;
    for (size_t i = (size_t)begin * view->width; i < (size_t)end * view->width; i++) {
        count += t3r_retained(view, i);
    }
    return count;
}

/* Bands of a view: with fewer views than workers, so many that all have work. */
static uint32_t bands_a_view(const t3r_runtime *rt, const t3r_workers *workers, uint32_t views)
{
    if (!t3r_is_parallel(workers) || rt->build.head == T3R_HEAD_MOMENT) { /* its sweeps take whole views */
        return 1;
    }
    return T3R_MIN((workers->count + views - 1) / views, rt->config.height);
}

/* The views first..end - 1; progress is reported when `asks`. */
static t3r_status make_views(band_job *job, uint32_t first, uint32_t end, bool asks, t3r_gaussian *out, uint32_t *made)
{
    const t3r_runtime *rt = job->rt;
    const t3r_workers workers = t3r_workers_of(rt);
    const uint32_t bands = bands_a_view(rt, &workers, end - first), total = (end - first) * bands;
    const uint32_t round = t3r_is_parallel(&workers) ? workers.count : 1; /* bands between two reports */
    *made = 0;
    for (uint32_t begin = 0; begin < total; begin += round) {
        const uint32_t count = T3R_MIN(round, total - begin);
        if (asks && !t3r_progress(rt, T3R_STAGE_HEAD, first + begin / bands, end)) {
            return T3R_ERR_CANCELLED;
        }
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t view = first + (begin + i) / bands;
            const t3r_share rows = t3r_share_of(job->views[view].height, (begin + i) % bands, bands);
            job->bands[i] = (band){view, rows.begin, rows.end, out + *made};
            *made += count_retained(&job->views[view], rows.begin, rows.end);
        }
        t3r_run_tasks(&workers, count, make_band, job);
    }
    return T3R_OK;
}

t3r_status t3r_views_to_gaussians(const t3r_runtime *rt, const t3r_view *views, const t3r_budget_settings *settings,
                                  t3r_gaussian *out, uint32_t *made)
{
    band_job job = {.rt = rt, .views = views, .settings = settings};
    return make_views(&job, 0, rt->views, true, out, made);
}

uint32_t t3r_view_to_gaussians(const t3r_runtime *rt, const t3r_view *views, uint32_t view_index,
                               const t3r_budget_settings *settings, t3r_gaussian *out)
{
    band_job job = {.rt = rt, .views = views, .settings = settings};
    uint32_t made;
    (void)make_views(&job, view_index, view_index + 1, false, out, &made);
    return made;
}
