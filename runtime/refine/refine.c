#include "refine.h"

#include <string.h>

#include "core/fixed.h"
#include "refine_tile.h"
#include "core/state.h"

/* The refinement work, cut up. The first four parts and the least lists always fit; sums take what they can use of the
 * rest, lists what is left. */
typedef struct workshop {
    t3r_raster_room room;
    t3r_correction *corrections; /* of all Gaussians: the pass before's, as far as this one's are not there yet */
    t3r_refine_sums *sums;
    uint32_t slice; /* Gaussians whose sums fit */
} workshop;

static workshop workshop_of(const t3r_runtime *rt)
{
    const t3r_config *c = &rt->config;
    size_t most = c->max_gaussians, least_lists = T3R_UP_(most * sizeof(uint32_t));
    uint8_t *at = t3r_buffer_at(rt, T3R_BUFFER_REFINE_WORK), *end = at + rt->refine_bytes;
    workshop w;
    w.room.splats = (void *)at;
    at += T3R_UP_(most * T3R_SPLAT_BYTES);
    w.room.order = (void *)at;
    at += T3R_UP_(most * T3R_ORDER_BYTES + T3R_SORT_BYTES);
    w.room.table = (void *)at;
    at += T3R_UP_(T3R_TILES_(c->width, c->height) * sizeof(uint32_t));
    w.corrections = (void *)at;
    at += T3R_UP_(most * T3R_CORRECTION_BYTES);
    w.sums = (void *)at;
    size_t rest = (size_t)(end - at) - least_lists;
    w.slice = (uint32_t)T3R_MIN(rest / T3R_REFINE_SUMS_BYTES, most);
    at += T3R_UP_((size_t)w.slice * T3R_REFINE_SUMS_BYTES); /* the rest is a multiple of the alignment */
    w.room.lists = (void *)at;
    w.room.capacity = T3R_MIN((uint64_t)(size_t)(end - at) / sizeof(uint32_t), (uint64_t)UINT32_MAX);
    return w;
}

t3r_raster_room t3r_refine_room(const t3r_runtime *rt)
{
    return workshop_of(rt).room;
}

/* Before a view adds to a Gaussian's sums they are brought to the scale that its box asks for. */
static void widen(t3r_refine_sums *sums, const t3r_splat *splat)
{
    uint32_t area = sums->area + (uint32_t)(splat->x1 - splat->x0 + 1) * (uint32_t)(splat->y1 - splat->y0 + 1);
    uint32_t shift = t3r_refine_shift(area) - t3r_refine_shift(sums->area);
    sums->area = area;
    if (shift == 0) {
        return;
    }
    for (int c = 0; c < 3; c++) {
        sums->colour[c] = (int32_t)t3r_round_shift64(sums->colour[c], shift);
    }
    sums->weight = (int32_t)t3r_round_shift64(sums->weight, shift);
    for (int k = 0; k < T3R_REFINE_MOMENTS_2; k++) {
        sums->gradient[k] = (int32_t)t3r_round_shift64(sums->gradient[k], shift);
    }
    for (int k = 0; k < T3R_REFINE_MOMENTS_4; k++) {
        sums->curvature[k] = (int32_t)t3r_round_shift64(sums->curvature[k], shift);
    }
}

/* One view drawn from the scene, no Gaussian being told. */
static uint64_t error_of(const t3r_runtime *rt, const workshop *w, const t3r_view *views, uint32_t v,
                         const t3r_projection *projection, uint32_t *pixels)
{
    t3r_binning bin = t3r_raster_list(rt, projection, &w->room);
    t3r_refine_view job = {
        .kernels = &rt->kernels, .view = &views[v], .splats = w->room.splats, .gain_q14 = rt->gain_q14[v]};
    uint64_t error = 0;
    for (uint32_t begin = 0; begin < bin.tiles;) {
        uint32_t end = t3r_bin_pass(&bin, begin);
        for (uint32_t tile = begin; tile < end; tile++) {
            uint32_t from = tile == begin ? 0 : bin.table[tile - 1];
            error += t3r_refine_tile_error(&job, bin.lists + from, bin.table[tile] - from, tile % bin.across,
                                           tile / bin.across, pixels);
        }
        begin = end;
    }
    return error;
}

