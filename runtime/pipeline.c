/* The way of the data. The image stage comes before, frame by frame (develop.c), a view behind (render.c):
 *
 *     frames - image -+- wavelet -- texture energy --+
 *                     |                              +- superclusters - budget - mask - head - scene - refine - raster
 *                     +- depth ---- pointmap --------+
 *                        sensor | stereo
 *
 * The stage_hash hook gets a hash of each stage's output. */
#include "pipeline.h"

#include "pointmap/align.h"
#include "pointmap/bridge.h"
#include "budget/budget.h"
#include "budget/cluster_texture.h"
#include "depth/depth.h"
#include "pointmap/exposure.h"
#include "core/cut.h"
#include "core/features.h"
#include "core/fixed.h"
#include "core/memory.h"
#include "pointmap/flying_pixels.h"
#include "head/head_views.h"
#include "refine/fitted_passes.h"
#include "superclusters/pixel_clusters.h"
#include "pointmap/pointmap.h"
#include "pointmap/redundancy.h"
#include "pointmap/same_frame.h"
#include "refine/refine.h"
#include "core/scene_frame.h"
#include "pointmap/scene_scale.h"
#include "stage_hash.h"
#include "state/state.h"
#include "stereo/stereo_views.h"
#include "superclusters/superclusters.h"
#include "wavelet/wavelet.h"

/* --- views ------------------------------------------------------------------------------------------------------- */

typedef struct views_job {
    const t3r_runtime *rt;
    t3r_view *views;
    uint32_t first; /* view of the task of index 0 */
} views_job;

/* Steps that look at nothing but their own view: as many views at once as there are workers, steps first..first + views
 * - 1 of `total` being reported before. */
static t3r_status each_view(const t3r_runtime *rt, t3r_view *views, t3r_task *task, t3r_stage stage, uint32_t first,
                            uint32_t total)
{
    const t3r_workers workers = t3r_workers_of(rt);
    const uint32_t round = t3r_is_parallel(&workers) ? workers.count : 1;
    for (uint32_t v = 0; v < rt->views; v += round) {
        if (!t3r_progress(rt, stage, first + v, total)) {
            return T3R_ERR_CANCELLED;
        }
        views_job job = {rt, views, v};
        t3r_run_tasks(&workers, T3R_MIN(round, rt->views - v), task, &job);
    }
    return T3R_OK;
}

/* --- analysis --------------------------------------------------------------------------------------------------- */

/* Doubtful stereo pixels also count as measured. */
static uint32_t count_measured(const t3r_runtime *rt, const t3r_view *views)
{
    uint32_t pixels = rt->config.width * rt->config.height, measured = 0;
    for (uint32_t v = 0; v < rt->views; v++) {
        for (uint32_t i = 0; i < pixels; i++) {
            measured += t3r_is_measured(views[v].validity[i]);
        }
    }
    return measured;
}

static void fill_view(void *context, uint32_t index, uint32_t worker)
{
    (void)worker;
    const views_job *job = context;
    if (!t3r_is_reused(job->rt, job->first + index)) {
        t3r_depth_fill(&job->views[job->first + index], job->rt->config.fill_radius);
    }
}

static t3r_status depth(t3r_runtime *rt, t3r_view *views)
{
    const bool stereo = t3r_is_by_stereo(&rt->config); /* it fills its own holes */
    t3r_status status =
        stereo ? t3r_stereo_views(rt, views) : each_view(rt, views, fill_view, T3R_STAGE_DEPTH, 0, rt->views);
    if (status != T3R_OK) {
        return status;
    }
    rt->valid_points = count_measured(rt, views);
    t3r_hash_depth(rt, views, 0, rt->views);
    return T3R_OK;
}

/* The pointmap is a function of depth and pose; what it needs is the frame that both are in. */
static t3r_status pointmap(t3r_runtime *rt, t3r_view *views)
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

/* Of t3r_progress(): those of alignment, where there is one. Then for every view bridging takes three, flying pixels,
 * exposure and redundancy one each. */
