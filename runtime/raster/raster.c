/* SPDX-License-Identifier: Apache-2.0 */
/* The rasterizer: projects, orders, bins by tiles and blends front to back.
 *
 * Fewer bytes never change a pixel. The depth order is global, a pass takes as many whole tiles as its lists have
 * room for (one tile always fits), and the pixels of a tile depend on its own list alone. */
#include "raster_list.h"

#include "core/features.h"
#include "core/fixed.h"
#include "state/state.h"

typedef struct tile_job {
    const t3r_runtime *rt;
    const t3r_binning *bin;
    const t3r_target *target;
    uint32_t pass_first; /* tile whose list starts at entry 0 */
    uint32_t first;      /* tile of task 0 */
} tile_job;

/* Tiles and blended splats of a worker between two calls of the progress hook. DRAW_SPLATS is a multiple of
 * T3R_STOP_INTERVAL. */
#define DRAW_CHUNK 64u
#define DRAW_SPLATS 65536u

static uint32_t list_begin(const tile_job *job, uint32_t tile)
{
    return tile == job->pass_first ? 0 : job->bin->table[tile - 1];
}

/* Draws a tile, in parts if its list is long, and calls the progress hook before each part but the first. Returns
 * false when the hook cancels. */
static bool draw_tile(const tile_job *job, uint32_t tile)
{
    const t3r_binning *bin = job->bin;
    const uint32_t begin = list_begin(job, tile), count = t3r_list_length(bin, begin, tile);
    t3r_drawn_tile drawn;
    t3r_draw_begin(&drawn, tile % bin->across, tile / bin->across);
    for (uint32_t from = 0; from < count && !drawn.stopped; from += DRAW_SPLATS) {
        if (from > 0 && !t3r_progress(job->rt, T3R_STAGE_RASTER, tile, bin->tiles)) {
            return false;
        }
        t3r_draw_list(&drawn, bin, bin->lists + begin + from, T3R_MIN(count - from, DRAW_SPLATS), job->target);
    }
    t3r_draw_end(&drawn, job->target);
    return true;
}

/* Draws a tile of a chunk, whose list has one part, so that only the caller's thread calls the hook. */
static void draw_job(void *context, uint32_t index, uint32_t worker)
{
    (void)worker;
    const tile_job *job = context;
    (void)draw_tile(job, job->first + index);
}

/* Returns how many tiles from the first on are drawn at once; 0 when the first tile alone is too long. */
static uint32_t chunk_of(const tile_job *job, uint32_t end, const t3r_workers *workers)
{
    const uint32_t busy = t3r_is_parallel(workers) ? workers->count : 1;
    const uint32_t most = T3R_MIN(end - job->first, busy * DRAW_CHUNK);
    uint32_t tiles = 0;
    for (uint64_t splats = 0; tiles < most; tiles++) {
        const uint32_t tile = job->first + tiles, listed = t3r_list_length(job->bin, list_begin(job, tile), tile);
        splats += listed;
        if (listed > DRAW_SPLATS || splats > (uint64_t)busy * DRAW_SPLATS) {
            break;
        }
    }
    return tiles;
}

t3r_status t3r_raster_tiles(const t3r_runtime *rt, const t3r_binning *bin, const t3r_target *target, uint32_t *passes)
{
    const t3r_workers workers = t3r_workers_of(rt);
    *passes = 0;
    for (uint32_t first = 0; first < bin->tiles; ++*passes) {
        uint32_t end = t3r_bin_pass(&workers, bin, first);
        for (tile_job job = {rt, bin, target, first, first}; job.first < end;) {
            if (!t3r_progress(rt, T3R_STAGE_RASTER, job.first, bin->tiles)) {
                return T3R_ERR_CANCELLED;
            }
            const uint32_t tiles = chunk_of(&job, end, &workers);
            if (tiles == 0 && !draw_tile(&job, job.first)) {
                return T3R_ERR_CANCELLED;
            }
            t3r_run_tasks(&workers, tiles, draw_job, &job);
            job.first += T3R_MAX(tiles, 1u);
        }
        first = end;
    }
    return T3R_OK;
}
