/* The way of the data. The image stage comes before, frame by frame (develop.c), the raster behind (raster.c):
 *
 *     frames - image -+- wavelet -- texture energy --+
 *                     |                              +- superclusters - budget - mask - head - scene - refine - raster
 *                     +- depth ---- pointmap --------+
 *                        sensor | stereo
 *
 * Each stage tells what it made through the stage_hash hook. */
#include "pipeline.h"

#include "pointmap/bridge.h"
#include "budget/budget.h"
#include "depth/depth.h"
#include "pointmap/exposure.h"
#include "core/cut.h"
#include "core/fixed.h"
#include "pointmap/flying_pixels.h"
#include "head/head.h"
#include "superclusters/pixel_clusters.h"
#include "pointmap/pointmap.h"
#include "pointmap/redundancy.h"
#include "refine/refine.h"
#include "core/scene_frame.h"
#include "core/stage_hash.h"
#include "core/state.h"
#include "stereo/stereo_views.h"
#include "superclusters/superclusters.h"
#include "wavelet/wavelet.h"

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

static t3r_status depth(t3r_runtime *rt, t3r_view *views)
{
    if (rt->config.depth == T3R_DEPTH_STEREO) {
        t3r_status status = t3r_stereo_views(rt, views);
        if (status != T3R_OK) {
            return status;
        }
    }
    for (uint32_t v = 0; v < rt->views && rt->config.depth == T3R_DEPTH_SENSOR; v++) { /* stereo fills its own */
        if (!t3r_progress(rt, T3R_STAGE_DEPTH, v, rt->views)) {
            return T3R_ERR_CANCELLED;
        }
        t3r_depth_fill(&views[v], rt->config.fill_radius);
    }
    rt->valid_points = count_measured(rt, views);
    t3r_hash_depth(rt, views, 0, rt->views);
    return T3R_OK;
}

/* The pointmap is a function of depth and pose; what it needs is the frame that both are in. */
static t3r_status pointmap(t3r_runtime *rt, t3r_view *views)
{
    for (int i = 0; i < 3; i++) {
        rt->frame.origin_q32[i] = rt->camera[0].position_q32[i];
    }
    t3r_status status = t3r_scene_frame_choose(views, rt->views, &rt->frame.exponent, &rt->median_depth_q20);
    for (uint32_t v = 0; v < rt->views && status == T3R_OK; v++) {
        status = t3r_pose_in_scene(&rt->camera[v], &rt->frame, &views[v].pose);
    }
    return status;
}

/* Of t3r_progress(), for every view: bridging takes three, flying pixels, exposure and redundancy one each. */
#define POINTMAP_STEPS(rt) (6 * (rt)->views)

static bool pointmap_step(t3r_runtime *rt, uint32_t step)
{
    return t3r_progress(rt, T3R_STAGE_POINTMAP, step, POINTMAP_STEPS(rt));
}

/* Wide holes, once it is known where the views stand. What stereo left without depth shows nothing. */
static t3r_status bridge(t3r_runtime *rt, t3r_view *views)
{
    const uint32_t radius = rt->config.depth == T3R_DEPTH_STEREO ? 0 : rt->config.bridge_radius;
    for (uint32_t v = 0; v < rt->views && radius > 0; v++) {
        if (!pointmap_step(rt, v)) {
            return T3R_ERR_CANCELLED;
        }
        t3r_bridge_lend(views, rt->views, v, rt->frame.exponent);
    }
    for (uint32_t v = 0; v < rt->views && radius > 0; v++) {
        if (!pointmap_step(rt, rt->views + v)) {
            return T3R_ERR_CANCELLED;
        }
        t3r_bridge_view(&views[v], radius);
    }
    for (uint32_t v = 0; v < rt->views && radius > 0; v++) {
        if (!pointmap_step(rt, 2 * rt->views + v)) {
            return T3R_ERR_CANCELLED;
        }
        (void)t3r_bridge_settle(views, rt->views, v, rt->frame.exponent, (1u << v) - 1);
    }
    return T3R_OK;
}

/* What the views say of each other: pixels that cannot be, colours of one exposure, surfaces seen twice. */
static t3r_status flying_pixels(t3r_runtime *rt, t3r_view *views)
{
    for (uint32_t v = 0; v < rt->views && rt->config.flying; v++) {
        if (!pointmap_step(rt, 3 * rt->views + v)) {
            return T3R_ERR_CANCELLED;
        }
        (void)t3r_mark_flying(views, rt->views, v, rt->frame.exponent, rt->config.depth == T3R_DEPTH_STEREO);
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
    if (rt->config.exposure) {
        if (!pointmap_step(rt, 4 * rt->views)) {
            return T3R_ERR_CANCELLED;
        }
        t3r_exposure_gains(views, rt->views, rt->frame.exponent, rt->gain_q14);
    }
    return T3R_OK;
}

static t3r_status redundancy(t3r_runtime *rt, t3r_view *views)
{
    for (uint32_t v = rt->views; v-- > 0 && rt->config.redundancy;) {
        if (!pointmap_step(rt, 6 * rt->views - v - 1)) {
            return T3R_ERR_CANCELLED;
        }
        (void)t3r_mark_covered(views, rt->views, v, rt->frame.exponent);
    }
    t3r_clear_witnesses(views, rt->views);
    t3r_hash_pointmap(rt, views, 0, rt->views);
    return T3R_OK;
}

void t3r_view_texture(const t3r_runtime *rt, const t3r_view *view)
{
    const t3r_config *config = &rt->config;
    t3r_cut cut =
        t3r_cut_of(t3r_buffer_at(rt, T3R_BUFFER_WAVELET_WORK), T3R_WAVELET_WORK_BYTES_(config->width, config->height));
    int16_t *plane = t3r_take(&cut, T3R_PIXELS_(config->width, config->height) * sizeof *plane);
    int16_t *work = t3r_take(&cut, T3R_WAVELET_ROW_BYTES(config->width));
    t3r_wavelet_texture(&rt->kernels, (const uint8_t *const *)view->colour, config->width, config->height,
                        config->wavelet_levels, config->wavelet, view->texture, plane, work);
}

static t3r_status wavelet(t3r_runtime *rt, t3r_view *views)
{
    for (uint32_t v = 0; v < rt->views; v++) {
        if (!t3r_progress(rt, T3R_STAGE_WAVELET, v, rt->views)) {
            return T3R_ERR_CANCELLED;
        }
        t3r_view_texture(rt, &views[v]);
    }
    t3r_hash_wavelet(rt, views, 0, rt->views);
    return T3R_OK;
}

static t3r_status superclusters(t3r_runtime *rt, t3r_view *views)
{
    t3r_status status = t3r_cluster_pixels(rt, views);
    if (status != T3R_OK) {
        return status;
    }
    t3r_hash_superclusters(rt, views, 0, rt->views);
    t3r_cluster *clusters = t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS);
    t3r_cluster_texture(views, rt->views, clusters, rt->config.clusters);
    if (rt->config.shuffle) {
        t3r_shuffle_texture(clusters, rt->config.clusters, rt->config.seed);
    }
    t3r_rank_clusters(clusters, rt->config.clusters);
    t3r_blur_texture(&rt->kernels, views, rt->views); /* means are of the texture as it is, densities of it blurred */
    return T3R_OK;
}

