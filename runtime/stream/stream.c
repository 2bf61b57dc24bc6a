/* SPDX-License-Identifier: Apache-2.0 */
/* The stages of a keyframe. Its planes take the slot of the oldest live keyframe:
 *
 *   frame - image - depth - pointmap -+- the map seen and drawn from there -+- budget - mask - head - map - refine
 *                                     +- wavelet -- texture energy ---------+
 *
 * The stages are a build's (stages.h). The map is the scene; the pixels that it does not show compete with it. */
#include "stream.h"

#include "budget/budget_keys.h"
#include "budget/cluster_texture.h"
#include "core/config.h"
#include "core/fixed.h"
#include "core/memory.h"
#include "core/scene_frame.h"
#include "head/head_views.h"
#include "held.h"
#include "image/develop.h"
#include "pointmap/exposure.h"
#include "pointmap/pointmap.h"
#include "realign.h"
#include "refine/refine.h"
#include "remember.h"
#include "stage_hash.h"
#include "stages.h"
#include "state/state.h"
#include "stream_density.h"
#include "stream_gate.h"
#include "stream_map.h"
#include "superclusters/one_cluster.h"

#define REBASE_Q20 (1 << 29) /* distance from the origin beyond which the origin follows: 512 scene units */

/* --- origin of the map ------------------------------------------------------------------------------------------ */

/* Moves the origin to the camera by whole scene units: whole steps of Q32 world units for any exponent, and of Q20, so
 * nothing is rounded. Rounds towards 0, so that the origin stays between its old place and the camera, both below
 * 2^62. */
static void rebase(t3r_runtime *rt, const int32_t position_q20[3])
{
    int64_t by_q20[3];
    for (int i = 0; i < 3; i++) {
        int64_t units = position_q20[i] / (1 << 20);
        by_q20[i] = -units * (1 << 20);
        rt->frame.origin_q32[i] += units * ((int64_t)1 << (32 + rt->frame.exponent));
    }
    t3r_map map = t3r_map_of(rt);
    t3r_map_move(&map, by_q20);
    rt->gaussians = map.count;
}

/* Moves the map's origin after the camera, in the map's range, if it is far away. */
static void follow(t3r_runtime *rt, const t3r_camera *camera)
{
    t3r_pose pose;
    bool far = false;
    (void)t3r_pose_in_scene(camera, &rt->frame, &pose);
    for (int i = 0; i < 3; i++) {
        far = far || t3r_abs32(pose.position_q20[i]) > REBASE_Q20;
    }
    if (far) {
        rebase(rt, pose.position_q20);
    }
}

/* Ignores retained keyframes out of range of the new origin, or with `all` every one but the slot's. */
static void leave_keyframes(t3r_runtime *rt, const t3r_view *views, uint32_t slot, bool all)
{
    for (uint32_t v = 0; v < rt->views; v++) {
        t3r_pose pose;
        if ((all && v != slot) || t3r_pose_in_scene(&rt->camera[v], &rt->frame, &pose) != T3R_OK) {
            memset(views[v].validity, T3R_NO_DEPTH, (size_t)views[v].width * views[v].height);
            rt->camera[v] = rt->camera[slot];
        }
    }
}

/* --- the keyframe alone, and among the live ones ---------------------------------------------------------------- */

static t3r_view_span alone(uint32_t slot)
{
    return (t3r_view_span){slot, slot + 1};
}

static t3r_status develop(t3r_runtime *rt, uint32_t slot, const t3r_frame *frame, const t3r_camera *camera)
{
    if (!t3r_progress(rt, T3R_STAGE_IMAGE, 0, 1)) {
        return T3R_ERR_CANCELLED;
    }
    rt->camera[slot] = *camera;
    rt->depth_unit_q40[slot] = frame->depth_unit_q40;
    return t3r_develop_view(rt, slot, frame, &rt->camera[slot]);
}

/* Computes the gains that bring the new keyframe and the previous one to their mean exposure. Older ones keep theirs:
 * each keyframe is levelled to the mean of its neighbours on the path, and the map changes along with the camera's
 * exposure. */
