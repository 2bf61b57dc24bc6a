/* SPDX-License-Identifier: Apache-2.0 */
/* Renders a view of the scene in the arena. */
#include "api/scene_checks.h"
#include "core/fixed.h"
#include "kernels/hash_writer.h"
#include "raster/raster_list.h"
#include "state/state.h"

static uint64_t hash_target(const t3r_runtime *rt, const t3r_target *target)
{
    t3r_hash_writer w;
    t3r_hash_begin(&w, rt->kernels.hash_bytes);
    t3r_write_u32(&w, target->width);
    t3r_write_u32(&w, target->height);
    for (uint32_t y = 0; y < target->height && target->rgb != NULL; y++) {
        t3r_write_bytes(&w, target->rgb + (size_t)y * target->rgb_stride_bytes, (size_t)3 * target->width);
    }
    for (uint32_t y = 0; y < target->height && target->depth_q20 != NULL; y++) {
        const uint32_t *row = target->depth_q20 + (size_t)y * (target->depth_stride_bytes / sizeof *row);
        for (uint32_t x = 0; x < target->width; x++) {
            t3r_write_u32(&w, row[x]);
        }
    }
    for (uint32_t y = 0; y < target->height && target->alpha_q15 != NULL; y++) {
        const uint16_t *row = target->alpha_q15 + (size_t)y * (target->alpha_stride_bytes / sizeof *row);
        t3r_write_u16s(&w, row, target->width);
    }
    return t3r_hash_end(&w);
}

t3r_status t3r_render(t3r_runtime *rt, const t3r_camera *camera, const t3r_target *target)
{
    t3r_projection projection;
    T3R_PASS(t3r_render_checks(rt, camera, target, &projection, NULL));
    if (!rt->config.keep_analysis && !t3r_is_stream(&rt->config)) {
        rt->analysed = 0; /* the raster's buffers lie where labels and clusters were */
        if (!t3r_is_warm(&rt->config)) {
            rt->views = 0; /* and the planes, which only `warm` keeps elsewhere */
        }
    }

    if (!t3r_progress(rt, T3R_STAGE_RASTER, 0, (uint32_t)T3R_TILES_(target->width, target->height))) {
        return T3R_ERR_CANCELLED;
    }
    t3r_raster_room room = {
        .splats = t3r_buffer_at(rt, T3R_BUFFER_SPLATS),
        .order = t3r_buffer_at(rt, T3R_BUFFER_ORDER),
        .table = t3r_buffer_at(rt, T3R_BUFFER_TILES),
        .lists = t3r_buffer_at(rt, T3R_BUFFER_LISTS),
        .capacity = rt->list_capacity,
    };
    t3r_binning bin = t3r_raster_list(rt, &projection, &t3r_all_pixels, &room);
    uint32_t passes;
    T3R_PASS(t3r_raster_tiles(rt, &bin, target, &passes));
    rt->render_passes = passes;
    if (rt->hooks.stage_hash != NULL) {
        rt->hooks.stage_hash(rt->hooks.user, T3R_STAGE_RASTER, hash_target(rt, target));
    }
    return T3R_OK;
}
