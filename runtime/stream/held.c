/* SPDX-License-Identifier: Apache-2.0 */
#include "held.h"

#include "core/memory.h"
#include "state/state.h"

t3r_view t3r_held_view(const t3r_runtime *rt)
{
    const size_t pixels = T3R_PIXELS_(rt->config.width, rt->config.height);
    uint16_t *depth = t3r_buffer_at(rt, T3R_BUFFER_HELD);
    uint8_t *colour = (uint8_t *)(depth + pixels);
    return (t3r_view){
        .width = rt->config.width,
        .height = rt->config.height,
        .colour = {colour, colour + pixels, colour + 2 * pixels},
        .depth = depth,
        .validity = colour + 3 * pixels,
    };
}

static void copy_planes(const t3r_view *from, const t3r_view *to)
{
    const size_t pixels = T3R_PIXELS_(from->width, from->height);
    for (int c = 0; c < 3; c++) {
        memcpy(to->colour[c], from->colour[c], pixels);
    }
    memcpy(to->depth, from->depth, pixels * sizeof *to->depth);
    memcpy(to->validity, from->validity, pixels);
}

t3r_held t3r_hold(const t3r_runtime *rt, uint32_t slot)
{
    if (slot < rt->views) {
        const t3r_view view = t3r_view_of(rt, slot), held = t3r_held_view(rt);
        copy_planes(&view, &held);
    }
    return (t3r_held){slot, rt->views, rt->camera[slot], rt->depth_unit_q40[slot]};
}

static void put_state_back(t3r_runtime *rt, const t3r_held *held)
{
    rt->views = held->views;
    rt->camera[held->slot] = held->camera;
    rt->depth_unit_q40[held->slot] = held->depth_unit_q40;
}

void t3r_put_back(t3r_runtime *rt, const t3r_held *held)
{
    const t3r_view view = t3r_view_of(rt, held->slot), old = t3r_held_view(rt);
    if (held->slot < held->views) {
        copy_planes(&old, &view);
    }
    put_state_back(rt, held);
}

void t3r_give_up(t3r_runtime *rt, const t3r_held *held)
{
    const t3r_view view = t3r_view_of(rt, held->slot);
    memset(view.validity, T3R_NO_DEPTH, T3R_PIXELS_(view.width, view.height));
    put_state_back(rt, held);
}