static t3r_status level_keyframe(t3r_runtime *rt, const t3r_view *views, uint32_t slot)
{
    if (!t3r_pointmap_step(rt, alone(slot), T3R_PART_EXPOSURE, 0)) {
        return T3R_ERR_CANCELLED;
    }
    const uint32_t before = (slot + rt->config.views - 1) % rt->config.views;
    for (int c = 0; c < 3; c++) {
        rt->gain_q14[slot][c] = T3R_GAIN_ONE_Q14;
    }
    if (!rt->config.exposure || before >= rt->views || before == slot) {
        return T3R_OK;
    }
    const t3r_pointmap_work work = t3r_pointmap_work_of(rt);
    const t3r_view pair[2] = {views[before], views[slot]};
    uint16_t gain_q14[2][3];
    if (t3r_exposure_gains(pair, 2, rt->frame.exponent, gain_q14, &work) == 2) {
        memcpy(rt->gain_q14[before], gain_q14[0], sizeof gain_q14[0]);
        memcpy(rt->gain_q14[slot], gain_q14[1], sizeof gain_q14[1]);
    }
    return T3R_OK;
}

/* Clears the marks of older keyframes; wide holes stay bridged. */
static void reset_older_marks(const t3r_runtime *rt, const t3r_view *views, uint32_t slot)
{
    for (uint32_t v = 0; v < rt->views; v++) {
        size_t pixels = (size_t)views[v].width * views[v].height;
        for (size_t i = 0; i < pixels && v != slot; i++) {
            views[v].validity[i] = t3r_unmarked(views[v].validity[i]);
        }
    }
}

static t3r_status compare_keyframes(t3r_runtime *rt, t3r_view *views, uint32_t slot)
{
    reset_older_marks(rt, views, slot);
    t3r_status status = t3r_bridge_holes(rt, views, alone(slot));
    if (status == T3R_OK) {
        status = t3r_find_flying_pixels(rt, views, alone(slot));
    }
    return status == T3R_OK ? level_keyframe(rt, views, slot) : status;
}

/* --- the keyframe joins the map ---------------------------------------------------------------------------------- */

static void measure_points(t3r_runtime *rt, const t3r_view *view, const t3r_workers *workers, t3r_stream_report *report)
{
    report->points = t3r_one_cluster(view, 1, t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS));
    t3r_blur_texture(&rt->kernels, view, 1, workers);
}

static t3r_status join_map(t3r_runtime *rt, t3r_view *views, uint32_t slot, t3r_stream_report *report)
{
    const t3r_view *view = &views[slot];
    const t3r_budget_work work = t3r_budget_work_of(rt);
    const t3r_pointmap keyframe = t3r_pointmap_of(view, rt->frame.exponent);
    const t3r_status status = t3r_find_texture(rt, views, alone(slot));
    if (status != T3R_OK) {
        return status;
    }
    measure_points(rt, view, &work.workers, report);
    t3r_map map = t3r_map_of(rt);
    t3r_map_disc *discs = t3r_buffer_at(rt, T3R_BUFFER_MAP_DISCS);
    report->removed =
        t3r_map_see(&map, &keyframe, rt->keyframes, rt->config.half_life, &work.workers, (uint8_t *)discs);
    t3r_remembered_hold(rt, &map);
    rt->gaussians = map.count;

    const t3r_map_density density = {&map, &keyframe, &work.workers, discs, t3r_buffer_at(rt, T3R_BUFFER_MAP_DENSITY)};
    const t3r_budget_settings settings = t3r_budget_settings_of(rt, views);
    t3r_map_density_find(&density);
    t3r_map_density_fit(&density);
    report->removed += t3r_map_drop(&map);
    rt->gaussians = map.count;
    t3r_budget_keys(view, 1, &settings, &work);
    t3r_map_density_raise_keys(&density, &settings, work.kernels);
    const t3r_map_cut cut = t3r_map_compete(&map, view, &settings, rt->config.gaussians);
    report->shown = t3r_map_density_mark(&density, cut.threshold);
    report->crowded = map.count - cut.kept;
    t3r_hash_pointmap(rt, views, slot, slot + 1);

    t3r_cluster *clusters = t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS);
    t3r_retain_below(view, &settings, cut.threshold, cut.point_ties, clusters);
    t3r_hash_budget(rt, views, slot, slot + 1);
    if (!t3r_progress(rt, T3R_STAGE_HEAD, 0, 1)) {
        return T3R_ERR_CANCELLED;
    }
    t3r_map_thin(&map, &cut);
    const uint32_t made = t3r_view_to_gaussians(rt, views, slot, &settings, map.gaussians + map.count);
    report->added = t3r_map_append(&map, made, &keyframe, &settings, clusters);
    rt->gaussians = map.count;
    t3r_hash_scene(rt, T3R_STAGE_HEAD);
    return T3R_OK;
}