static uint32_t align_steps(const t3r_runtime *rt)
{
    return t3r_aligns(&rt->config) && rt->views > 1 ? T3R_ALIGN_STEPS : 0;
}

static uint32_t pointmap_steps(const t3r_runtime *rt)
{
    return align_steps(rt) + 6 * rt->views;
}

static bool pointmap_step(t3r_runtime *rt, uint32_t step)
{
    return t3r_progress(rt, T3R_STAGE_POINTMAP, align_steps(rt) + step, pointmap_steps(rt));
}

static void bridge_view(void *context, uint32_t index, uint32_t worker)
{
    (void)worker;
    const views_job *job = context;
    if (!t3r_is_reused(job->rt, job->first + index)) {
        t3r_bridge_view(&job->views[job->first + index], job->rt->config.bridge_radius);
    }
}

/* Wide holes, once it is known where the views stand. What stereo left without depth shows nothing. */
static t3r_status bridge(t3r_runtime *rt, t3r_view *views)
{
    const t3r_pointmap_work work = t3r_pointmap_work_of(rt);
    const uint32_t radius = t3r_is_by_stereo(&rt->config) ? 0 : rt->config.bridge_radius;
    for (uint32_t v = 0; v < rt->views && radius > 0; v++) {
        if (!pointmap_step(rt, v)) {
            return T3R_ERR_CANCELLED;
        }
        if (!t3r_is_reused(rt, v)) {
            t3r_bridge_lend(views, rt->views, v, rt->frame.exponent, &work);
        }
    }
    if (radius > 0) {
        t3r_status status =
            each_view(rt, views, bridge_view, T3R_STAGE_POINTMAP, align_steps(rt) + rt->views, pointmap_steps(rt));
        if (status != T3R_OK) {
            return status;
        }
    }
    for (uint32_t v = 0; v < rt->views && radius > 0; v++) {
        if (!pointmap_step(rt, 2 * rt->views + v)) {
            return T3R_ERR_CANCELLED;
        }
        const uint32_t settled = ((1u << v) - 1) | (rt->reuse.views & ~(1u << v));
        (void)t3r_bridge_settle(views, rt->views, v, rt->frame.exponent, settled, &work);
    }
    return T3R_OK;
}

/* What the views say of each other: pixels that cannot be, colours of one exposure, surfaces seen twice. */
static t3r_status flying_pixels(t3r_runtime *rt, t3r_view *views)
{
    const t3r_pointmap_work work = t3r_pointmap_work_of(rt);
    for (uint32_t v = 0; v < rt->views && rt->config.flying; v++) {
        if (!pointmap_step(rt, 3 * rt->views + v)) {
            return T3R_ERR_CANCELLED;
        }
        if (!t3r_is_reused(rt, v)) {
            (void)t3r_mark_flying(views, rt->views, v, rt->frame.exponent, t3r_is_by_stereo(&rt->config), &work);
        }
    }
    return T3R_OK;
}

static t3r_status exposure(t3r_runtime *rt, t3r_view *views)
{
    for (uint32_t v = 0; v < T3R_MAX_VIEWS; v++) {
        for (int c = 0; c < 3; c++) {
            rt->gain_q14[v][c] = T3R_GAIN_ONE_Q14;
        }
    }
    if (rt->config.exposure != 0) {
        if (!pointmap_step(rt, 4 * rt->views)) {
            return T3R_ERR_CANCELLED;
        }
        const t3r_pointmap_work work = t3r_pointmap_work_of(rt);
        t3r_exposure_gains(views, rt->views, rt->frame.exponent, rt->gain_q14, &work);
    }
    return T3R_OK;
}

