/* SPDX-License-Identifier: Apache-2.0 */
#include "remember.h"

#include "core/bits.h"
#include "core/camera.h"
#include "core/memory.h"
#include "pointmap/reproject.h"
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
    return t3r_camera_check(camera, view->width, view->height) == T3R_OK &&
           t3r_pose_in_scene(camera, &rt->frame, &view->pose) == T3R_OK;
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

/* Returns the remembered keyframe that the map needs least, if `old` is remembered too: by the Gaussians that it shows,
 * times its weight. Not inlined, so that its views are not on the stack later. */
static __attribute__((noinline)) uint32_t least_needed(const t3r_runtime *rt, const t3r_view *old,
                                                       const t3r_camera *camera)
{
    const t3r_map map = t3r_map_of(rt);
    t3r_view views[T3R_MAX_REMEMBERED], replaced;
    const bool stands = stand_at(rt, camera, &replaced);
    replaced.validity = old->validity;
    for (uint32_t k = 0; k < rt->remembered; k++) {
        if (!stand_at(rt, &t3r_remembered_at(rt, k)->camera, &views[k])) {
            return k;
        }
    }
    uint64_t need_q8[T3R_MAX_REMEMBERED] = {0};
    for (uint32_t i = 0; i < map.count; i++) {
        const t3r_gaussian *g = &map.gaussians[i];
        uint32_t shown_by = 0; /* a bit for each remembered keyframe, and one for the old one */
        for (uint32_t k = 0; k < rt->remembered; k++) {
            const uint16_t *pixels = t3r_remembered_pixels(t3r_remembered_at(rt, k));
            shown_by |= (uint32_t)shows(&views[k], pixels, g, &map.records[i]) << k;
        }
        const bool old_shows = stands && shows(&replaced, NULL, g, &map.records[i]);
        shown_by |= (old_shows ? 1u : 0u) << rt->remembered;
        const uint32_t part_q8 = 256 / T3R_MAX(t3r_ones(shown_by), 1u);
        for (uint32_t k = 0; k < rt->remembered; k++) {
            need_q8[k] += (shown_by >> k & 1) * part_q8;
        }
    }
    uint32_t least = 0;
    for (uint32_t k = 0; k < rt->remembered; k++) {
        need_q8[k] *= weight_of(t3r_remembered_at(rt, k)->number); /* below 2^32 x 2^31 */
        least = need_q8[k] < need_q8[least] ? k : least;
    }
    return least;
}

void t3r_remember(t3r_runtime *rt, const t3r_view *old, const t3r_camera *camera, const uint16_t gain_q14[3])
{
    if (rt->config.remember == 0 || !shows_anything(old)) {
        return;
    }
    const uint32_t number = rt->keyframes - rt->config.views + 1; /* the oldest of the live ones */
    const uint32_t at = rt->remembered < rt->config.remember ? rt->remembered++ : least_needed(rt, old, camera);
    t3r_remembered *keyframe = t3r_remembered_at(rt, at);
    *keyframe = (t3r_remembered){.camera = *camera, .number = number};
    memcpy(keyframe->gain_q14, gain_q14, sizeof keyframe->gain_q14);
    uint16_t *pixels = t3r_remembered_pixels(keyframe);
    for (uint32_t y = 0; y < old->height; y++) {
        for (uint32_t x = 0; x < old->width; x++) {
            *pixels++ = packed(old, x, y);
        }
    }
}