/* --- the whole keyframe ----------------------------------------------------------------------------------------- */

/* Makes all Gaussians and keyframes those of an earlier piece of the map. */
static void begin_piece(t3r_runtime *rt)
{
    t3r_map map = t3r_map_of(rt);
    t3r_map_begin_piece(&map);
    rt->remembered = 0;
}

/* Takes the keyframe whose planes are in the slot. Not inlined, like refine_map(), so that only one of them has its
 * views on the stack. */
static __attribute__((noinline)) t3r_status take(t3r_runtime *rt, uint32_t slot, t3r_stream_report *report)
{
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);
    t3r_hash_image(rt, views, slot, slot + 1);
    t3r_status status = t3r_find_depth(rt, views, alone(slot));
    if (status == T3R_OK && rt->keyframes == 0) {
        status = t3r_choose_frame(rt, views);
    }
    if (status != T3R_OK) {
        return status;
    }
    if (report->moved != 0) {
        begin_piece(rt);
    }
    leave_keyframes(rt, views, slot, report->moved != 0);
    t3r_views_of(rt, views); /* poses in the current frame */
    status = compare_keyframes(rt, views, slot);
    return status == T3R_OK ? join_map(rt, views, slot, report) : status;
}

/* round: of keyframes shown again; 0 = a new one. */
static __attribute__((noinline)) t3r_status refine_map(t3r_runtime *rt, uint32_t round)
{
    t3r_view all[T3R_MAX_VIEWS];
    t3r_views_of(rt, all);
    const uint32_t passes = t3r_keyframe_passes_of(&rt->config, rt->config.warm && rt->keyframes > 1);
    const uint32_t parts = rt->config.refine_stride > 1 ? passes : 0;
    const t3r_status status = t3r_refine_scene(rt, all, (t3r_passes){passes, parts}, round, t3r_map_of(rt).records);
    if (status == T3R_OK) {
        t3r_hash_scene(rt, T3R_STAGE_REFINE);
    }
    return status;
}

/* --- a frame: taken or refused ---------------------------------------------------------------------------------- */

/* Measures the developed frame in the slot and decides. */
static __attribute__((noinline)) t3r_status judge(t3r_runtime *rt, uint32_t slot, t3r_stream_report *report)
{
    const t3r_view view = t3r_view_of(rt, slot);
    if (!rt->config.gate) {
        return t3r_is_reliable_anywhere(&view) ? T3R_OK : T3R_ERR_NO_DEPTH;
    }
    t3r_status status = T3R_OK;
    t3r_gate_measure(rt, &view, report);
    if (rt->config.align != 0 && rt->config.views > 1 && t3r_gate_suspects_jump(rt, &view, report)) {
        status = t3r_realign(rt, slot, report);
    }
    if (status == T3R_OK) {
        report->refusal = t3r_gate_decide(rt, &view, &rt->camera[slot], report);
        report->moved = report->moved != 0 && t3r_gate_contradicts(report);
    }
    return status;
}

static void count_map(const t3r_runtime *rt, t3r_stream_report *report)
{
    report->keyframes = rt->keyframes;
    report->gaussians = rt->gaussians;
}

/* Whether the camera is in the range of the map. */
static bool is_in_range(const t3r_runtime *rt, const t3r_camera *camera)
{
    t3r_pose pose;
    return rt->keyframes == 0 || t3r_pose_in_scene(camera, &rt->frame, &pose) == T3R_OK;
}

/* Refuses a frame whose pixels need not be looked at. */
static t3r_status look_ahead(const t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera,
                             t3r_refusal *refusal)
{
    const bool far = !is_in_range(rt, camera);
    if (!rt->config.gate) {
        return far ? T3R_ERR_CAMERA : frame->depth == NULL ? T3R_ERR_NO_DEPTH : T3R_OK;
    }
    *refusal = far ? T3R_REFUSAL_FAR : frame->depth == NULL ? T3R_REFUSAL_NO_DEPTH : T3R_REFUSAL_NONE;
    return T3R_OK;
}