static t3r_status redundancy(t3r_runtime *rt, t3r_view *views)
{
    const t3r_pointmap_work work = t3r_pointmap_work_of(rt);
    for (uint32_t v = rt->views; v-- > 0 && rt->config.redundancy;) {
        if (!pointmap_step(rt, 6 * rt->views - v - 1)) {
            return T3R_ERR_CANCELLED;
        }
        (void)t3r_mark_covered(views, rt->views, v, rt->frame.exponent, &work);
    }
    t3r_clear_witnesses(views, rt->views);
    t3r_hash_pointmap(rt, views, 0, rt->views);
    return T3R_OK;
}

/* Each worker has a plane and work of its own. */
static void texture_of(const t3r_runtime *rt, const t3r_view *view, uint32_t worker)
{
    const t3r_config *config = &rt->config;
    const size_t bytes = T3R_WAVELET_WORK_BYTES_(config->width, config->height);
    t3r_cut cut = t3r_cut_of((uint8_t *)t3r_buffer_at(rt, T3R_BUFFER_WAVELET_WORK) + worker * bytes, bytes);
    int16_t *plane = t3r_take(&cut, T3R_PIXELS_(config->width, config->height) * sizeof *plane);
    int16_t *work = t3r_take(&cut, T3R_WAVELET_ROW_BYTES(config->width));
    t3r_wavelet_texture(&rt->kernels, (const uint8_t *const *)view->colour, config->width, config->height,
                        config->levels, config->wavelet, view->texture, plane, work);
}

void t3r_view_texture(const t3r_runtime *rt, const t3r_view *view)
{
    texture_of(rt, view, 0);
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
    texture_of(rt, &job->views[v], worker);
    if (t3r_is_warm(&rt->config)) {
        memcpy(t3r_kept_texture(rt, v), job->views[v].texture, bytes);
    }
}

static t3r_status wavelet(t3r_runtime *rt, t3r_view *views)
{
    t3r_status status = each_view(rt, views, view_texture, T3R_STAGE_WAVELET, 0, rt->views);
    if (status == T3R_OK) {
        t3r_hash_wavelet(rt, views, 0, rt->views);
    }
    return status;
}

static t3r_status superclusters(t3r_runtime *rt, t3r_view *views)
{
    const t3r_workers workers = t3r_workers_of(rt);
    t3r_status status = t3r_cluster_pixels(rt, views);
    if (status != T3R_OK) {
        return status;
    }
    t3r_hash_superclusters(rt, views, 0, rt->views);
    t3r_cluster *clusters = t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS);
    t3r_cluster_texture(views, rt->views, clusters, rt->config.clusters);
    if (rt->ablation.shuffle != 0) {
        t3r_shuffle_texture(clusters, rt->config.clusters, rt->config.seed);
    }
    t3r_rank_clusters(clusters, rt->config.clusters);
    t3r_blur_texture(&rt->kernels, views, rt->views,
                     &workers); /* means are of the texture as it is, densities of it blurred */
    return T3R_OK;
}

t3r_status t3r_analyse(t3r_runtime *rt)
{
    rt->strips = (t3r_strips){0}; /* stages work where its sums are */
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);
    if (t3r_is_by_stereo(&rt->config)) {
        t3r_stereo_clear(views, rt->views);
    }
    if (!t3r_is_warm(&rt->config) || !rt->reuse.centres || !t3r_is_in_frame(rt, views)) {
        t3r_reuse_nothing(rt);
    }
    rt->follows = rt->reuse.centres;
    for (uint32_t v = 0; v < rt->views; v++) { /* of an earlier analysis of the same planes */
        if (t3r_is_reused(rt, v)) {
            t3r_reset_covered(&views[v]);
        } else {
            t3r_reset_comparison(&views[v], 1);
        }
    }
    for (uint32_t v = 0; v < rt->views && t3r_aligns(&rt->config); v++) {
        t3r_pose_as_given(rt, v);
    }
    t3r_hash_image(rt, views, 0, rt->views);

    t3r_status status = depth(rt, views);
    if (status == T3R_OK) {
        status = pointmap(rt, views);
    }
    if (status == T3R_OK && align_steps(rt) > 0) {
        status = t3r_align_views(rt, views, pointmap_steps(rt));
    }
    if (status == T3R_OK) {
        status = bridge(rt, views);
    }
    if (status == T3R_OK) {
        status = flying_pixels(rt, views);
    }
    if (status == T3R_OK) {
        status = exposure(rt, views);
    }
    if (status == T3R_OK) {
        status = redundancy(rt, views);
    }
    if (status == T3R_OK) {
        status = wavelet(rt, views);
    }
    if (status == T3R_OK) {
        status = superclusters(rt, views);
    }
    rt->analysed = status == T3R_OK;
    if (status == T3R_OK) {
        t3r_reuse_all(rt);
    } else {
        t3r_reuse_nothing(rt);
    }
    return status;
}

