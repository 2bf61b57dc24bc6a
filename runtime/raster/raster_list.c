/* SPDX-License-Identifier: Apache-2.0 */
#include "raster_list.h"

#include "core/config.h"
#include "core/fixed.h"
#include "state/state.h"

#define PROJECT_CHUNK 512u

typedef struct project_job {
    const t3r_kernels *kernels;
    const t3r_projection *projection;
    const t3r_lattice *lattice;
    const t3r_gaussian *gaussians;
    uint32_t count;
    t3r_splat *splats;
    uint32_t *depths;
    t3r_tile_span *spans;
} project_job;

static void project_chunk(void *context, uint32_t index, uint32_t worker)
{
    (void)worker;
    const project_job *job = context;
    const t3r_lattice lattice = t3r_lattice_in_use(job->lattice);
    uint32_t first = index * PROJECT_CHUNK, end = T3R_MIN(first + PROJECT_CHUNK, job->count);
    job->kernels->project(job->projection, job->gaussians + first, end - first, job->splats + first);
    for (uint32_t i = first; i < end; i++) {
        if (lattice.spread > 0 && job->splats[i].z_q20 != 0) {
            t3r_to_lattice(&lattice, &job->splats[i]);
        }
        job->depths[i] = (uint32_t)job->splats[i].z_q20;
        if (T3R_FEATURE_BACKDROP && job->gaussians[i].view == T3R_NO_VIEW && job->splats[i].z_q20 != 0) {
            job->splats[i].z_q20 = T3R_WITHOUT_DEPTH;
        }
        job->spans[i] = t3r_span_of(&job->splats[i]);
    }
}

const t3r_lattice t3r_all_pixels = {0, 0, 0};

t3r_binning t3r_raster_list(const t3r_runtime *rt, const t3r_projection *projection, const t3r_lattice *lattice,
                            const t3r_raster_room *room)
{
    const t3r_lattice in_use = t3r_lattice_in_use(lattice);
    const uint32_t width = t3r_lattice_side(projection->width, in_use.x, in_use.spread);
    const uint32_t height = t3r_lattice_side(projection->height, in_use.y, in_use.spread);
    uint32_t count = rt->gaussians, most = rt->config.max_gaussians;
    uint32_t *histogram = room->order;
    uint32_t *keys[2] = {histogram + T3R_SORT_BYTES / 4, histogram + T3R_SORT_BYTES / 4 + most};
    uint32_t *indices[2] = {keys[1] + most, keys[1] + 2 * (size_t)most};

    /* memory reused before its own use: the lists hold all spans, the second key buffer holds the depths */
    t3r_tile_span *all_spans = (t3r_tile_span *)(void *)room->lists;
    uint32_t *depths = keys[1];
    project_job projecting = {&rt->kernels, projection,   lattice, t3r_buffer_at(rt, T3R_BUFFER_SCENE),
                              count,        room->splats, depths,  all_spans};
    const t3r_workers workers = t3r_workers_of(rt);
    t3r_run_tasks(&workers, (count + PROJECT_CHUNK - 1) / PROJECT_CHUNK, project_chunk, &projecting);
    uint32_t visible = 0;
    for (uint32_t i = 0; i < count; i++) {
        keys[0][visible] = depths[i];
        indices[0][visible] = i;
        visible += depths[i] != 0;
    }
    const uint32_t side = t3r_order(&rt->kernels, keys, indices, visible, histogram);
    const uint32_t *order = indices[side];
    t3r_tile_span *spans = (t3r_tile_span *)(void *)indices[side ^ 1];
    for (uint32_t i = 0; i < visible; i++) {
        spans[i] = all_spans[order[i]];
    }

    t3r_binning bin = {
        .kernels = &rt->kernels,
        .projection = projection,
        .gaussians = projecting.gaussians,
        .splats = room->splats,
        .order = order,
        .spans = spans,
        .visible = visible,
        .across = (width + T3R_TILE_SIDE - 1) / T3R_TILE_SIDE,
        .tiles = (uint32_t)T3R_TILES_(width, height),
        .table = room->table,
        .lists = room->lists,
        .capacity = room->capacity,
        .most = t3r_tile_splats_of(&rt->config),
    };
    t3r_bin_count(&workers, &bin);
    return bin;
}
