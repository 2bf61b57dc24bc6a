/* SPDX-License-Identifier: Apache-2.0 */
#include "remember.h"

#include "core/bits.h"
#include "core/camera.h"
#include "core/memory.h"
#include "pointmap/reproject.h"
#include "refine/refine.h"
#include "state/remembered.h"

/* Sets the view's lens and pose to the keyframe's. Returns false if it is out of the map's range. */
static bool stand_at(const t3r_runtime *rt, const t3r_camera *camera, t3r_view *view)
{
    *view = (t3r_view){
        .width = rt->config.width,
        .height = rt->config.height,
        .fx_q16 = camera->fx_q16,
        .fy_q16 = camera->fy_q16,
        .cx_q16 = camera->cx_q16,
        .cy_q16 = camera->cy_q16,
    };
    return t3r_camera_check(camera) == T3R_OK && t3r_pose_in_scene(camera, &rt->frame, &view->pose) == T3R_OK;
}

/* Whether the view shows the Gaussian about as finely as its own keyframe, on a pixel that had a depth. The Gaussian
 * may be hidden there, as remembered keyframes have no depth. pixels: NULL for a view that still has its planes. */
static bool shows(const t3r_view *view, const uint16_t *pixels, const t3r_gaussian *g, const t3r_map_record *record)
{
    t3r_projected_pixel at;
    return t3r_project_to_pixel(view, g->position_q20, &at) &&
           (pixels == NULL ? t3r_has_depth(view->validity[at.pixel]) : t3r_is_remembered(pixels[at.pixel])) &&
           t3r_grain_q8(view, at.z_q20) - record->grain_q8 <= T3R_AFAR_Q8;
}

void t3r_remembered_hold(const t3r_runtime *rt, t3r_map *map)
{
    const uint32_t idle_most = rt->config.views;
    for (uint32_t k = 0; k < rt->remembered; k++) {
        t3r_remembered *keyframe = t3r_remembered_at(rt, k);
        t3r_view view;
        if (!stand_at(rt, &keyframe->camera, &view)) {
            continue;
        }
        for (uint32_t i = 0; i < map->count; i++) {
            t3r_map_record *record = &map->records[i];
            if (record->idle >= idle_most &&
                shows(&view, t3r_remembered_pixels(keyframe), &map->gaussians[i], record)) {
                record->idle = (uint8_t)(idle_most - 1);
            }
        }
    }
}

/* Thresholds of an ordered dither, in 1/16: flat surfaces keep their mean in five bits. */
static const uint8_t dither[4][4] = {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};

static uint16_t packed(const t3r_view *view, uint32_t x, uint32_t y)
{
    const size_t at = (size_t)y * view->width + x;
    const uint32_t threshold = 16u * dither[y % 4][x % 4] + 7;
    uint32_t pixel = t3r_has_depth(view->validity[at]) ? T3R_REMEMBERED_KNOWN : 0;
    for (int c = 0; c < 3; c++) {
        pixel |= (view->colour[c][at] * 31u + threshold) / 255u << (5 * c); /* at most 31: thresholds are below 255 */
    }
    return (uint16_t)pixel;
}

static bool shows_anything(const t3r_view *view)
{
    const size_t pixels = (size_t)view->width * view->height;
    for (size_t i = 0; i < pixels; i++) {
        if (t3r_has_depth(view->validity[i])) {
            return true;
        }
    }
    return false;
}

/* Returns the weight of keyframe `number`: 1, 2 for every second, 4 for every fourth, so that the remembered ones are
 * spread over time. */
static uint32_t weight_of(uint32_t number)
{
    return number & (0u - number);
}

/* Sets bit `bit` of each Gaussian that the view shows. */
static void add_shown(const t3r_map *map, const t3r_view *view, const uint16_t *pixels, uint32_t bit,
                      uint32_t *shown_by)
{
    for (uint32_t i = 0; i < map->count; i++) {
        shown_by[i] |= (uint32_t)shows(view, pixels, &map->gaussians[i], &map->records[i]) << bit;
    }
}

/* Returns the remembered keyframe that the map needs least, other than the one in the slot: by the Gaussians that it
 * shows, times its weight. */
static uint32_t least_needed(const t3r_runtime *rt, uint32_t slot)
{
    const t3r_map map = t3r_map_of(rt);
    uint32_t *shown_by = t3r_refine_room(rt).order; /* one bit per keyframe; the memory is unused between keyframes */
    memset(shown_by, 0, map.count * sizeof *shown_by);
    t3r_view view;
    for (uint32_t k = 0; k < rt->remembered; k++) {
        t3r_remembered *keyframe = t3r_remembered_at(rt, k);
        if (!stand_at(rt, &keyframe->camera, &view)) {
            return k;
        }
        add_shown(&map, &view, t3r_remembered_pixels(keyframe), k, shown_by);
    }
    if (stand_at(rt, &rt->camera[slot], &view)) {
        view.validity = t3r_view_of(rt, slot).validity;
        add_shown(&map, &view, NULL, rt->remembered, shown_by);
    }
    uint64_t need_q8[T3R_MAX_REMEMBERED] = {0};
    for (uint32_t i = 0; i < map.count; i++) {
        const uint32_t part_q8 = 256 / T3R_MAX(t3r_ones(shown_by[i]), 1u);
        for (uint32_t k = 0; k < rt->remembered; k++) {
            need_q8[k] += (shown_by[i] >> k & 1) * part_q8;
        }
    }
    uint32_t least = 0;
    for (uint32_t k = 0; k < rt->remembered; k++) {
        need_q8[k] *= weight_of(t3r_remembered_at(rt, k)->number); /* below 2^32 x 2^31 */
        least = need_q8[k] < need_q8[least] ? k : least;
    }
    return least;
}

void t3r_remember(t3r_runtime *rt, uint32_t slot)
{
    const t3r_view view = t3r_view_of(rt, slot);
    if (rt->config.remember == 0 || slot >= rt->views || !shows_anything(&view)) {
        return;
    }
    const uint32_t number = rt->keyframes - rt->views + 1; /* the oldest of the live ones */
    const uint32_t at = rt->remembered < rt->config.remember ? rt->remembered++ : least_needed(rt, slot);
    t3r_remembered *keyframe = t3r_remembered_at(rt, at);
    *keyframe = (t3r_remembered){.camera = rt->camera[slot], .number = number};
    memcpy(keyframe->gain_q14, rt->gain_q14[slot], sizeof keyframe->gain_q14);
    uint16_t *pixels = t3r_remembered_pixels(keyframe);
    for (uint32_t y = 0; y < view.height; y++) {
        for (uint32_t x = 0; x < view.width; x++) {
            *pixels++ = packed(&view, x, y);
        }
    }
}
