/* SPDX-License-Identifier: Apache-2.0 */
/* The order of the stages. The image stage runs before, frame by frame (develop.c), rendering follows (render.c):
 *
 *   frames - image -+- wavelet -- texture energy --+
 *                   |                              +- superclusters - budget - mask - head - scene - refine - raster
 *                   +- depth ---- pointmap --------+
 *                  sensor | stereo
 *
 * A keyframe of a stream goes through the same stages (stages.c) in its own order (stream.c). The stage_hash hook gets
 * a hash of each stage's output. */
#include "pipeline.h"

#include "budget/budget.h"
#include "budget/cluster_texture.h"
#include "core/fault.h"
#include "core/features.h"
#include "head/backdrop.h"
#include "head/head_views.h"
#include "pointmap/align.h"
#include "pointmap/exposure.h"
#include "pointmap/pointmap.h"
#include "pointmap/redundancy.h"
#include "pointmap/same_frame.h"
#include "refine/fitted_passes.h"
#include "refine/refine.h"
#include "stage_hash.h"
#include "stages.h"
#include "state/state.h"
#include "stereo/stereo_views.h"
#include "superclusters/pixel_clusters.h"
#include "superclusters/superclusters.h"

static t3r_view_span all_of(const t3r_runtime *rt)
{
    return (t3r_view_span){0, rt->views};
}

/* Resets the results of an earlier analysis of the same planes. */
static void begin_analysis(t3r_runtime *rt, t3r_view *views)
{
    if (t3r_is_by_stereo(&rt->config)) {
        t3r_stereo_clear(views, rt->views);
    }
    if (!t3r_is_warm(&rt->config) || !rt->reuse.centres || !t3r_is_in_frame(rt, views)) {
        t3r_reuse_nothing(rt);
    }
    rt->follows = rt->reuse.centres;
    for (uint32_t v = 0; v < rt->views; v++) {
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
}

/* Counts measured pixels, including doubtful stereo ones. */
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

static t3r_status align(t3r_runtime *rt, t3r_view *views)
{
    const bool aligns = t3r_aligns(&rt->config) && rt->views > 1;
    return aligns ? t3r_align_views(rt, views, t3r_pointmap_steps(rt, all_of(rt))) : T3R_OK;
}

/* Computes the gains that bring the views to one exposure. */
static t3r_status exposure(t3r_runtime *rt, t3r_view *views)
{
    for (uint32_t v = 0; v < T3R_MAX_VIEWS; v++) {
        for (int c = 0; c < 3; c++) {
            rt->gain_q14[v][c] = T3R_GAIN_ONE_Q14;
        }
    }
    if (T3R_FEATURE_COMPARISON && rt->config.exposure != 0) {
        if (!t3r_pointmap_step(rt, all_of(rt), T3R_PART_EXPOSURE, 0)) {
            return T3R_ERR_CANCELLED;
        }
        const t3r_pointmap_work work = t3r_pointmap_work_of(rt);
        t3r_exposure_gains(views, rt->views, rt->frame.exponent, rt->gain_q14, &work);
    }
    return T3R_OK;
}

/* Marks surfaces seen twice. */
static t3r_status redundancy(t3r_runtime *rt, t3r_view *views)
{
    const t3r_pointmap_work work = t3r_pointmap_work_of(rt);
    for (uint32_t v = rt->views; v-- > 0 && t3r_marks_covered(&rt->config);) {
        if (!t3r_pointmap_step(rt, all_of(rt), T3R_PART_REDUNDANCY, rt->views - 1 - v)) {
            return T3R_ERR_CANCELLED;
        }
        (void)t3r_mark_covered(views, rt->views, v, rt->frame.exponent, &work);
    }
    t3r_clear_witnesses(views, rt->views);
    t3r_hash_pointmap(rt, views, 0, rt->views);
    return T3R_OK;
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
    if (t3r_shuffles(&rt->ablation)) {
        t3r_shuffle_texture(clusters, rt->config.clusters, rt->config.seed);
    }
    t3r_rank_clusters(clusters, rt->config.clusters);
    /* cluster means use the unblurred texture, densities the blurred one */
    t3r_blur_texture(&rt->kernels, views, rt->views, &workers);
    return T3R_OK;
}

t3r_status t3r_find_points(t3r_runtime *rt, t3r_view *views)
{
    rt->strips = (t3r_strips){0}; /* stages overwrite its sums */
    begin_analysis(rt, views);
    T3R_PASS(t3r_find_depth(rt, views, all_of(rt)));
    rt->valid_points = count_measured(rt, views);
    return t3r_choose_frame(rt, views);
}

t3r_status t3r_analyse(t3r_runtime *rt)
{
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);
    t3r_status status = t3r_find_points(rt, views);
    if (status == T3R_OK) {
        status = align(rt, views);
    }
    if (status == T3R_OK) {
        status = t3r_bridge_holes(rt, views, all_of(rt));
    }
    if (status == T3R_OK) {
        status = t3r_find_flying_pixels(rt, views, all_of(rt));
    }
    if (status == T3R_OK) {
        status = exposure(rt, views);
    }
    if (status == T3R_OK) {
        status = redundancy(rt, views);
    }
    if (status == T3R_OK) {
        status = t3r_find_texture(rt, views, all_of(rt));
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

static t3r_status head(t3r_runtime *rt, const t3r_view *views, const t3r_budget_settings *settings)
{
    t3r_gaussian *scene = t3r_buffer_at(rt, T3R_BUFFER_SCENE);
    rt->gaussians = 0;
    t3r_status status = t3r_views_to_gaussians(rt, views, settings, scene, &rt->gaussians);
    if (status == T3R_OK) {
        t3r_add_backdrop(rt, views);
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
    rt->analysed &= rt->config.keep_analysis; /* otherwise refinement overwrites labels and clusters */
    const t3r_passes passes = T3R_FEATURE_LOSS && rt->config.fit_passes ? t3r_fitted_passes(rt, views, rt->build.refine)
                                                                        : (t3r_passes){rt->build.refine, 0};
    rt->passes = passes.count;
    t3r_status status = t3r_refine(rt, views, passes);
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
    const t3r_budget_settings settings = t3r_budget_settings_of(rt, views);
    if (t3r_allocates(&settings, T3R_ALLOCATE_GIVEN)) {
        t3r_importance_keys(views, rt->views, importance);
    }
    t3r_choose_points(rt, views, all_of(rt), &settings);
    t3r_status status = head(rt, views, &settings);
    if (status == T3R_OK) {
        status = refine(rt, views);
    }
    rt->has_scene = status == T3R_OK;
    return status;
}