t3r_status t3r_analyse(t3r_runtime *rt)
{
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);
    if (rt->config.depth == T3R_DEPTH_STEREO) {
        t3r_stereo_clear(views, rt->views);
    }
    t3r_reset_comparison(views, rt->views); /* of an earlier analysis of the same planes */
    t3r_hash_image(rt, views, 0, rt->views);

    t3r_status status = depth(rt, views);
    if (status == T3R_OK) {
        status = pointmap(rt, views);
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
    return status;
}

/* --- scene ------------------------------------------------------------------------------------------------------ */

t3r_budget_settings t3r_budget_settings_of(const t3r_runtime *rt, const t3r_view *views)
{
    const t3r_config *config = &rt->config;
    uint32_t gaussians = T3R_MIN(config->gaussians, rt->valid_points); /* filled holes compete, but add no budget */
    return (t3r_budget_settings){
        .allocation = config->allocation,
        .gaussians = gaussians,
        .keep_percent = config->keep_percent,
        .gamma_q8 = config->gamma_q8,
        .clusters = config->clusters,
        .seed = config->seed,
        .pass_over_covered = config->redundancy && config->allocation != T3R_ALLOCATE_GIVEN &&
                             t3r_is_sparse(views, rt->views, gaussians),
    };
}

static void budget(t3r_runtime *rt, const t3r_view *views, const t3r_budget_settings *settings,
                   const t3r_importance *importance)
{
    if (importance != NULL) {
        t3r_importance_keys(views, rt->views, importance);
    }
    t3r_allocate(views, rt->views, settings, t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS));
    t3r_hash_budget(rt, views, 0, rt->views);
}

/* The colours of a view's Gaussians brought to the mean exposure. */
static void level(t3r_gaussian *gaussians, uint32_t count, const uint16_t gain_q14[3])
{
    for (uint32_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++) {
            gaussians[i].colour_q7[c] = t3r_level_q7(gaussians[i].colour_q7[c], gain_q14[c]);
        }
    }
}

static t3r_head_rows *const heads[T3R_HEAD_COUNT] = {
    [T3R_HEAD_ANALYTIC] = t3r_head_analytic,
    [T3R_HEAD_MOMENT] = t3r_head_moment,
    [T3R_HEAD_NONE] = t3r_head_none,
    [T3R_HEAD_LEARNED] = t3r_head_learned,
};

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
        .work = t3r_buffer_at(rt, T3R_BUFFER_HEAD_WORK),
        .unadapted = !rt->config.adapt,
    };
}

uint32_t t3r_view_to_gaussians(const t3r_runtime *rt, const t3r_view *views, uint32_t view_index,
                               const t3r_budget_settings *settings, t3r_gaussian *out)
{
    t3r_head_input input = t3r_head_input_of(rt, views, view_index, settings);
    uint32_t made = heads[rt->config.head](&input, 0, rt->config.height, out);
    level(out, made, rt->gain_q14[view_index]);
    return made;
}

static t3r_status head(t3r_runtime *rt, const t3r_view *views, const t3r_budget_settings *settings)
{
    t3r_gaussian *scene = t3r_buffer_at(rt, T3R_BUFFER_SCENE);
    rt->gaussians = 0;
    for (uint32_t v = 0; v < rt->views; v++) {
        if (!t3r_progress(rt, T3R_STAGE_HEAD, v, rt->views)) {
            return T3R_ERR_CANCELLED;
        }
        rt->gaussians += t3r_view_to_gaussians(rt, views, v, settings, scene + rt->gaussians);
    }
    t3r_hash_scene(rt, T3R_STAGE_HEAD);
    return T3R_OK;
}

static t3r_status refine(t3r_runtime *rt, const t3r_view *views)
{
    if (rt->config.refinements == 0) {
        return T3R_OK;
    }
    rt->analysed &= rt->config.keep_analysis; /* else refinement works where labels and clusters are */
    t3r_status status = t3r_refine(rt, views);
    if (status == T3R_OK) {
        t3r_hash_scene(rt, T3R_STAGE_REFINE);
    }
    return status;
}

t3r_status t3r_build_scene(t3r_runtime *rt, const t3r_importance *importance)
{
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);

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