/* Takes the developed frame, which the gate accepted. */
static t3r_status enter(t3r_runtime *rt, const t3r_held *held, t3r_stream_report *report)
{
    if (rt->keyframes > 0) {
        follow(rt, &rt->camera[held->slot]);
    }
    if (held->slot < held->views) {
        const t3r_view old = t3r_held_view(rt);
        t3r_remember(rt, &old, &held->camera, rt->gain_q14[held->slot]);
    }
    const t3r_status status = take(rt, held->slot, report);
    if (status != T3R_OK) {
        t3r_give_up(rt, held);
        *report = (t3r_stream_report){0};
        return status;
    }
    rt->next_slot = (held->slot + 1) % rt->config.views;
    rt->keyframes += rt->keyframes < UINT32_MAX;
    rt->has_scene = 1;
    count_map(rt, report);
    return rt->config.refine > 0 ? refine_map(rt, 0) : T3R_OK;
}

t3r_status t3r_stream_take(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, t3r_stream_report *report)
{
    *report = (t3r_stream_report){0};
    t3r_status status = look_ahead(rt, frame, camera, &report->refusal);
    if (status == T3R_OK && report->refusal == T3R_REFUSAL_NONE) {
        const t3r_held held = t3r_hold(rt, rt->next_slot);
        status = develop(rt, held.slot, frame, camera);
        if (status == T3R_OK) {
            rt->views = T3R_MAX(held.views, held.slot + 1);
            status = judge(rt, held.slot, report);
        }
        if (status == T3R_OK && report->refusal == T3R_REFUSAL_NONE) {
            return enter(rt, &held, report);
        }
        t3r_put_back(rt, &held);
    }
    if (status == T3R_OK) {
        count_map(rt, report);
    } else {
        *report = (t3r_stream_report){0};
    }
    return status;
}

/* --- a keyframe shown again -------------------------------------------------------------------------------------- */

/* Notes which Gaussians the frame in the slot sees. Its colours count as they are: gains of neighbours on the path say
 * nothing about keyframes in a mixed order. */
static __attribute__((noinline)) t3r_status look_again(t3r_runtime *rt, uint32_t slot)
{
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);
    t3r_hash_image(rt, views, slot, slot + 1);
    const t3r_status status = t3r_find_depth(rt, views, alone(slot));
    if (status != T3R_OK) {
        return status;
    }
    leave_keyframes(rt, views, slot, false);
    t3r_views_of(rt, views); /* poses in the current frame */
    for (int c = 0; c < 3; c++) {
        rt->gain_q14[slot][c] = T3R_GAIN_ONE_Q14;
    }
    const t3r_workers workers = t3r_workers_of(rt);
    const t3r_pointmap keyframe = t3r_pointmap_of(&views[slot], rt->frame.exponent);
    t3r_map map = t3r_map_of(rt);
    t3r_map_look(&map, &keyframe, &workers, t3r_buffer_at(rt, T3R_BUFFER_MAP_DISCS));
    return T3R_OK;
}

t3r_status t3r_stream_show(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, uint32_t round)
{
    if (frame->depth == NULL || !is_in_range(rt, camera)) {
        return frame->depth == NULL ? T3R_ERR_NO_DEPTH : T3R_ERR_CAMERA;
    }
    const t3r_held held = t3r_hold(rt, rt->next_slot);
    t3r_status status = develop(rt, held.slot, frame, camera);
    if (status == T3R_OK) {
        const t3r_view view = t3r_view_of(rt, held.slot);
        status = t3r_is_reliable_anywhere(&view) ? T3R_OK : T3R_ERR_NO_DEPTH;
    }
    if (status != T3R_OK) {
        t3r_put_back(rt, &held);
        return status;
    }
    rt->views = T3R_MAX(held.views, held.slot + 1);
    status = look_again(rt, held.slot);
    if (status != T3R_OK) {
        t3r_give_up(rt, &held);
        return status;
    }
    rt->next_slot = (held.slot + 1) % rt->config.views;
    return rt->config.refine > 0 ? refine_map(rt, round) : T3R_OK;
}
