/* SPDX-License-Identifier: Apache-2.0 */
/* The state after errors and cancels: refused calls preserve the documented state, and a damaged copy is refused. */
#include <string.h>

#include "budget/budget.h"
#include "budget/cluster_texture.h"
#include "core/fixed.h"
#include "core/hash.h"
#include "rgbd_frame.h"
#include "state/state.h"
#include "superclusters/superclusters.h"
#include "test.h"

enum { SIDE = 48, BUDGET = 300 };

static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[1 << 20], copy[1 << 20];
static uint8_t colour[SIDE * SIDE * 3], depth[SIDE * SIDE * 2];
static size_t arena_bytes;
static int cancel_at = -1;
static uint32_t calls_left = UINT32_MAX; /* of refinement, until it is cancelled */

static int cancel(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    (void)user;
    (void)done;
    (void)total;
    return (int)stage == cancel_at || (stage == T3R_STAGE_REFINE && calls_left-- == 0);
}

static t3r_frame made_up_frame(void)
{
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        uint32_t noise = t3r_mix32(i), step = 1500 + (i % SIDE) * 3;
        colour[3 * i] = (uint8_t)noise;
        colour[3 * i + 1] = (uint8_t)(i / SIDE * 4);
        colour[3 * i + 2] = (uint8_t)(noise >> 8);
        depth[2 * i] = (uint8_t)step;
        depth[2 * i + 1] = (uint8_t)(step >> 8);
    }
    return rgbd_frame(colour, depth, SIDE, SIDE, MILLIMETRE_Q40);
}

static t3r_camera made_up_camera(void)
{
    return straight_camera(SIDE);
}

static t3r_runtime *analysed_by(uint32_t clusters, t3r_scene *scene)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, 2, BUDGET);
    config.keep_analysis = 1;
    config.clusters = clusters;
    t3r_plan_info plan;
    assert_int_equal(t3r_plan(&config, &plan), T3R_OK);
    assert_true(plan.bytes <= sizeof arena);
    arena_bytes = plan.bytes;
    cancel_at = -1;
    t3r_runtime *rt;
    assert_int_equal(t3r_init(&rt, arena, arena_bytes, &config), T3R_OK);
    t3r_frame frame = made_up_frame();
    t3r_camera camera = made_up_camera();
    assert_int_equal(t3r_add_view(rt, &frame, &camera), T3R_OK);
    assert_int_equal(t3r_reconstruct(rt, NULL, scene), T3R_OK);
    t3r_hooks hooks = {.progress = cancel};
    assert_int_equal(t3r_set_hooks(rt, &hooks), T3R_OK);
    return rt;
}

enum { FEW = 12, MANY = 300 }; /* labels of eight bits, and of nine */

static t3r_runtime *analysed(t3r_scene *scene)
{
    return analysed_by(FEW, scene);
}

static uint64_t hash_of(const t3r_scene *scene)
{
    return t3r_hash_bytes(T3R_HASH_START, (const uint8_t *)scene->gaussians, scene->count * sizeof *scene->gaussians);
}

TEST(cancelled_rebuild_keeps_the_analysis)
{
    t3r_scene scene, again;
    t3r_runtime *rt = analysed(&scene);
    uint64_t before = hash_of(&scene);
    for (cancel_at = T3R_STAGE_BUDGET; cancel_at <= T3R_STAGE_REFINE; cancel_at++) {
        assert_int_equal(t3r_rebuild(rt, &(t3r_request){.gaussians = 100, .allocate = T3R_ALLOCATE_RANDOM}, &again),
                         T3R_ERR_CANCELLED);
        assert_int_equal(t3r_get_scene(rt, &again), T3R_ERR_STATE);
    }
    cancel_at = -1;
    assert_int_equal(t3r_rebuild(rt, NULL, &again), T3R_OK);
    assert_true(hash_of(&again) == before);
}

