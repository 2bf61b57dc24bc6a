/* SPDX-License-Identifier: Apache-2.0 */
/* Context views: converts frames to planes, and reports stereo's results. */
#include "adding_checks.h"
#include "core/gain.h"
#include "core/memory.h"
#include "image/image.h"
#include "layout/arena.h"
#include "state/state.h"

static bool has_measured_depth(const t3r_runtime *rt, uint32_t index)
{
    const t3r_view view = t3r_view_of(rt, index);
    return t3r_is_reliable_anywhere(&view);
}

uint32_t t3r_slot_of_next(const t3r_runtime *rt)
{
    return rt->views < rt->config.views ? rt->views : rt->next_slot;
}

bool t3r_takes_view(const t3r_runtime *rt)
{
    return !t3r_is_stream(&rt->config) &&
           (t3r_is_warm(&rt->config) ? rt->config.views > 0 : rt->views < rt->config.views && !rt->has_scene);
}

/* Whether the checked frame's depth has no measurement at all. */
static bool is_blind(const t3r_frame *frame)
{
    for (uint32_t y = 0; y < frame->depth_height; y++) {
        const uint8_t *row = frame->depth + (size_t)y * frame->depth_stride_bytes;
        for (uint32_t i = 0; i < 2 * frame->depth_width; i++) {
            if (row[i] != 0) {
                return false;
            }
        }
    }
    return true;
}

void t3r_begin_view(t3r_runtime *rt)
{
    rt->analysed = 0; /* the image stage uses the memory of later planes and the scene */
    rt->has_scene = 0;
    rt->strips = (t3r_strips){0};
}

t3r_status t3r_end_view(t3r_runtime *rt, uint32_t slot, const t3r_camera *undistorted, uint64_t depth_unit_q40)
{
    const bool stereo = t3r_is_by_stereo(&rt->config), replaces = slot < rt->views;
    t3r_reuse_no_view(rt, slot);
    if (!stereo && !has_measured_depth(rt, slot)) {
        if (replaces) {
            (void)t3r_reset(rt); /* the oldest view is gone */
        }
        return T3R_ERR_NO_DEPTH;
    }
    rt->camera[slot] = *undistorted;
    t3r_note_placement(&rt->given[slot], undistorted);
    rt->depth_unit_q40[slot] = stereo ? 1 : depth_unit_q40; /* stereo chooses its own unit */
    rt->stereo_pair[slot] = T3R_PAIR_OK;
    rt->stereo_partner[slot] = (uint8_t)slot;
    for (int c = 0; c < 3; c++) {
        rt->gain_q14[slot][c] = T3R_GAIN_ONE_Q14;
    }
    if (replaces) {
        rt->next_slot = (slot + 1) % rt->config.views;
    } else {
        rt->views++;
    }
    return T3R_OK;
}

t3r_status t3r_add_view(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera)
{
    t3r_frame shown;
    t3r_camera taken;
    T3R_PASS(t3r_add_view_checks(rt, frame, camera, &shown, &taken, NULL)); /* before anything is discarded */
    const uint32_t slot = t3r_slot_of_next(rt);
    const bool replaces = slot < rt->views;
    if (replaces && !t3r_is_by_stereo(&rt->config) && is_blind(frame)) {
        return T3R_ERR_NO_DEPTH; /* before the oldest view is overwritten */
    }
    t3r_begin_view(rt);
    const t3r_status status = t3r_develop_view(rt, slot, &shown, &taken);
    return status == T3R_OK ? t3r_end_view(rt, slot, &taken, frame->depth_unit_q40) : status;
}

t3r_status t3r_develop(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, uint8_t *rgb_out,
                       uint16_t *depth_out, t3r_camera *undistorted)
{
    t3r_camera taken;
    T3R_PASS(t3r_develop_call_checks(rt, frame, camera, rgb_out, undistorted, &taken, NULL));
    rt->strips = (t3r_strips){0};
    T3R_PASS(t3r_develop_view(rt, 0, frame, &taken));
    *undistorted = taken;
    const t3r_view view = t3r_view_of(rt, 0);
    size_t pixels = T3R_PIXELS_(rt->config.width, rt->config.height);
    for (size_t i = 0; i < pixels; i++) {
        for (int c = 0; c < 3; c++) {
            rgb_out[3 * i + (size_t)c] = view.colour[c][i];
        }
    }
    if (depth_out != NULL) {
        memcpy(depth_out, view.depth, pixels * sizeof *depth_out);
    }
    return T3R_OK;
}

t3r_pair t3r_stereo_pair(const t3r_runtime *rt, uint32_t view, uint32_t *partner)
{
    const bool known = rt != NULL && t3r_is_by_stereo(&rt->config) && view < rt->views;
    if (partner != NULL) {
        *partner = known ? rt->stereo_partner[view] : view;
    }
    return known ? (t3r_pair)rt->stereo_pair[view] : T3R_PAIR_OK;
}
