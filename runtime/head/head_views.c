/* SPDX-License-Identifier: Apache-2.0 */
#include "head_views.h"

#include "core/bits.h"
#include "core/features.h"
#include "core/fixed.h"
#include "fitted_widths.h"
#include "pointmap/exposure.h"

#define FUNCTION_OF(HEAD, name, function) [HEAD] = (function),
static t3r_head_rows *const heads[] = {T3R_HEADS(FUNCTION_OF)};
_Static_assert(sizeof heads / sizeof heads[0] == T3R_HEAD_COUNT, "a row in T3R_HEADS for each head");

/* A band is a view's rows `begin`..`end` - 1, whose Gaussians begin at `place`. Small, because the stack holds many. */
typedef struct band {
    uint16_t view, begin, end;
    uint32_t place;
} band;
_Static_assert(T3R_MAX_SIDE <= UINT16_MAX, "a row fits");

typedef struct band_job {
    const t3r_runtime *rt;
    const t3r_view *views;
    const t3r_budget_settings *settings;
    t3r_gaussian *out;
    uint32_t first, end; /* views of the call, for the progress hook */
    t3r_covering_views covering;
    bool asks;      /* this thread may call the hook within a band, as it is the only one */
    bool stopped;   /* the hook has cancelled */
    uint32_t count; /* bands in one round: at most one view per worker, cut between the workers */
    band bands[2 * T3R_MAX_WORKERS];
} band_job;

/* Returns a worker's share of the memory up to the scene: at least the planned size. */
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
    const bool unadapted = t3r_is_unadapted(&rt->ablation);
    return (t3r_head_input){
        .kernels = &rt->kernels,
        .map = t3r_pointmap_of(&views[view_index], rt->frame.exponent),
        .view_index = view_index,
        .settings = settings,
        .clusters = t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS),
        .weights = rt->weights,
        .work = work_of(rt, 0),
        .work_bytes = work_bytes(rt),
        .narrowest_q12 = !unadapted && rt->build.refine > 0 ? T3R_NARROWEST_REFINED_Q12 : T3R_NARROWEST_Q12,
        .unadapted = unadapted,
    };
}

/* Scales colours to the mean exposure. */
static void level(t3r_gaussian *gaussians, uint32_t count, const uint16_t gain_q14[3])
{
    for (uint32_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++) {
            gaussians[i].colour_q7[c] = t3r_level_q7(gaussians[i].colour_q7[c], gain_q14[c]);
        }
    }
}

static bool goes_on(void *context)
{
    const band_job *job = context;
    return t3r_progress(job->rt, T3R_STAGE_HEAD, job->first, job->end);
}

/* Whether widths are fitted. Refinement finds better widths itself (docs/study/tuning.md). In a stream, retained
 * points of earlier keyframes may have left the map, and a head without adaptation has no spacing. */
static bool fits_widths(const t3r_runtime *rt)
{
    return T3R_FEATURE_COMPARISON && rt->config.fit_widths != 0 && rt->build.refine == 0 &&
           !t3r_is_stream(&rt->config) && !t3r_is_unadapted(&rt->ablation);
}

static void make_band(void *context, uint32_t index, uint32_t worker)
{
    band_job *job = context;
    const t3r_runtime *rt = job->rt;
    const band *b = &job->bands[index];
    t3r_head_input input = t3r_head_input_of(rt, job->views, b->view, job->settings);
    input.work = work_of(rt, worker);
    if (fits_widths(rt)) {
        input.covering = &job->covering;
    }
    if (job->asks) {
        input.goes_on = goes_on;
        input.context = job;
    }
    t3r_gaussian *out = job->out + b->place;
    const uint32_t made = heads[rt->build.head](&input, b->begin, b->end, out);
    if (made == T3R_HEAD_STOPPED) {
        job->stopped = true;
    } else {
        level(out, made, rt->gain_q14[b->view]);
    }
}

