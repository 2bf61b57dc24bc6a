/* SPDX-License-Identifier: Apache-2.0 */
#include "stages.h"

#include "core/cut.h"
#include "core/features.h"
#include "core/memory.h"
#include "depth/depth.h"
#include "depth/surroundings.h"
#include "head/backdrop.h"
#include "pointmap/align.h"
#include "pointmap/bridge.h"
#include "pointmap/flying_pixels.h"
#include "pointmap/pointmap.h"
#include "pointmap/scene_scale.h"
#include "stage_hash.h"
#include "stereo/stereo_views.h"
#include "wavelet/wavelet.h"

static t3r_status fill_views(const t3r_runtime *rt, const t3r_view *views, t3r_view_span span)
{
    const t3r_workers workers = t3r_workers_of(rt);
    for (uint32_t v = span.first; v < span.end; v++) {
        if (!t3r_progress(rt, T3R_STAGE_DEPTH, v - span.first, span.end - span.first)) {
            return T3R_ERR_CANCELLED;
        }
        if (!t3r_is_reused(rt, v)) {
            t3r_depth_fill(&views[v], rt->config.fill_radius, &workers);
        }
    }
    return T3R_OK;
}

t3r_status t3r_find_depth(t3r_runtime *rt, t3r_view *views, t3r_view_span span)
{
    t3r_status status = T3R_OK;
    if (!t3r_is_by_stereo(&rt->config)) {
        status = fill_views(rt, views, span);
    } else if (!t3r_stereo_take(rt, views)) { /* stereo fills its own holes */
        status = t3r_stereo_views(rt, views);
    }
    if (status == T3R_OK) {
        t3r_hash_depth(rt, views, span.first, span.end);
    }
    return status;
}

/* Chooses the frame, which is all that the pointmap needs besides depth and pose. */
t3r_status t3r_choose_frame(t3r_runtime *rt, t3r_view *views)
{
    t3r_scene_frame frame = rt->frame;
    for (int i = 0; i < 3; i++) {
        frame.origin_q32[i] = rt->camera[0].position_q32[i];
    }
    const t3r_pointmap_work work = t3r_pointmap_work_of(rt);
    t3r_status status = t3r_scene_scale_choose(views, rt->views, &work, &frame.exponent, &rt->median_depth_q20);
    if (!rt->reuse.centres) {
        rt->frame = frame;
    }
    for (uint32_t v = 0; v < rt->views && status == T3R_OK; v++) {
        status = t3r_pose_in_scene(&rt->camera[v], &rt->frame, &views[v].pose);
    }
    return status;
}

static uint32_t align_steps(const t3r_runtime *rt)
{
    return t3r_aligns(&rt->config) && rt->views > 1 ? T3R_ALIGN_STEPS : 0;
}

static uint32_t step_of(const t3r_runtime *rt, t3r_view_span span, t3r_pointmap_part part, uint32_t done)
{
    return align_steps(rt) + part * (span.end - span.first) + done;
}

uint32_t t3r_pointmap_steps(const t3r_runtime *rt, t3r_view_span span)
{
    return step_of(rt, span, T3R_PART_COUNT, 0);
}

bool t3r_pointmap_step(const t3r_runtime *rt, t3r_view_span span, t3r_pointmap_part part, uint32_t done)
{
    return t3r_progress(rt, T3R_STAGE_POINTMAP, step_of(rt, span, part, done), t3r_pointmap_steps(rt, span));
}

/* Bridges a sensor's holes, and guesses what stays. Stereo has filled its own: pixels that it left without depth show
 * nothing. */
t3r_status t3r_bridge_holes(t3r_runtime *rt, t3r_view *views, t3r_view_span span)
{
    if (t3r_is_by_stereo(&rt->config) || rt->config.bridge_radius == 0) {
        return T3R_OK;
    }
    const t3r_pointmap_work work = t3r_pointmap_work_of(rt);
    for (uint32_t v = span.first; v < span.end && T3R_FEATURE_COMPARISON; v++) {
        if (!t3r_pointmap_step(rt, span, T3R_PART_LEND, v - span.first)) {
            return T3R_ERR_CANCELLED;
        }
        if (!t3r_is_reused(rt, v)) {
            t3r_bridge_lend(views, rt->views, v, rt->frame.exponent, &work);
        }
    }
    for (uint32_t v = span.first; v < span.end; v++) {
        if (!t3r_pointmap_step(rt, span, T3R_PART_BRIDGE, v - span.first)) {
            return T3R_ERR_CANCELLED;
        }
        if (!t3r_is_reused(rt, v)) {
            t3r_bridge_view(&views[v], rt->config.bridge_radius, &work);
            if (t3r_guesses(&rt->config)) {
                (void)t3r_fill_surroundings(&views[v], T3R_BRIDGED, t3r_buffer_at(rt, T3R_BUFFER_POINTMAP_WORK));
            }
        }
    }
    for (uint32_t v = span.first; v < span.end && T3R_FEATURE_COMPARISON; v++) {
        if (!t3r_pointmap_step(rt, span, T3R_PART_SETTLE, v - span.first)) {
            return T3R_ERR_CANCELLED;
        }
        const uint32_t open = (1u << span.end) - (1u << v); /* this view and the following ones */
        const uint32_t settled = ~open | (rt->reuse.views & ~(1u << v));
        (void)t3r_bridge_settle(views, rt->views, v, rt->frame.exponent, settled, &work);
    }
    return T3R_OK;
}

