/* What a configuration needs: bytes by buffer, steps by stage. */
#include "arena.h"
#include "fixed.h"
#include "budget/importance.h"
#include "head/network.h"
#include "state.h"
#include "superclusters/superclusters.h"

/* Multiply-accumulates of the largest head there may be, views rounded up to whole blocks of pixels at the coarsest
 * level; gathering a layer's inputs and requantizing its outputs take no more steps than that each. Features twice. */
static uint64_t learned_operations(const t3r_config *c)
{
    const uint64_t views = c->stream ? 1 : c->views;
    const uint64_t block = T3R_BLOCK_PIXELS << T3R_MAX_LEVEL;
    uint64_t across = (c->width + block - 1) / block, down = (c->height + block - 1) / block;
    return 3 * T3R_MAX_HEAD_MACS * across * down * block * block * views +
           ((uint64_t)c->width * c->height * views + c->max_gaussians) * 2 * T3R_FEATURES;
}

/* Windows of retained points, at every pixel for a learned head, at most twice at every retained one. */
static uint64_t share_operations(const t3r_config *c)
{
    uint64_t windows = (uint64_t)c->width * c->height * c->views + 2 * (uint64_t)c->max_gaussians;
    return c->allocation == T3R_ALLOCATE_GIVEN ? windows * T3R_SHARE_STEPS : 0;
}

static uint64_t head_operations(const t3r_config *c)
{
    uint64_t pixels = (uint64_t)c->width * c->height * (c->stream ? 1 : c->views), gaussians = c->max_gaussians;
    switch (c->head) {
    case T3R_HEAD_LEARNED:
        return learned_operations(c);
    case T3R_HEAD_MOMENT: /* 31 x 31 after four sweeps of four offers, two costs each */
        return 3 * (pixels * (2 + 4 * 4 * 2) + gaussians * (31 * 31 + 32));
    default: /* the widest window of `analytic` is 15 x 15 */
        return pixels + 3 * gaussians * (15 * 15 + 32);
    }
}

/* First looks at all pairs, where there is a choice, and matches of two partners a view. A look draws both planes at
 * the full size and matches a quarter of it with up to twice as many disparities. A match: costs and paths of every
 * pixel and disparity, those downwards twice; the best of them, both ways; agreement, speckles, medians;
 * and two views of pixels brought back, some of them twice, and brought together. A view filled: four sweeps of five
 * offers, sums and planes. */
static uint64_t stereo_operations(const t3r_config *c)
{
    if (c->depth != T3R_DEPTH_STEREO || c->views < 2) {
        return 0;
    }
    const uint64_t side = T3R_RECTIFIED_SIDE(c->width, c->height), d = T3R_STEREO_DISPARITIES;
    const uint64_t planes = side * (2 * side + d), view = (uint64_t)c->width * c->height;
    const uint64_t pairs = (uint64_t)c->views * (c->views - 1) / 2, matches = T3R_MIN(pairs, 2 * (uint64_t)c->views);
    const uint64_t volume = side * side * d * (2 * (T3R_STEREO_PATHS + 1) + 3 + 4);
    const uint64_t look = 2 * planes + 2 * view + volume / 8;
    return (c->views > 2 ? pairs * look : 0) + matches * (look + volume + planes * (4 + 9) + 2 * view * 9) +
           c->views * view * (4 * 5 + 12);
}