/* In an arena that keeps few of a tile's splats, refinement asks more than once per tile and view. */
TEST(every_call_of_refinement_may_cancel)
{
    enum { TILES = (SIDE / T3R_TILE_SIDE) * (SIDE / T3R_TILE_SIDE), MANY_CALLS = 10000 };
    t3r_scene scene;
    t3r_runtime *rt = analysed(&scene);
    const uint64_t before = hash_of(&scene);
    calls_left = MANY_CALLS;
    assert_int_equal(t3r_rebuild(rt, NULL, &scene), T3R_OK);
    const uint32_t calls = MANY_CALLS - calls_left;
    assert_true(calls > t3r_refinement_passes(rt) * (TILES + 1));
    for (uint32_t call = 0; call < calls; call += 1 + call / 8) {
        calls_left = call;
        assert_int_equal(t3r_rebuild(rt, NULL, &scene), T3R_ERR_CANCELLED);
        assert_int_equal(calls_left, UINT32_MAX); /* and nothing was asked after that */
        assert_int_equal(t3r_get_scene(rt, &scene), T3R_ERR_STATE);
    }
    calls_left = UINT32_MAX;
    assert_int_equal(t3r_rebuild(rt, NULL, &scene), T3R_OK);
    assert_true(hash_of(&scene) == before);
}

TEST(refused_view_gives_no_stale_scene)
{
    t3r_scene scene;
    t3r_runtime *rt = analysed(&scene);
    uint64_t before = hash_of(&scene);
    cancel_at = T3R_STAGE_HEAD;
    assert_int_equal(t3r_rebuild(rt, NULL, &scene), T3R_ERR_CANCELLED);
    cancel_at = -1;
    t3r_frame frame = made_up_frame();
    t3r_camera folded = made_up_camera();
    folded.distortion = T3R_DISTORTION_RADTAN;
    folded.distortion_q24[0] = -(100 << 24);
    assert_int_equal(t3r_add_view(rt, &frame, &folded), T3R_ERR_CAMERA);
    assert_int_equal(t3r_rebuild(rt, NULL, &scene), T3R_ERR_STATE); /* its planes were overwritten */
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    assert_true(hash_of(&scene) == before);
}

TEST(empty_depth_is_refused_at_the_door)
{
    t3r_scene scene;
    t3r_runtime *rt = analysed(&scene);
    assert_int_equal(t3r_reset(rt), T3R_OK);
    t3r_frame frame = made_up_frame();
    t3r_camera camera = made_up_camera();
    memset(depth, 0, sizeof depth);
    assert_int_equal(t3r_add_view(rt, &frame, &camera), T3R_ERR_NO_DEPTH);
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_ERR_STATE);
}

typedef void (*damage)(t3r_runtime *rt);

static void no_focal_length(t3r_runtime *rt)
{
    rt->camera[0].fx_q16 = 0;
}
static void no_depth_unit(t3r_runtime *rt)
{
    rt->depth_unit_q40[0] = 0;
}
static void wild_exponent(t3r_runtime *rt)
{
    rt->frame.exponent = INT32_MAX;
}
static void wild_median(t3r_runtime *rt)
{
    rt->median_depth_q20 = 0;
}
static void wild_label(t3r_runtime *rt)
{
    *(uint8_t *)t3r_buffer_at(rt, T3R_BUFFER_LABELS) = FEW;
}
/* Flips the ninth bit of a label: 256 more than there are, or a count that disagrees. */
static void other_half(t3r_runtime *rt)
{
    *(uint8_t *)t3r_buffer_at(rt, T3R_BUFFER_VALIDITY) ^= T3R_LABEL_HIGH;
}
static void wild_cluster(t3r_runtime *rt)
{
    ((t3r_cluster *)t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS))->points = UINT32_MAX;
}
/* Makes each SuperCluster claim all points: quotas from these would be many times the budget. */
static void greedy_clusters(t3r_runtime *rt)
{
    t3r_cluster *clusters = t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS);
    for (uint32_t k = 0; k < rt->config.clusters; k++) {
        clusters[k].points = SIDE * SIDE;
    }
}
/* Makes the order name one SuperCluster twice, while all labels and counts agree. */
static void order_without_an_end(t3r_runtime *rt)
{
    t3r_cluster *clusters = t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS);
    clusters[1].order = clusters[0].order;
}
/* Leaves a label, and its count, where there is no depth. */
static void label_without_depth(t3r_runtime *rt)
{
    ((uint8_t *)t3r_buffer_at(rt, T3R_BUFFER_VALIDITY))[0] = T3R_NO_DEPTH;
}
static void depth_of_nothing(t3r_runtime *rt)
{
    ((uint16_t *)t3r_buffer_at(rt, T3R_BUFFER_DEPTH))[0] = 0;
}
static void analysis_of_nothing(t3r_runtime *rt)
{
    rt->views = 0;
    t3r_cluster *clusters = t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS);
    for (uint32_t k = 0; k < rt->config.clusters; k++) {
        clusters[k].points = clusters[k].texture_q4 = 0;
    }
    t3r_rank_clusters(clusters, rt->config.clusters);
}
static void wild_valid_points(t3r_runtime *rt)
{
    rt->valid_points = UINT32_MAX;
}
static void wild_partner(t3r_runtime *rt)
{
    rt->stereo_partner[0] = 1;
}
static void wild_gaussian(t3r_runtime *rt)
{
    ((t3r_gaussian *)t3r_buffer_at(rt, T3R_BUFFER_SCENE))->factor_exponent = 99;
}
static void too_many_views(t3r_runtime *rt)
{
    rt->views = 3;
}

