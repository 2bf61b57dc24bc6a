/* SPDX-License-Identifier: Apache-2.0 */
#include "refine_layout.h"

#include "core/cut.h"
#include "core/fixed.h"
#include "refine.h"
#include "state/state.h"

uint32_t t3r_refine_slice_gaussians(const t3r_config *config, size_t bytes)
{
    const size_t most = config->max_gaussians, least_lists = T3R_UP_(most * sizeof(uint32_t));
    const size_t taken = T3R_REFINE_FIXED_BYTES_(config->width, config->height, most) + least_lists;
    return (uint32_t)T3R_MIN((bytes - taken) / T3R_REFINE_SUMS_BYTES, most);
}

t3r_refine_layout t3r_refine_layout_of(const t3r_runtime *rt)
{
    const t3r_config *c = &rt->config;
    const size_t most = c->max_gaussians;
    t3r_cut cut = t3r_cut_of(t3r_buffer_at(rt, T3R_BUFFER_REFINE_WORK), rt->refine_bytes);
    t3r_refine_layout w;
    w.room.splats = t3r_take(&cut, most * T3R_SPLAT_BYTES);
    w.room.order = t3r_take(&cut, most * T3R_ORDER_BYTES + T3R_SORT_BYTES);
    w.room.table = t3r_take(&cut, T3R_TILES_(c->width, c->height) * sizeof(uint32_t));
    w.corrections = t3r_take(&cut, most * T3R_CORRECTION_BYTES);
    w.kept = t3r_take(&cut, T3R_KEPT_BYTES_(most));
    w.slice = t3r_refine_slice_gaussians(c, rt->refine_bytes);
    w.sums = t3r_take(&cut, (size_t)w.slice * T3R_REFINE_SUMS_BYTES); /* the remaining bytes are a multiple of the
                                                                       * alignment */
    w.room.capacity = T3R_MIN((uint64_t)t3r_cut_left(&cut) / sizeof(uint32_t), (uint64_t)UINT32_MAX);
    w.room.lists = t3r_take(&cut, t3r_cut_left(&cut));

    const t3r_workers workers = t3r_workers_of(rt);
    w.borders.bands = t3r_is_parallel(&workers) ? workers.count : 1;
    w.borders.most = (uint32_t)T3R_REFINE_BORDER_(most);
    w.borders.sums = t3r_buffer_at(rt, T3R_BUFFER_BORDER_SUMS);
    w.borders.index = (void *)(w.borders.sums + (size_t)(c->workers - 1) * w.borders.most);
    w.wanted = t3r_buffer_at(rt, T3R_BUFFER_WANTED);

    w.kept_words = T3R_KEPT_LEAST;
    if (T3R_KEPT_BYTES_(most) == 0) { /* the sort's key buffers are large enough */
        const uint32_t words = (uint32_t)(most * T3R_RASTER_SPARE_BYTES / sizeof *w.kept);
        w.borders.bands = T3R_MIN(w.borders.bands, words / T3R_KEPT_LEAST);
        w.kept = t3r_raster_spare(&w.room);
        w.kept_words = words / w.borders.bands;
    } else {
        w.borders.bands = 1;
    }
    return w;
}
