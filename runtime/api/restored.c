/* SPDX-License-Identifier: Apache-2.0 */
#include "restored.h"

#include "api/checks.h"
#include "budget/cluster_texture.h"
#include "core/camera.h"
#include "core/features.h"
#include "core/scene_frame.h"
#include "image/image.h"
#include "pointmap/align.h"
#include "superclusters/superclusters.h"

/* Whether depths of valid pixels are above 0: stages divide by them. Stereo makes new planes in every analysis. */
static bool is_depth(const t3r_runtime *rt, const t3r_view *view)
{
    if (t3r_is_by_stereo(&rt->config) && !rt->analysed) {
        return true;
    }
    const size_t pixels = T3R_PIXELS_(view->width, view->height);
    for (size_t i = 0; i < pixels; i++) {
        if (t3r_has_depth(view->validity[i]) && view->depth[i] == 0) {
            return false;
        }
    }
    return true;
}

/* Whether every point has a SuperCluster's label; counts the points of each label. */
static bool count_labels(const t3r_runtime *rt, const t3r_view *view, uint32_t points[T3R_MAX_CLUSTERS])
{
    const size_t pixels = T3R_PIXELS_(view->width, view->height);
    for (size_t i = 0; i < pixels; i++) {
        if (!t3r_has_depth(view->validity[i])) {
            continue;
        }
        const uint32_t label = t3r_label_of(view, i);
        if (label >= rt->config.clusters) {
            return false;
        }
        points[label]++;
    }
    return true;
}

/* Whether labels agree with SuperClusters: the budget relies on the counts of these, and the head makes a Gaussian of
 * every point with a share. */
static bool is_analysis(const t3r_runtime *rt)
{
    uint32_t points[T3R_MAX_CLUSTERS] = {0};
    for (uint32_t v = 0; v < rt->views; v++) {
        const t3r_view view = t3r_view_of(rt, v);
        if (!count_labels(rt, &view, points)) {
            return false;
        }
    }
    const t3r_cluster *clusters = t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS);
    for (uint32_t k = 0; k < rt->config.clusters; k++) {
        if (clusters[k].points != points[k] || clusters[k].texture_q4 > UINT16_MAX) {
            return false;
        }
    }
    return t3r_are_ranked(clusters, rt->config.clusters) && rt->median_depth_q20 >= 1 << 20 &&
           rt->median_depth_q20 < 2 << 20;
}

static bool is_scene(const t3r_runtime *rt)
{
    const t3r_gaussian *scene = t3r_buffer_at(rt, T3R_BUFFER_SCENE);
    for (uint32_t i = 0; i < rt->gaussians; i++) {
        if (!t3r_is_gaussian(&scene[i])) {
            return false;
        }
    }
    return true;
}

/* Whether a stream's keyframes occupy the slots that consecutive keyframes fill. */
static bool is_stream(const t3r_runtime *rt)
{
    bool full = rt->views == rt->config.views;
    return !rt->analysed && rt->next_slot < rt->config.views && (full || rt->next_slot == rt->views) &&
           rt->gaussians <= rt->config.gaussians && rt->remembered <= rt->config.remember &&
           (rt->has_scene ? rt->views > 0 && rt->keyframes >= rt->views
                          : rt->views == 0 && rt->keyframes == 0 && rt->gaussians == 0);
}

/* Whether everything that the next build reuses is in range. Kept textures may hold anything. */
static bool is_reuse(const t3r_runtime *rt)
{
    const t3r_reuse *reuse = &rt->reuse;
    if (!t3r_is_warm(&rt->config) || !reuse->centres) {
        return reuse->views == 0 && reuse->centres == 0;
    }
    if (reuse->views >> rt->views != 0) {
        return false;
    }
    const int32_t most = T3R_FEATURE_MOST * (1 << T3R_CENTRE_FRACTION);
    const t3r_cluster *clusters = t3r_buffer_at(rt, T3R_BUFFER_KEPT_CLUSTERS);
    for (uint32_t i = 0; i < rt->config.clusters * T3R_DIMENSIONS; i++) {
        const int32_t at = clusters[i / T3R_DIMENSIONS].centre_q19[i % T3R_DIMENSIONS];
        if (at < -most || at > most) {
            return false;
        }
    }
    return true;
}

/* Whether views occupy the slots that consecutive views fill. */
static bool is_slot(const t3r_runtime *rt)
{
    if (t3r_is_stream(&rt->config)) {
        return is_stream(rt);
    }
    return rt->next_slot == 0 ||
           (t3r_is_warm(&rt->config) && rt->views == rt->config.views && rt->next_slot < rt->views);
}

/* Whether t3r_add_view() would take the given pose. Only alignment reads it. */
static bool is_given(const t3r_runtime *rt, uint32_t v)
{
    t3r_camera given = rt->camera[v];
    t3r_place_camera(&given, &rt->given[v]);
    return !t3r_aligns(&rt->config) || t3r_camera_check(&given, rt->config.width, rt->config.height) == T3R_OK;
}

static bool is_view(const t3r_runtime *rt, uint32_t v)
{
    if (!is_given(rt, v) || rt->stereo_pair[v] >= T3R_PAIR_COUNT || rt->stereo_partner[v] >= rt->views ||
        t3r_camera_check(&rt->camera[v], rt->config.width, rt->config.height) != T3R_OK || rt->depth_unit_q40[v] == 0 ||
        rt->depth_unit_q40[v] > T3R_MAX_DEPTH_UNIT_Q40) {
        return false;
    }
    t3r_pose pose;
    if (rt->analysed && t3r_pose_in_scene(&rt->camera[v], &rt->frame, &pose) != T3R_OK) {
        return false;
    }
    const t3r_view view = t3r_view_of(rt, v);
    return is_depth(rt, &view);
}

/* Whether t3r_init() would keep the configuration unchanged: t3r_config_check() also accepts settings left open. */
static bool is_settled(const t3r_config *config)
{
    return config->clusters == t3r_cluster_count(config) && config->cluster_batches == t3r_cluster_batch_count(config);
}

/* Checks the numbers of the state before anything that depends on them is read. */
static bool is_state(const t3r_runtime *rt)
{
    const size_t most_points = T3R_PIXELS_(rt->config.width, rt->config.height) * rt->config.views;
    return is_settled(&rt->config) && rt->views <= rt->config.views && rt->gaussians <= rt->config.max_gaussians &&
           rt->analysed <= (rt->views > 0) && rt->has_scene <= 1 && rt->valid_points <= most_points &&
           t3r_is_scene_frame(&rt->frame) && t3r_is_build(&rt->config, &rt->build) && is_slot(rt) && is_reuse(rt);
}

bool t3r_is_restored(const t3r_runtime *rt)
{
    if (!is_state(rt)) {
        return false;
    }
    for (uint32_t v = 0; v < rt->views; v++) {
        if (!is_view(rt, v)) {
            return false;
        }
    }
    return (!rt->analysed || is_analysis(rt)) && (!rt->has_scene || is_scene(rt));
}
