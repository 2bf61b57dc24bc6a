/* Settings: their defaults, their ranges, and what an arena for them needs. */
#include "arena.h"
#include "fixed.h"
#include "state.h"
#include "superclusters.h"

t3r_config t3r_default_config(uint32_t width, uint32_t height, uint32_t views, uint32_t gaussians)
{
    return (t3r_config){
        .width = width,
        .height = height,
        .views = views,
        .max_gaussians = gaussians,
        .gaussians = gaussians,
        .render_width = width,
        .render_height = height,
        .wavelet = T3R_WAVELET_DB2,
        .wavelet_levels = 2,
        .clusters = 300,
        .cluster_batches = 24,
        .colour_weight_q8 = 256,
        .allocation = T3R_ALLOCATE_DENSITY,
        .keep_percent = 10,
        .gamma_q8 = 179, /* 0.7 */
        .head = T3R_HEAD_ANALYTIC,
        .fill_radius = 4,
        .keep_analysis = 0,
        .seed = 1,
    };
}

const char *t3r_config_error(const t3r_config *c)
{
    if (c == NULL) {
        return "no configuration";
    }
    const struct {
        const char *text;
        uint32_t value, low, high;
    } range[] = {
        {"width must be 8..4096", c->width, T3R_MIN_SIDE, T3R_MAX_SIDE},
        {"height must be 8..4096", c->height, T3R_MIN_SIDE, T3R_MAX_SIDE},
        {"views must be 0..16", c->views, 0, T3R_MAX_VIEWS},
        {"max_gaussians must be 1..2^24", c->max_gaussians, 1, T3R_MAX_GAUSSIANS},
        {"gaussians must be 1..max_gaussians", c->gaussians, 1, c->max_gaussians},
        {"render_width must be 1..4096", c->render_width, 1, T3R_MAX_SIDE},
        {"render_height must be 1..4096", c->render_height, 1, T3R_MAX_SIDE},
        {"wavelet is none of t3r_wavelet", (uint32_t)c->wavelet, 0, T3R_WAVELET_COUNT - 1},
        {"wavelet_levels must be 1..5", c->wavelet_levels, 1, T3R_MAX_LEVELS},
        {"clusters must be 1..512", c->clusters, 1, T3R_MAX_CLUSTERS},
        {"cluster_batches must be 0..1024", c->cluster_batches, 0, 1024},
        {"colour_weight_q8 must be 0..1024", c->colour_weight_q8, 0, 1024},
        {"allocation is none of t3r_allocation", (uint32_t)c->allocation, 0, T3R_ALLOCATE_COUNT - 1},
        {"keep_percent must be 0..100", c->keep_percent, 0, 100},
        {"gamma_q8 must be 0..512", c->gamma_q8, 0, 512},
        {"head is none of t3r_head", (uint32_t)c->head, 0, T3R_HEAD_COUNT - 1},
        {"fill_radius must be 0..8", c->fill_radius, 0, 8},
        {"keep_analysis must be 0 or 1", c->keep_analysis, 0, 1},
    };
    for (size_t i = 0; i < sizeof range / sizeof range[0]; i++) {
        if (range[i].value < range[i].low || range[i].value > range[i].high) {
            return range[i].text;
        }
    }
    return NULL;
}

/* Upper bounds of inner-loop steps: what each stage's loops run to at most. */
static void count_operations(const t3r_config *c, uint64_t operations[T3R_STAGE_COUNT])
{
    uint64_t pixels = (uint64_t)c->width * c->height * c->views;
    uint64_t target = (uint64_t)c->render_width * c->render_height;
    uint64_t tiles = T3R_TILES_(c->render_width, c->render_height);
    operations[T3R_STAGE_IMAGE] = pixels * 8;
    operations[T3R_STAGE_DEPTH] = pixels * (4 * (uint64_t)c->fill_radius + 1);
    operations[T3R_STAGE_POINTMAP] = pixels * 3;
    operations[T3R_STAGE_WAVELET] = pixels * 8;
    operations[T3R_STAGE_SUPERCLUSTERS] =
        ((uint64_t)c->cluster_batches * T3R_CLUSTER_BATCH + 2 * T3R_CLUSTER_SAMPLE + pixels) * c->clusters * 6;
    operations[T3R_STAGE_BUDGET] = pixels * 32;
    operations[T3R_STAGE_HEAD] = (uint64_t)c->max_gaussians * 512;
    operations[T3R_STAGE_REFINE] = 0;
    operations[T3R_STAGE_RASTER] = (uint64_t)c->max_gaussians * (100 + 5 * tiles + target);
}

t3r_status t3r_plan(const t3r_config *config, t3r_plan_info *plan)
{
    if (config == NULL || plan == NULL) {
        return T3R_ERR_ARGUMENT;
    }
    if (t3r_config_error(config) != NULL) {
        return T3R_ERR_CONFIG;
    }
    t3r_layout layout;
    (void)t3r_lay_out(config, 0, &layout); /* for the two sums */
    (void)t3r_lay_out(config, layout.bytes, &layout);
    plan->min_bytes = layout.min_bytes;
    plan->bytes = layout.bytes;
    plan->buffer_count = T3R_BUFFER_COUNT;
    for (int b = 0; b < T3R_BUFFER_COUNT; b++) {
        t3r_plan_buffer *row = &plan->buffers[b];
        row->name = t3r_buffer_name((enum t3r_buffer)b);
        row->offset = layout.offset[b];
        row->bytes = layout.size[b];
        t3r_buffer_lifetime(config, (enum t3r_buffer)b, &row->first, &row->last);
    }
    count_operations(config, plan->operations);
    return T3R_OK;
}