/* --- scene ------------------------------------------------------------------------------------------------------ */

t3r_budget_settings t3r_budget_settings_of(const t3r_runtime *rt, const t3r_view *views)
{
    const t3r_config *config = &rt->config;
    uint32_t gaussians = T3R_MIN(rt->build.gaussians, rt->valid_points); /* filled holes compete, but add no budget */
    return (t3r_budget_settings){
        .allocate = rt->build.allocate,
        .gaussians = gaussians,
        .keep_percent = config->keep_percent,
        .gamma_q8 = config->gamma_q8,
        .clusters = config->clusters,
        .seed = config->seed,
        .pass_over_covered = config->redundancy && rt->build.allocate != T3R_ALLOCATE_GIVEN &&
                             t3r_is_sparse(views, rt->views, gaussians),
    };
}

static void budget(t3r_runtime *rt, const t3r_view *views, const t3r_budget_settings *settings,
                   const t3r_importance *importance)
{
    if (t3r_allocates(settings, T3R_ALLOCATE_GIVEN)) {
        t3r_importance_keys(views, rt->views, importance);
    }
    const t3r_budget_work work = {t3r_workers_of(rt), t3r_buffer_at(rt, T3R_BUFFER_BUDGET_WORK), &rt->kernels};
    t3r_allocate(views, rt->views, settings, t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS), &work);
    t3r_hash_budget(rt, views, 0, rt->views);
}

static t3r_status head(t3r_runtime *rt, const t3r_view *views, const t3r_budget_settings *settings)
{
    t3r_gaussian *scene = t3r_buffer_at(rt, T3R_BUFFER_SCENE);
    rt->gaussians = 0;
    t3r_status status = t3r_views_to_gaussians(rt, views, settings, scene, &rt->gaussians);
    if (status == T3R_OK) {
        t3r_hash_scene(rt, T3R_STAGE_HEAD);
    }
    return status;
}

static t3r_status refine(t3r_runtime *rt, const t3r_view *views)
{
    rt->passes = 0;
    if (rt->build.refine == 0) {
        return T3R_OK;
    }
    rt->analysed &= rt->config.keep_analysis; /* else refinement works where labels and clusters are */
    rt->passes = rt->config.fit_passes ? t3r_fitted_passes(rt, views, rt->build.refine) : rt->build.refine;
    t3r_status status = t3r_refine(rt, views, rt->passes);
    if (status == T3R_OK) {
        t3r_hash_scene(rt, T3R_STAGE_REFINE);
    }
    return status;
}

t3r_status t3r_build_scene(t3r_runtime *rt, const t3r_view *views, const t3r_build *build,
                           const t3r_importance *importance)
{
    rt->build = *build;
    rt->has_scene = 0;
    if (!t3r_progress(rt, T3R_STAGE_BUDGET, 0, 1)) {
        return T3R_ERR_CANCELLED;
    }
    t3r_budget_settings settings = t3r_budget_settings_of(rt, views);
    budget(rt, views, &settings, importance);
    t3r_status status = head(rt, views, &settings);
    if (status == T3R_OK) {
        status = refine(rt, views);
    }
    rt->has_scene = status == T3R_OK;
    return status;
}