/* Upper bounds of inner-loop steps: what each stage's loops run to at most, whatever the frames hold. */
static void count_operations(const t3r_config *c, uint64_t operations[T3R_STAGE_COUNT])
{
    const uint64_t side = T3R_MAX_SIDE, frame = side * side; /* the largest frame */
    const uint64_t tile = T3R_TILE_SIDE * T3R_TILE_SIDE;
    const uint64_t analysed = c->stream ? 1 : c->views; /* of a stream these are the steps of a keyframe */
    uint64_t view = (uint64_t)c->width * c->height, pixels = view * analysed;
    uint64_t tiles = T3R_TILES_(c->render_width, c->render_height);
    uint64_t tiles_of_view = T3R_TILES_(c->width, c->height);
    uint64_t clusters = c->clusters, gaussians = c->max_gaussians;
    uint64_t assigned = (uint64_t)c->cluster_batches * T3R_CLUSTER_BATCH + pixels;

    /* source pixels converted and summed along x, rows summed along y, planes and depth written, undistorted; the lens
     * search and the grid */
    operations[T3R_STAGE_IMAGE] = analysed * (4 * frame + 3 * (side + c->height) * c->width + 6 * view +
                                              64 * T3R_GRID_NODES_(c->width, c->height) + 8192);
    operations[T3R_STAGE_DEPTH] = pixels * (4 * (uint64_t)c->fill_radius + 2) + stereo_operations(c);
    /* two looks at the depths for their median, marks forgotten twice; wide holes: every pixel sought in all other
     * views, 17 looks at steps for its own there, eight directions, sought again; every pixel sought in all other
     * views: nine looks for flying ones, one for redundant ones, a quarter of them for exposure, its medians */
    uint64_t others = c->views > 0 ? c->views - 1 : 0;
    operations[T3R_STAGE_POINTMAP] =
        pixels * (4 + (c->bridge_radius > 0) * (22 * others + 8 * (uint64_t)c->bridge_radius) +
                  c->flying * (4 + 10 * others) + c->redundancy * 2 * others + c->exposure * 2 * others) +
        c->views * 3 * 512 + 1120;
    if (c->stream) { /* marks of all keyframes forgotten; each Gaussian moved, sought, nine looks; what is drawn
                        compared */
        operations[T3R_STAGE_POINTMAP] += view * (c->views + 2) + gaussians * (2 + 10);
    }
    /* two lifting passes of three steps and a sum a level, the levels adding up to less than 4 / 3 */
    operations[T3R_STAGE_WAVELET] = pixels * (7 * 4 / 3 + c->wavelet_levels + 1);
    /* seeding: a draw and a sum for each trial, one update; neighbours a batch; a point against all centres at most */
    operations[T3R_STAGE_SUPERCLUSTERS] =
        T3R_DIMENSIONS * (clusters * T3R_CLUSTER_SAMPLE * (2 * T3R_CLUSTER_TRIALS + 1) +
                          (c->cluster_batches + 1) * clusters * clusters * (1 + T3R_NEIGHBOURS) +
                          assigned * (clusters + T3R_NEIGHBOURS * 2));
    if (c->stream) { /* one group */
        operations[T3R_STAGE_SUPERCLUSTERS] = pixels;
    }
    /* textures, two blurs of nine taps, points counted twice, keys, 17 bisections, two density rounds, masks; ranking
     * and quotas */
    operations[T3R_STAGE_BUDGET] = pixels * (2 + 18 + 2 + 1 + 17 + 2 + 1) + 3 * clusters * clusters + 64 * clusters;
    if (c->stream) { /* keys once more, 18 looks at all keys that compete; who stays moved and widened */
        operations[T3R_STAGE_BUDGET] += pixels * (1 + 18 + 1) + gaussians * (18 + 1 + 16);
    }
    operations[T3R_STAGE_HEAD] = head_operations(c) + share_operations(c);
    /* at most eight slices, each view drawn for each: as the raster below, once more with a look at every pixel; eight
     * sweeps over six equations a Gaussian */
    uint64_t drawn = gaussians * (32 + 8 + tiles_of_view * (1 + 2 + 3 * tile + tile / 16)) + tiles_of_view * 4 * tile;
    operations[T3R_STAGE_REFINE] = c->refinements * (8 * c->views * (drawn + 2048) + gaussians * (8 * 36 + 64)) +
                                   c->stream * (drawn + 2048); /* the map as the keyframe sees it */
    /* project; four radix passes and their counts; counting and listing tiles; at most a pass a tile; each pixel of
     * each tile blended and its depth noted, a look for stopped tiles every 16 splats; tiles cleared and written */
    operations[T3R_STAGE_RASTER] =
        gaussians * (32 + 8 + tiles * (1 + 2 + 2 * tile + tile / 16)) + tiles * 3 * tile + 2048;
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
