/* The rasterizer: project, order, bin by tiles, blend front to back.
 *
 * Fewer bytes never change a pixel: the depth order is global, a pass takes as many whole tiles as its lists have
 * room for (one tile always fits), and a tile's pixels depend on nothing but its own list. */
#include "raster_list.h"

#include "core/features.h"
#include "core/fixed.h"
#include "kernels/hash_writer.h"
#include "state/state.h"

typedef struct tile_job {
    const t3r_binning *bin;
    const t3r_target *target;
    uint32_t pass_first; /* its list starts at 0 */
    uint32_t first;      /* tile of index 0 */
} tile_job;

/* Tiles drawn between two looks at the progress hook, and splats blended into them: a multiple of T3R_STOP_INTERVAL. */
#define DRAW_CHUNK 64u
#define DRAW_SPLATS 65536u

static uint32_t list_begin(const tile_job *job, uint32_t tile)
{
    return tile == job->pass_first ? 0 : job->bin->table[tile - 1];
}

static void draw_job(void *context, uint32_t index, uint32_t worker)
{
    (void)worker;
    const tile_job *job = context;
    const t3r_binning *bin = job->bin;
    const uint32_t tile = job->first + index, begin = list_begin(job, tile);
    t3r_drawn_tile drawn;
    t3r_draw_begin(&drawn, tile % bin->across, tile / bin->across);
    t3r_draw_list(&drawn, bin->kernels, bin->splats, bin->lists + begin, t3r_list_length(bin, begin, tile),
                  job->target);
    t3r_draw_end(&drawn, job->target);
}

/* How many tiles from the first on are drawn at once: none when that one is too long. */
static uint32_t chunk_of(const tile_job *job, uint32_t end)
{
    const uint32_t most = T3R_MIN(end - job->first, DRAW_CHUNK);
    uint32_t tiles = 0;
    for (uint64_t splats = 0; tiles < most; tiles++) {
        splats += t3r_list_length(job->bin, list_begin(job, job->first + tiles), job->first + tiles);
        if (splats > DRAW_SPLATS) {
            break;
        }
    }
    return tiles;
}

/* A tile that is too long to be drawn in one go: part after part, with a look at the hook before each. */
static bool draw_long(const t3r_runtime *rt, const tile_job *job)
{
    const t3r_binning *bin = job->bin;
    const uint32_t tile = job->first, begin = list_begin(job, tile), count = t3r_list_length(bin, begin, tile);
    t3r_drawn_tile drawn;
    t3r_draw_begin(&drawn, tile % bin->across, tile / bin->across);
    for (uint32_t from = 0; from < count && !drawn.stopped; from += DRAW_SPLATS) {
        if (from > 0 && !t3r_progress(rt, T3R_STAGE_RASTER, tile, bin->tiles)) {
            return false;
        }
        t3r_draw_list(&drawn, bin->kernels, bin->splats, bin->lists + begin + from, T3R_MIN(count - from, DRAW_SPLATS),
                      job->target);
    }
    t3r_draw_end(&drawn, job->target);
    return true;
}

/* Whether rows of `row_bytes` can be written there: aligned for their type, all of them. NULL: not wanted. */
static bool is_plane(const void *plane, size_t element_bytes, uint32_t row_bytes, uint32_t stride_bytes)
{
    return plane == NULL ||
           ((uintptr_t)plane % element_bytes == 0 && stride_bytes % element_bytes == 0 && stride_bytes >= row_bytes);
}

static t3r_status check_target(const t3r_runtime *rt, const t3r_target *t)
{
    if (t->width < 1 || t->height < 1 || t->width > rt->config.render_width || t->height > rt->config.render_height) {
        return T3R_ERR_ARGUMENT;
    }
    const bool fits = is_plane(t->rgb, sizeof *t->rgb, 3 * t->width, t->rgb_stride_bytes) &&
                      is_plane(t->depth_q20, sizeof *t->depth_q20, 4 * t->width, t->depth_stride_bytes) &&
                      is_plane(t->alpha_q15, sizeof *t->alpha_q15, 2 * t->width, t->alpha_stride_bytes);
    return fits ? T3R_OK : T3R_ERR_ARGUMENT;
}

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

t3r_status t3r_raster_tiles(const t3r_runtime *rt, const t3r_binning *bin, const t3r_target *target, uint32_t *passes)
{
    const t3r_workers workers = t3r_workers_of(rt);
    *passes = 0;
    for (uint32_t first = 0; first < bin->tiles; ++*passes) {
        uint32_t end = t3r_bin_pass(&workers, bin, first);
        for (tile_job job = {bin, target, first, first}; job.first < end;) {
            if (!t3r_progress(rt, T3R_STAGE_RASTER, job.first, bin->tiles)) {
                return T3R_ERR_CANCELLED;
            }
            const uint32_t tiles = chunk_of(&job, end);
            if (tiles == 0 && !draw_long(rt, &job)) {
                return T3R_ERR_CANCELLED;
            }
            t3r_run_tasks(&workers, tiles, draw_job, &job);
            job.first += T3R_MAX(tiles, 1u);
        }
        first = end;
    }
    return T3R_OK;
}

t3r_status t3r_render(t3r_runtime *rt, const t3r_camera *camera, const t3r_target *target)
{
    T3R_REFUSE_UNLESS(rt != NULL && camera != NULL && target != NULL, T3R_ERR_ARGUMENT);
    T3R_REFUSE_UNLESS(rt->has_scene, T3R_ERR_STATE);
    t3r_status status = check_target(rt, target);
    t3r_projection projection;
    if (status == T3R_OK) {
        status = t3r_projection_make(camera, &rt->frame, target->width, target->height, &projection);
    }
    if (status != T3R_OK) {
        return status;
    }
    if (!rt->config.keep_analysis && !t3r_is_stream(&rt->config)) {
        rt->analysed = 0; /* the raster's buffers lie where labels and clusters were */
        if (!t3r_is_warm(&rt->config)) {
            rt->views = 0; /* and the planes, which `warm` keeps apart */
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
    t3r_binning bin = t3r_raster_list(rt, &projection, &room);
    uint32_t passes;
    status = t3r_raster_tiles(rt, &bin, target, &passes);
    if (status != T3R_OK) {
        return status;
    }
    rt->render_passes = passes;
    if (rt->hooks.stage_hash != NULL) {
        rt->hooks.stage_hash(rt->hooks.user, T3R_STAGE_RASTER, hash_target(rt, target));
    }
    return T3R_OK;
}
