/* SPDX-License-Identifier: Apache-2.0 */
#include "realign.h"

#include "core/memory.h"
#include "motion.h"
#include "pointmap/align.h"
#include "pointmap/misalignment.h"
#include "pointmap/reproject.h"
#include "state/remembered.h"
#include "state/state.h"
#include "stream_gate.h"
#include "stream_map.h"

#define SAMPLES_MOST 512u /* Gaussians compared from each place */
#define GRID_HALF 4       /* places to either side along each axis */
#define GRID_SIDE (2 * GRID_HALF + 1)
#define GRID_STEP_Q20 (1 << 17) /* an eighth of a scene unit */

/* --- guesses ---------------------------------------------------------------------------------------------------- */

/* The step of the camera between the last keyframe and the first frame that contradicts the map. */
typedef enum step { STOOD_STILL, TURNED_AS_GIVEN, STEPS } step;

/* A guess of the frame's camera in the map's frame, and its votes. */
typedef struct candidate {
    t3r_camera camera;
    int32_t votes;
} candidate;

/* Moves the frame's camera to where it is after such a step, and after the motion that poses give from then on. Returns
 * false if that is not known. */
static bool move_by_step(const t3r_runtime *rt, uint32_t slot, step taken, t3r_camera *camera)
{
    const t3r_camera last = rt->camera[(slot + rt->config.views - 1) % rt->config.views];
    t3r_camera first = *camera;
    t3r_motion back;
    t3r_place_camera(&first, &rt->gate.contradicts_from);
    if (taken == TURNED_AS_GIVEN) {
        memcpy(first.rotation_q30, last.rotation_q30, sizeof first.rotation_q30);
    }
    if (!t3r_motion_between(&first, &last, &rt->frame, &back)) {
        return false;
    }
    t3r_move_camera(&back, &rt->frame, camera);
    return true;
}

/* Returns 1 if the frame shows the Gaussian, -1 if it sees through it, else 0. */
static int32_t vote(const t3r_pointmap *frame, const t3r_gaussian *g)
{
    const t3r_view *view = frame->view;
    t3r_projected_pixel at;
    if (!t3r_project_to_pixel(view, g->position_q20, &at) || !t3r_is_measured(view->validity[at.pixel])) {
        return 0;
    }
    const int32_t surface_q20 = t3r_depth_q20(frame->scale, view->depth[at.pixel]);
    if (!t3r_is_one_surface(surface_q20, at.z_q20, 16)) {
        return at.z_q20 < surface_q20 ? -1 : 0;
    }
    return t3r_map_is_alike(g, view, at.pixel);
}

static int32_t votes_of(const t3r_map *map, const t3r_pointmap *frame)
{
    const uint32_t every = (map->count + SAMPLES_MOST - 1) / SAMPLES_MOST;
    int32_t sum = 0;
    for (uint32_t i = 0; i < map->count; i += every) {
        sum += vote(frame, &map->gaussians[i]);
    }
    return sum;
}

/* Seeks the camera's best place on a grid around the candidate, by the votes of the map. Without a place in range the
 * votes are those of none. */
static void seek(t3r_runtime *rt, uint32_t slot, candidate *c)
{
    t3r_motion shift;
    c->votes = INT32_MIN;
    if (!t3r_motion_between(&c->camera, &c->camera, &rt->frame, &shift)) {
        return;
    }
    rt->camera[slot] = c->camera;
    t3r_view view = t3r_view_of(rt, slot);
    const t3r_pointmap frame = t3r_pointmap_of(&view, rt->frame.exponent);
    const t3r_map map = t3r_map_of(rt);
    for (int32_t at = 0; at < GRID_SIDE * GRID_SIDE * GRID_SIDE; at++) {
        const int32_t by[3] = {at % GRID_SIDE, at / GRID_SIDE % GRID_SIDE, at / (GRID_SIDE * GRID_SIDE)};
        for (int i = 0; i < 3; i++) {
            view.pose.position_q20[i] = shift.from_q20[i] + (by[i] - GRID_HALF) * GRID_STEP_Q20;
        }
        const int32_t votes = votes_of(&map, &frame);
        if (votes > c->votes) {
            c->votes = votes;
            memcpy(shift.to_q20, view.pose.position_q20, sizeof shift.to_q20);
        }
    }
    t3r_move_camera(&shift, &rt->frame, &c->camera);
}

/* Sets the slot's camera to the best candidate. Returns false if none is in range. Not inlined, so that its cameras are
 * not on the stack later. */
static __attribute__((noinline)) bool guess(t3r_runtime *rt, uint32_t slot)
{
    const t3r_camera given = rt->camera[slot];
    candidate best = {.camera = given, .votes = INT32_MIN};
    t3r_pose pose;
    for (step taken = STOOD_STILL; taken < STEPS; taken++) {
        candidate c = {.camera = given};
        if (move_by_step(rt, slot, taken, &c.camera)) {
            seek(rt, slot, &c);
            best = c.votes > best.votes ? c : best;
        }
    }
    rt->camera[slot] = best.camera;
    return best.votes > INT32_MIN && t3r_pose_in_scene(&rt->camera[slot], &rt->frame, &pose) == T3R_OK;
}

/* --- the pose, and the map's motion ------------------------------------------------------------------------------ */

/* Aligns the slot's camera with the live keyframes, from the guess on. */
static __attribute__((noinline)) t3r_status align(t3r_runtime *rt, uint32_t slot)
{
    const t3r_placement given = rt->given[slot];
    int32_t deviation_q30[T3R_ALIGN_UNKNOWNS];
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);
    memcpy(deviation_q30, rt->deviation_q30[slot], sizeof deviation_q30);
    t3r_note_placement(&rt->given[slot], &rt->camera[slot]);
    memset(rt->deviation_q30[slot], 0, sizeof rt->deviation_q30[slot]);
    const t3r_status status = t3r_align_view(rt, views, slot);
    rt->given[slot] = given;
    memcpy(rt->deviation_q30[slot], deviation_q30, sizeof deviation_q30);
    return status;
}

/* Moves the map, and all keyframes but the slot's. */
static void move(t3r_runtime *rt, const t3r_motion *motion, uint32_t slot)
{
    t3r_map map = t3r_map_of(rt);
    t3r_move_map(motion, &map);
    rt->gaussians = map.count;
    for (uint32_t v = 0; v < rt->views; v++) {
        if (v != slot) {
            t3r_move_camera(motion, &rt->frame, &rt->camera[v]);
        }
    }
    for (uint32_t k = 0; k < rt->remembered; k++) {
        t3r_move_camera(motion, &rt->frame, &t3r_remembered_at(rt, k)->camera);
    }
}

t3r_status t3r_realign(t3r_runtime *rt, uint32_t slot, t3r_stream_report *report)
{
    const t3r_camera given = rt->camera[slot];
    const bool found = guess(rt, slot);
    const t3r_status status = found ? align(rt, slot) : T3R_OK;
    if (found && status == T3R_OK) {
        t3r_stream_report aligned = *report;
        const t3r_view view = t3r_view_of(rt, slot);
        t3r_motion motion;
        t3r_gate_measure(rt, &view, &aligned);
        if (t3r_gate_agrees(&aligned, report) && t3r_motion_between(&rt->camera[slot], &given, &rt->frame, &motion)) {
            move(rt, &motion, slot);
            *report = aligned;
            report->realigned = 1;
        }
    }
    rt->camera[slot] = given;
    return status;
}