static uint32_t count_retained(const t3r_view *view, uint32_t row)
{
    const size_t begin = (size_t)row * view->width, last = begin + view->width - 1;
    uint32_t count = 0;
    for (size_t word = begin / 32; word <= last / 32; word++) {
        const uint32_t behind_begin = word == begin / 32 ? UINT32_MAX << begin % 32 : UINT32_MAX;
        const uint32_t up_to_last = word == last / 32 ? UINT32_MAX >> (31 - last % 32) : UINT32_MAX;
        count += t3r_ones(view->mask[word] & behind_begin & up_to_last);
    }
    return count;
}

/* Returns the fixed cost of a row in units of a retained point: a network computes every pixel. */
static uint32_t row_cost(const t3r_runtime *rt)
{
    return rt->build.head == T3R_HEAD_LEARNED ? rt->config.width / 6 : 1;
}

/* Cuts the views first..end - 1 into bands: at each view's end, and whenever another of `parts` equal parts of the
 * work is complete. `made`: number of earlier Gaussians; returns it with those of the bands. */
static uint32_t cut_bands(band_job *job, uint32_t first, uint32_t end, uint32_t parts, uint32_t made)
{
    const uint32_t cost = row_cost(job->rt);
    uint64_t total = 0, done = 0; /* 16 views of 2^24 pixels: below 2^30 */
    for (uint32_t v = first; v < end && parts > 1; v++) {
        for (uint32_t y = 0; y < job->views[v].height; y++) {
            total += cost + count_retained(&job->views[v], y);
        }
    }
    uint32_t full = 1;
    job->count = 0;
    for (uint32_t v = first; v < end; v++) {
        const uint32_t height = job->views[v].height;
        band b = {(uint16_t)v, 0, 0, made};
        for (uint32_t y = 0; y < height; y++) {
            const uint32_t retained = count_retained(&job->views[v], y);
            made += retained;
            done += cost + retained;
            const bool is_full = full < parts && done * parts >= total * full;
            full += is_full;
            if (is_full || y + 1 == height) {
                b.end = (uint16_t)(y + 1);
                job->bands[job->count++] = b;
                b = (band){b.view, b.end, 0, made};
            }
        }
    }
    return made;
}

/* Makes the Gaussians of the views first..end - 1; if `asks`, one worker reports progress before each row. */
static t3r_status make_views(band_job *job, uint32_t first, uint32_t end, bool asks, uint32_t *made)
{
    const t3r_runtime *rt = job->rt;
    const t3r_workers workers = t3r_workers_of(rt);
    const uint32_t round = t3r_is_parallel(&workers) ? workers.count : 1; /* views between two reports */
    if (fits_widths(rt)) {
        job->covering =
            (t3r_covering_views){job->views, rt->views, rt->frame.exponent,
                                 t3r_mean_density_q10(job->settings, t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS))};
    }
    job->asks = asks && !t3r_is_parallel(&workers);
    job->end = end;
    *made = 0;
    for (uint32_t begin = first; begin < end; begin += round) {
        if (asks && !t3r_progress(rt, T3R_STAGE_HEAD, begin, end)) {
            return T3R_ERR_CANCELLED;
        }
        job->first = begin;
        *made = cut_bands(job, begin, T3R_MIN(begin + round, end), round, *made);
        t3r_run_tasks(&workers, job->count, make_band, job);
        if (job->stopped) {
            return T3R_ERR_CANCELLED;
        }
    }
    return T3R_OK;
}

t3r_status t3r_views_to_gaussians(const t3r_runtime *rt, const t3r_view *views, const t3r_budget_settings *settings,
                                  t3r_gaussian *out, uint32_t *made)
{
    band_job job = {.rt = rt, .views = views, .settings = settings, .out = out};
    return make_views(&job, 0, rt->views, true, made);
}

uint32_t t3r_view_to_gaussians(const t3r_runtime *rt, const t3r_view *views, uint32_t view_index,
                               const t3r_budget_settings *settings, t3r_gaussian *out)
{
    band_job job = {.rt = rt, .views = views, .settings = settings, .out = out};
    uint32_t made;
    (void)make_views(&job, view_index, view_index + 1, false, &made);
    return made;
}