static void no_budget(t3r_runtime *rt)
{
    rt->build.gaussians = 0;
}
static void wild_head(t3r_runtime *rt)
{
    rt->build.head = T3R_HEAD_COUNT;
}

TEST(damaged_copies_are_refused)
{
    const damage damages[] = {
        no_focal_length, no_depth_unit,        wild_exponent,  wild_median,         wild_label,       wild_cluster,
        greedy_clusters, order_without_an_end, wild_gaussian,  label_without_depth, depth_of_nothing, wild_valid_points,
        wild_partner,    analysis_of_nothing,  too_many_views, no_budget,           wild_head,        other_half};
    t3r_scene scene;
    (void)analysed(&scene);
    uint64_t before = hash_of(&scene);
    t3r_runtime *rt;
    memcpy(copy, arena, arena_bytes);
    assert_int_equal(t3r_attach(&rt, copy, arena_bytes), T3R_OK);
    assert_int_equal(t3r_rebuild(rt, NULL, &scene), T3R_OK);
    assert_true(hash_of(&scene) == before);
    for (size_t d = 0; d < sizeof damages / sizeof damages[0]; d++) {
        memcpy(copy, arena, arena_bytes);
        damages[d]((t3r_runtime *)(void *)copy);
        assert_int_equal(t3r_attach(&rt, copy, arena_bytes), T3R_ERR_EPOCH);
        assert_null(rt);
    }
}

static uint32_t far_labels(const t3r_runtime *rt)
{
    const t3r_view view = t3r_view_of(rt, 0);
    uint32_t count = 0;
    for (size_t i = 0; i < SIDE * SIDE; i++) {
        count += t3r_has_depth(view.validity[i]) && t3r_label_of(&view, i) >= 256;
    }
    return count;
}

/* With labels of nine bits a copy continues, a damaged copy is refused, and a repeated analysis of the same planes,
 * which hold the previous labels, gives the same. */
TEST(many_clusters_are_checked)
{
    t3r_scene scene;
    t3r_runtime *rt = analysed_by(MANY, &scene);
    const uint64_t before = hash_of(&scene);
    const uint32_t far = far_labels(rt);
    assert_true(far > 100);
    memcpy(copy, arena, arena_bytes);
    assert_int_equal(t3r_attach(&rt, copy, arena_bytes), T3R_OK);
    assert_int_equal(t3r_rebuild(rt, NULL, &scene), T3R_OK);
    assert_true(hash_of(&scene) == before);
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    assert_true(hash_of(&scene) == before && far_labels(rt) == far);
    memcpy(copy, arena, arena_bytes);
    other_half((t3r_runtime *)(void *)copy);
    assert_int_equal(t3r_attach(&rt, copy, arena_bytes), T3R_ERR_EPOCH);
    memcpy(copy, arena, arena_bytes);
    rt = (t3r_runtime *)(void *)copy;
    const t3r_view view = t3r_view_of(rt, 0);
    view.label[0] = MANY - 256; /* 300 */
    view.validity[0] |= T3R_LABEL_HIGH;
    assert_int_equal(t3r_attach(&rt, copy, arena_bytes), T3R_ERR_EPOCH);
}

/* A configuration that leaves a choice to t3r_init(): it has the same layout, but stages rely on the choice. */
TEST(choices_that_are_still_open_are_refused)
{
    t3r_scene scene;
    for (uint32_t open = 0; open < 3; open++) {
        t3r_runtime *rt = analysed_by(0, &scene);
        assert_true(rt->config.clusters > 1 && rt->config.cluster_batches > 0);
        memcpy(copy, arena, arena_bytes);
        rt = (t3r_runtime *)(void *)copy;
        rt->analysed = 0;
        rt->config.clusters = open == 1 ? 0 : rt->config.clusters;
        rt->config.cluster_batches = open == 2 ? 0 : rt->config.cluster_batches;
        assert_int_equal(t3r_attach(&rt, copy, arena_bytes), open == 0 ? T3R_OK : T3R_ERR_EPOCH);
    }
}
