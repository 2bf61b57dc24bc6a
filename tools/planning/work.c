/* SPDX-License-Identifier: Apache-2.0 */
#include "planning/work.h"

#include "core/config.h"
#include "core/fixed.h"
#include "head/head.h"
#include "head/weights.h"
#include "layout/arena.h"
#include "pointmap/align.h"
#include "refine/refine_layout.h"
#include "refine/view_levels.h"
#include "state/state.h"
#include "stereo/stereo_views.h"
#include "superclusters/superclusters.h"

static const struct {
    const char *name;
    t3r_stage stage;
} kinds[] = {
#define ROW(NAME, name, stage) {name, T3R_STAGE_##stage},
    WORK_KINDS(ROW)
#undef ROW
};

const char *work_name(work_kind kind)
{
    return kinds[kind].name;
}

t3r_stage work_stage(work_kind kind)
{
    return kinds[kind].stage;
}

/* ---- counts ------------------------------------------------------------------------------------------------------ */

/* Every product here stays below 2^64: pixels of all views are at most 2^28, Gaussians 2^24, passes and slices 2^8, and
 * KEEPS_ALL 2^10. */
typedef struct sizes {
    uint64_t pixels, views, points; /* of a view; of the build */
    uint64_t gaussians, clusters, batches, sampled, batched;
} sizes;

static sizes sizes_of(const t3r_config *c)
{
    const uint64_t pixels = (uint64_t)c->width * c->height, points = pixels * c->views;
    const uint32_t clusters = t3r_cluster_count(c), batches = t3r_cluster_batch_count(c);
    return (sizes){
        .pixels = pixels,
        .views = c->views,
        .points = points,
        .gaussians = T3R_MIN(c->gaussians, points),
        .clusters = clusters,
        .batches = batches,
        .sampled = T3R_MIN(points, t3r_cluster_sample(clusters)),
        .batched = batches * T3R_MIN(points, t3r_cluster_batch(clusters)),
    };
}

/* Pixels that alignment compares where all have depth: in half of the rounds that it may take, as a level mostly ends
 * early. Each takes about what a pixel of the other comparisons does. */
static uint64_t aligned_pixels(const t3r_config *c, const sizes *s)
{
    if (!t3r_aligns(c) || s->views < 2) {
        return 0;
    }
    const uint64_t compared = T3R_MIN(t3r_align_pixels((uint32_t)s->views), s->pixels / 4);
    return T3R_ALIGN_STEPS / 2 * s->views * (s->views - 1) * compared;
}

static void count_clustering(const sizes *s, uint64_t *units)
{
    units[WORK_SEEDING] = s->sampled * s->clusters;
    units[WORK_BATCHES] = s->batched;
    units[WORK_LABELS] = s->points;
    units[WORK_CENTRES] = (s->batched + s->points) * s->clusters;
    units[WORK_NEIGHBOURS] = (s->batches + 1) * s->clusters * s->clusters;
}

static void count_analysis(const t3r_config *c, const sizes *s, uint64_t *units)
{
    const uint64_t pairs = s->views * (s->views - 1) / 2;
    units[WORK_IMAGE] = s->points;
    if (c->depth == T3R_DEPTH_STEREO) {
        units[WORK_STEREO] = T3R_MIN(pairs, T3R_STEREO_PARTNERS * s->views) * s->pixels;
    } else {
        units[WORK_DEPTH] = s->points;
    }
    units[WORK_POINTMAP] = s->points;
    units[WORK_COMPARISON] = 2 * pairs * s->pixels + aligned_pixels(c, s);
    units[WORK_WAVELET] = s->points;
    if (s->clusters > 1) {
        count_clustering(s, units);
    }
    units[WORK_BUDGET] = s->points;
}

/* Whether a worker's part of the head's work has room for packed layers. */
static bool is_packed(const t3r_config *c, const t3r_layout *layout, const void *weights)
{
    const size_t room = layout->offset[T3R_BUFFER_SCENE] - layout->offset[T3R_BUFFER_HEAD_WORK];
    return t3r_head_learned_packed_bytes(weights, c->width) <= room / c->workers;
}