/* Tiles after each other: neighbours add to the same sums. */
static void measure(const t3r_runtime *rt, const workshop *w, const t3r_view *views, uint32_t v,
                    const t3r_projection *projection, uint32_t first, uint32_t count)
{
    t3r_binning bin = t3r_raster_list(rt, projection, &w->room);
    for (uint32_t i = 0; i < count; i++) {
        if (w->room.splats[first + i].z_q20 != 0) {
            widen(&w->sums[i], &w->room.splats[first + i]);
        }
    }
    t3r_refine_view job = {
        .kernels = &rt->kernels,
        .view = &views[v],
        .projection = projection,
        .scene = t3r_buffer_at(rt, T3R_BUFFER_SCENE),
        .splats = w->room.splats,
        .sums = w->sums,
        .first = first,
        .count = count,
        .kept = t3r_raster_spare(&w->room),
        .kept_rows = (uint32_t)((size_t)rt->config.max_gaussians * T3R_RASTER_SPARE_BYTES / sizeof(t3r_blend_weights)),
        .gain_q14 = rt->gain_q14[v],
    };
    for (uint32_t begin = 0; begin < bin.tiles;) {
        uint32_t end = t3r_bin_pass(&bin, begin);
        for (uint32_t tile = begin; tile < end; tile++) {
            uint32_t from = tile == begin ? 0 : bin.table[tile - 1];
            t3r_refine_tile(&job, bin.lists + from, bin.table[tile] - from, tile % bin.across, tile / bin.across);
        }
        begin = end;
    }
}

t3r_status t3r_refine_map(t3r_runtime *rt, const t3r_view *views, const t3r_map_record *records)
{
    workshop w = workshop_of(rt);
    t3r_gaussian *scene = t3r_buffer_at(rt, T3R_BUFFER_SCENE);
    uint32_t slices = (rt->gaussians + w.slice - 1) / w.slice, done = 0;
    uint32_t total = rt->config.refinements * slices * rt->views;
    memset(w.corrections, 0, (size_t)rt->gaussians * sizeof *w.corrections);
    for (uint32_t pass = 0; pass < rt->config.refinements; pass++) {
        for (uint32_t first = 0; first < rt->gaussians; first += w.slice) {
            uint32_t count = T3R_MIN(w.slice, rt->gaussians - first);
            memset(w.sums, 0, (size_t)count * sizeof *w.sums);
            for (uint32_t v = 0; v < rt->views; v++) {
                if (!t3r_progress(rt, T3R_STAGE_REFINE, done++, total)) {
                    return T3R_ERR_CANCELLED;
                }
                t3r_projection projection;
                t3r_status status =
                    t3r_projection_make(&rt->camera[v], &rt->frame, rt->config.width, rt->config.height, &projection);
                if (status != T3R_OK) {
                    return status;
                }
                measure(rt, &w, views, v, &projection, first, count);
            }
            rt->kernels.solve(w.sums, count, w.corrections + first);
        }
        for (uint32_t i = 0; i < rt->gaussians; i++) {
            if (records == NULL || records[i].idle < rt->config.views) {
                t3r_refine_apply(&w.corrections[i], &scene[i]);
            }
        }
    }
    return T3R_OK;
}

t3r_status t3r_refine(t3r_runtime *rt, const t3r_view *views)
{
    return t3r_refine_map(rt, views, NULL);
}

t3r_status t3r_refine_error(t3r_runtime *rt, const t3r_view *views, uint32_t *error_q8)
{
    workshop w = workshop_of(rt);
    uint64_t error = 0; /* below 3 x 2^24 x 2^28 */
    uint32_t pixels = 0;
    for (uint32_t v = 0; v < rt->views; v++) {
        if (!t3r_progress(rt, T3R_STAGE_REFINE, v, rt->views)) {
            return T3R_ERR_CANCELLED;
        }
        t3r_projection projection;
        t3r_status status =
            t3r_projection_make(&rt->camera[v], &rt->frame, rt->config.width, rt->config.height, &projection);
        if (status != T3R_OK) {
            return status;
        }
        error += error_of(rt, &w, views, v, &projection, &pixels);
    }
    *error_q8 = pixels == 0 ? 0 : (uint32_t)t3r_round_div64((int64_t)error, 3 * (int64_t)pixels);
    return T3R_OK;
}
