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

/* Upper bounds of inner-loop steps: what each stage's loops run to at most, whatever the frames hold. */
static void count_operations(const t3r_config *c, uint64_t operations[T3R_STAGE_COUNT])
{
    uint64_t pixels = (uint64_t)c->width * c->height * c->views;
    uint64_t across = (c->render_width + T3R_TILE_SIDE - 1) / T3R_TILE_SIDE;
    uint64_t tiles = T3R_TILES_(c->render_width, c->render_height);
    uint64_t clusters = c->clusters, gaussians = c->max_gaussians;
    uint64_t frame = (uint64_t)T3R_MAX_SIDE * T3R_MAX_SIDE;

    /* every source pixel twice (the box's two axes), every pixel once resized and once undistorted */
    operations[T3R_STAGE_IMAGE] = c->views * 2 * frame + 2 * pixels;
    operations[T3R_STAGE_DEPTH] = pixels * (4 * (uint64_t)c->fill_radius + 2);
    operations[T3R_STAGE_POINTMAP] = 2 * pixels; /* two looks at the depths for their median */
    /* two lifting passes of three steps and a sum a level, the levels adding up to less than 4 / 3 */
    operations[T3R_STAGE_WAVELET] = pixels * (7 * 4 / 3 + c->wavelet_levels + 1);
    /* seeding: a draw and a sum for each trial, one update; neighbours a batch; a point against all centres at most */
    operations[T3R_STAGE_SUPERCLUSTERS] =
        T3R_DIMENSIONS *
        (clusters * T3R_CLUSTER_SAMPLE * (2 * T3R_CLUSTER_TRIALS + 1) +
         (c->cluster_batches + 1) * clusters * clusters * (1 + T3R_NEIGHBOURS) +
         ((uint64_t)c->cluster_batches * T3R_CLUSTER_BATCH + pixels) * (clusters + T3R_NEIGHBOURS * 2));
    /* textures, two blurs of nine taps, keys, 17 bisections, two density rounds, masks; ranking and quotas */
    operations[T3R_STAGE_BUDGET] = pixels * (2 + 18 + 1 + 17 + 2 + 1) + 2 * clusters * clusters;
    /* the widest window of `analytic` is 15 x 15, of `moment` 31 x 31 after four sweeps of four offers */
    operations[T3R_STAGE_HEAD] =
        c->head == T3R_HEAD_MOMENT ? pixels * 17 + gaussians * (31 * 31 + 32) : pixels + gaussians * (15 * 15 + 32);
    operations[T3R_STAGE_REFINE] = 0;
    /* project; four radix passes and their counts; counting tiles; at most a pass a tile, which scans its row of tiles
     * and the next; every pixel of every tile */
    operations[T3R_STAGE_RASTER] =
        gaussians * (32 + 8 + tiles + tiles * (1 + 2 * across) + tiles * T3R_TILE_SIDE * T3R_TILE_SIDE);
}

t3r_status t3r_plan(const t3r_config *config, t3r_plan_info *plan)
{
    T3R_REFUSE_UNLESS(config != NULL && plan != NULL, T3R_ERR_ARGUMENT);
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