/* Plane layers run at every cell of their grid, point layers at each Gaussian. */
static void count_network(const void *weights, const t3r_config *c, const sizes *s, work_kind macs, uint64_t *units)
{
    units[WORK_FEATURES] = s->points;
    const uint32_t layers = t3r_weights_header_of(weights).layers;
    for (uint32_t i = 0; i < layers; i++) {
        const t3r_layer layer = t3r_weights_layer(weights, i);
        const uint32_t cell = 1u << layer.level;
        const uint64_t across = (c->width + cell - 1) / cell, down = (c->height + cell - 1) / cell;
        const uint64_t places = layer.kind == T3R_LAYER_POINT ? s->gaussians : across * down * s->views;
        units[WORK_ACTIVATIONS] += places * layer.outputs;
        units[macs] += places * layer.outputs * t3r_layer_taps(&layer);
    }
}

/* Returns the Gaussians of `analytic`: fitting a width to one other view takes a fifth of what a disc takes. */
static uint64_t count_discs(const t3r_config *c, const sizes *s)
{
    const bool fits = c->fit_widths != 0 && c->refine == 0;
    return s->gaussians + (fits ? s->gaussians * (s->views - 1) / 5 : 0);
}

static void count_head(const t3r_config *c, const t3r_layout *layout, const void *weights, const sizes *s,
                       uint64_t *units)
{
    if (c->head == T3R_HEAD_LEARNED) {
        const bool packed = is_packed(c, layout, weights);
        count_network(weights, c, s, packed ? WORK_MACS : WORK_UNPACKED_MACS, units);
        units[WORK_LIFTS] = s->gaussians;
    } else {
        units[WORK_DISC_PIXELS] = s->points;
        units[WORK_DISC_GAUSSIANS] = count_discs(c, s);
    }
}

/* With fewer Gaussians less of a tile's splats is kept while it is drawn, and more is made again. */
#define KEEPS_ALL 1024u

/* Returns the number of parts into which refinement divides the Gaussians: each needs a drawing. */
static uint32_t count_slices(const t3r_config *c, size_t refine_bytes)
{
    const uint32_t slice = refine_bytes > 0 ? t3r_refine_slice_gaussians(c, refine_bytes) : c->gaussians;
    return (c->gaussians + slice - 1) / slice;
}

static void count_drawing(const t3r_config *c, const sizes *s, uint32_t slices, uint64_t *units)
{
    /* each slice lists the views, and draws the tiles that its Gaussians reach into: measured, a third of them */
    const uint64_t again = c->structural && s->views > 1 ? T3R_MIN(c->refine, T3R_LEVELLED_PASSES) : 0;
    const uint64_t listed = (c->refine * slices + again) * s->views;
    const uint64_t compared = c->refine * s->views * s->pixels * (slices + 2) / 3;
    const uint64_t drawn = compared + (c->structural ? compared / 16 : 0); /* measured */
    units[WORK_REFINE_PIXELS] = drawn;
    units[WORK_REFINE_GAUSSIANS] = listed * s->gaussians;
    units[WORK_CORRECTIONS] = c->refine * s->gaussians;
    if (c->max_gaussians < KEEPS_ALL) {
        units[WORK_REMADE_PIXELS] = drawn * (KEEPS_ALL - c->max_gaussians) / c->max_gaussians;
    }
    units[WORK_RASTER_PIXELS] = (uint64_t)c->render_width * c->render_height;
    units[WORK_RASTER_GAUSSIANS] = c->gaussians;
}

t3r_status work_count(const t3r_config *config, size_t bytes, const void *weights, work_counts *counts)
{
    t3r_layout layout;
    t3r_status status = t3r_config_check(config);
    if (status == T3R_OK) {
        status = t3r_lay_out(config, bytes, &layout);
    }
    if (status != T3R_OK) {
        return status;
    }
    const sizes s = sizes_of(config);
    *counts = (work_counts){{0}};
    if (config->views > 0) {
        count_analysis(config, &s, counts->units);
        count_head(config, &layout, weights, &s, counts->units);
    }
    count_drawing(config, &s, count_slices(config, layout.refine_bytes), counts->units);
    return T3R_OK;
}

/* ---- prices ------------------------------------------------------------------------------------------------------ */

double work_price(const work_counts *counts, const work_prices *prices, t3r_stage stage)
{
    double sum = 0;
    for (int kind = 0; kind < WORK_KIND_COUNT; kind++) {
        if (kinds[kind].stage == stage) {
            sum += (double)counts->units[kind] * prices->milli[kind] / 1000;
        }
    }
    return sum;
}

double work_price_of_build(const work_counts *counts, const work_prices *prices)
{
    double sum = 0;
    for (int stage = 0; stage < T3R_STAGE_RASTER; stage++) {
        sum += work_price(counts, prices, (t3r_stage)stage);
    }
    return sum;
}