t3r_status t3r_find_flying_pixels(t3r_runtime *rt, t3r_view *views, t3r_view_span span)
{
    const t3r_pointmap_work work = t3r_pointmap_work_of(rt);
    for (uint32_t v = span.first; v < span.end && rt->config.flying; v++) {
        if (!t3r_pointmap_step(rt, span, T3R_PART_FLYING_PIXELS, v - span.first)) {
            return T3R_ERR_CANCELLED;
        }
        if (!t3r_is_reused(rt, v)) {
            (void)t3r_mark_flying(views, rt->views, v, rt->frame.exponent, t3r_is_by_stereo(&rt->config), &work);
        }
    }
    return T3R_OK;
}

typedef struct views_job {
    const t3r_runtime *rt;
    t3r_view *views;
    uint32_t first; /* view of the task of index 0 */
} views_job;

/* Measures in the worker's own plane and work memory. */
static void measure_texture(const t3r_runtime *rt, const t3r_view *view, uint32_t worker)
{
    const t3r_config *config = &rt->config;
    const size_t bytes = T3R_WAVELET_WORK_BYTES_(config->width, config->height);
    t3r_cut cut = t3r_cut_of((uint8_t *)t3r_buffer_at(rt, T3R_BUFFER_WAVELET_WORK) + worker * bytes, bytes);
    int16_t *plane = t3r_take(&cut, T3R_PIXELS_(config->width, config->height) * sizeof *plane);
    int16_t *work = t3r_take(&cut, T3R_WAVELET_ROW_BYTES(config->width));
    t3r_wavelet_texture(&rt->kernels, (const uint8_t *const *)view->colour, config->width, config->height,
                        config->levels, config->wavelet, view->texture, plane, work);
}

static void view_texture(void *context, uint32_t index, uint32_t worker)
{
    const views_job *job = context;
    const t3r_runtime *rt = job->rt;
    const uint32_t v = job->first + index;
    const size_t bytes = T3R_PIXELS_(rt->config.width, rt->config.height) * sizeof(uint16_t);
    if (t3r_is_reused(rt, v)) {
        memcpy(job->views[v].texture, t3r_kept_texture(rt, v), bytes);
        return;
    }
    measure_texture(rt, &job->views[v], worker);
    if (t3r_is_warm(&rt->config)) {
        memcpy(t3r_kept_texture(rt, v), job->views[v].texture, bytes);
    }
}

t3r_status t3r_find_texture(t3r_runtime *rt, t3r_view *views, t3r_view_span span)
{
    const t3r_workers workers = t3r_workers_of(rt);
    const uint32_t round = t3r_is_parallel(&workers) ? workers.count : 1; /* one view per worker at a time */
    for (uint32_t v = span.first; v < span.end; v += round) {
        if (!t3r_progress(rt, T3R_STAGE_WAVELET, v - span.first, span.end - span.first)) {
            return T3R_ERR_CANCELLED;
        }
        views_job job = {rt, views, v};
        t3r_run_tasks(&workers, T3R_MIN(round, span.end - v), view_texture, &job);
    }
    t3r_hash_wavelet(rt, views, span.first, span.end);
    return T3R_OK;
}

/* Whether covered points are deferred: in a small budget of a pair, in every build of more views, where a surface would
 * be laid many times, and in a stream, whose map already shows them. */
static bool passes_over_covered(const t3r_runtime *rt, const t3r_view *views, uint32_t gaussians)
{
    return t3r_is_stream(&rt->config) || (t3r_marks_covered(&rt->config) && rt->build.allocate != T3R_ALLOCATE_GIVEN &&
                                          (rt->views > 2 || t3r_is_sparse(views, rt->views, gaussians)));
}

t3r_budget_settings t3r_budget_settings_of(const t3r_runtime *rt, const t3r_view *views)
{
    const t3r_config *config = &rt->config;
    const uint32_t gaussians = t3r_gaussians_of(rt) - t3r_backdrop_count(rt, views);
    return (t3r_budget_settings){
        .allocate = rt->build.allocate,
        .gaussians = gaussians,
        .keep_percent = config->keep_percent,
        .gamma_q8 = config->gamma_q8,
        .clusters = config->clusters,
        .seed = config->seed,
        .first_view = rt->keyframes % T3R_MAX_VIEWS,
        .pass_over_covered = passes_over_covered(rt, views, gaussians),
    };
}

t3r_budget_work t3r_budget_work_of(const t3r_runtime *rt)
{
    return (t3r_budget_work){t3r_workers_of(rt), t3r_buffer_at(rt, T3R_BUFFER_BUDGET_WORK), &rt->kernels};
}

void t3r_choose_points(const t3r_runtime *rt, const t3r_view *views, t3r_view_span span,
                       const t3r_budget_settings *settings)
{
    const t3r_budget_work work = t3r_budget_work_of(rt);
    t3r_allocate(views + span.first, span.end - span.first, settings, t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS), &work);
    t3r_hash_budget(rt, views, span.first, span.end);
}
