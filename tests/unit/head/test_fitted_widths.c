/* SPDX-License-Identifier: Apache-2.0 */
/* Widths that follow the number of views of a surface: equal to the formula in doubles, from counting views only, and
 * in whole builds only on request. */
#include "rgbd_frame.h"
#include "unit/rig.h"

#include "core/fixed.h"
#include "core/hash.h"
#include "head/fitted_widths.h"
#include "room/room.h"
#include "state/ablation.h"

enum { MIDDLE_X = W / 2, MIDDLE_Y = H / 2, CLUSTERS = 2, ONE_Q12 = 4 << 12 };
static const double GAIN = 1.15, POWER = 0.6;

static uint16_t texture[PIXELS];
static uint8_t label[VIEWS][PIXELS];
static t3r_cluster clusters[CLUSTERS + 1];
static t3r_budget_settings budget;
static int32_t mean_density_q10;

/* Makes all views of one plane, at the places of a pair and one between; both groups retain a quarter of their points.
 */
static rig *views_new(void)
{
    rig *s = pair_new();
    place_view(s, 2, 0.125, 0, 2);
    memset(label, 0, sizeof label);
    for (int v = 0; v < VIEWS; v++) {
        s->view[v].texture = texture;
        s->view[v].label = label[v];
    }
    clusters[0].density_q10 = clusters[1].density_q10 = mean_density_q10 = -2 * 1024;
    budget = (t3r_budget_settings){.allocate = T3R_ALLOCATE_PAPER, .clusters = CLUSTERS, .pass_over_covered = true};
    return s;
}

/* Returns the factor that the middle pixel of view 0 applies to a variance, among the first `count` views. */
static double gain(const rig *s, uint32_t count)
{
    const t3r_covering_views covering = {s->view, count, 0, mean_density_q10};
    const t3r_head_input input = {
        .map = t3r_pointmap_of(&s->view[0], 0), .settings = &budget, .clusters = clusters, .covering = &covering};
    t3r_footprint f = {.xx_q12 = ONE_Q12, .xy_q12 = -ONE_Q12 / 2, .yy_q12 = 2 * ONE_Q12};
    t3r_fit_widths(&input, MIDDLE_X, MIDDLE_Y, &f);
    assert_in_range(f.yy_q12 - 2 * f.xx_q12 + 1, 0, 2);
    assert_in_range(2 * f.xy_q12 + f.xx_q12 + 1, 0, 2);
    return (double)f.xx_q12 / ONE_Q12;
}

static void assert_gain(double got, double density_ratio)
{
    const double wanted = GAIN / pow(density_ratio, POWER);
    if (fabs(got / wanted - 1) > 1e-3) {
        fail_msg("%f instead of %f, of %f times the density", got, wanted, density_ratio);
    }
}

TEST(as_often_as_covered)
{
    rig *s = views_new();
    assert_gain(gain(s, 1), 1);
    assert_gain(gain(s, 2), 2);
    assert_gain(gain(s, 3), 3);
    free(s);
}

TEST(of_unlike_densities)
{
    rig *s = views_new();
    memset(label[1], 1, PIXELS);
    for (int32_t log_q10 = T3R_LEAST_DENSITY_Q10; log_q10 <= 0; log_q10 += 128) {
        clusters[1].density_q10 = log_q10;
        assert_gain(gain(s, 2), 1 + exp2(log_q10 / 1024.0 + 2));
    }
    /* at half the distance a pixel covers a quarter of the area, so points are four times as dense */
    clusters[1].density_q10 = clusters[0].density_q10;
    place_view(s, 1, 0, 1, 2);
    s->view[1].texture = texture;
    s->view[1].label = label[1];
    assert_gain(gain(s, 2), 1 + 4);
    s->view[1].fx_q16 = s->view[1].fy_q16 = F << 15;
    assert_gain(gain(s, 2), 1 + 1);
    free(s);
}

TEST(wider_where_points_are_few)
{
    rig *s = views_new();
    for (int32_t log_q10 = -4 * 1024; log_q10 <= 0; log_q10 += 128) {
        clusters[0].density_q10 = log_q10;
        assert_gain(gain(s, 1) * exp2((log_q10 + 2048) / 4096.0), 1);
    }
    clusters[0] = (t3r_cluster){.points = 700, .deferred = 100};
    clusters[1] = (t3r_cluster){.points = 40};
    budget.gaussians = 160;
    assert_int_equal(t3r_mean_density_q10(&budget, clusters), -2 * 1024);
    budget.gaussians = 641;
    assert_int_equal(t3r_mean_density_q10(&budget, clusters), 0);
    budget.gaussians = 0;
    assert_int_equal(t3r_mean_density_q10(&budget, clusters), 0);
    free(s);
}

/* A depth below half a step of scene units counts as one step. */
TEST(nothing_is_at_the_camera)
{
    rig *s = views_new();
    s->view[0].depth_unit_q40 = 1;
    s->depth[0][MIDDLE_Y * W + MIDDLE_X] = 1;
    assert_gain(gain(s, 1), 1);
    free(s);
}

TEST(only_of_the_same_surface)
{
    rig *s = views_new();
    const size_t there = MIDDLE_Y * W + MIDDLE_X - 8; /* pixel of view 1 where the point falls */
    const struct {
        uint8_t validity;
        uint16_t depth;
        bool counts;
    } cases[] = {
        {T3R_MEASURED, 2 * UNIT, true},
        {T3R_FILLED, 2 * UNIT, true},
        {T3R_BRIDGED, 2 * UNIT, true},
        {T3R_NO_DEPTH, 0, false},
        {T3R_MEASURED | T3R_MARK_DOUBTFUL, 2 * UNIT, false},
        {T3R_MEASURED | T3R_MARK_COVERED, 2 * UNIT, false},
        {T3R_MEASURED, 2 * UNIT * 9 / 8, true},
        {T3R_MEASURED, 2 * UNIT * 9 / 8 + 1, false},
        {T3R_MEASURED, 2 * UNIT * 8 / 9 + 1, true},
        {T3R_MEASURED, 2 * UNIT * 8 / 9, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        s->validity[1][there] = cases[i].validity;
        s->depth[1][there] = cases[i].depth;
        assert_gain(gain(s, 2), cases[i].counts ? 2 : 1);
    }
    budget.pass_over_covered = false; /* covered points are then retained like others */
    s->validity[1][there] = T3R_MEASURED | T3R_MARK_COVERED;
    s->depth[1][there] = 2 * UNIT;
    assert_gain(gain(s, 2), 2);
    s->view[1].pose.position_q20[0] = 4 << 20; /* the view looks past the point */
    assert_gain(gain(s, 2), 1);
    free(s);
}

enum { SIDE = 64, BUDGET = SIDE * SIDE / 2 };

static void reversed(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                     void *context)
{
    (void)user;
    while (count > 0) {
        count--;
        task(context, count, count % 3);
    }
}

typedef struct way {
    bool least; /* arena */
    bool parallel, unadapted;
} way;

static uint64_t scene_hash(t3r_config config, way taken)
{
    config.refine = 0;
    config.workers = taken.parallel ? 3 : 1;
    t3r_plan_info plan;
    assert_int_equal(t3r_plan(&config, &plan), T3R_OK);
    const size_t bytes = taken.least ? plan.min_bytes : plan.bytes;
    void *memory = NULL;
    assert_int_equal(posix_memalign(&memory, T3R_ARENA_ALIGN, bytes), 0);
    t3r_runtime *rt;
    assert_int_equal(t3r_init(&rt, memory, bytes, &config), T3R_OK);
    assert_int_equal(t3r_set_ablation(rt, &(t3r_ablation){.unadapted = taken.unadapted}), T3R_OK);
    if (taken.parallel) {
        assert_int_equal(t3r_set_hooks(rt, &(t3r_hooks){.parallel_for = reversed}), T3R_OK);
    }
    for (uint32_t v = 0; v < 2; v++) {
        static uint8_t rgb[SIDE * SIDE * 3], depth[SIDE * SIDE * 2];
        static uint16_t depth_mm[SIDE * SIDE];
        t3r_camera camera;
        room_camera(2 * v, SIDE, SIDE, &camera);
        room_frame(2 * v, SIDE, SIDE, 1, rgb, depth_mm);
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            depth[2 * i] = (uint8_t)depth_mm[i];
            depth[2 * i + 1] = (uint8_t)(depth_mm[i] >> 8);
        }
        const t3r_frame frame = rgbd_frame(rgb, depth, SIDE, SIDE, ROOM_DEPTH_UNIT_Q40);
        assert_int_equal(
            config.stream ? t3r_stream_keyframe(rt, &frame, &camera, NULL) : t3r_add_view(rt, &frame, &camera), T3R_OK);
    }
    t3r_scene scene;
    assert_int_equal(config.stream ? t3r_get_scene(rt, &scene) : t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    const uint64_t hash =
        t3r_hash_bytes(T3R_HASH_START, (const uint8_t *)scene.gaussians, scene.count * sizeof *scene.gaussians);
    free(memory);
    return hash;
}

/* Returns the hash with fitted widths, and checks whether it differs from the hash without them. */
static uint64_t fitted_hash(t3r_config config, way taken, bool differs)
{
    config.fit_widths = 0;
    const uint64_t plain = scene_hash(config, taken);
    config.fit_widths = 1;
    const uint64_t fitted = scene_hash(config, taken);
    assert_int_equal(plain != fitted, differs);
    return fitted;
}

TEST(builds_that_ask)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, 2, BUDGET);
    const uint64_t wanted = fitted_hash(config, (way){0}, true);
    assert_true(fitted_hash(config, (way){.least = true}, true) == wanted);
    assert_true(fitted_hash(config, (way){.parallel = true}, true) == wanted);
    (void)fitted_hash(config, (way){.unadapted = true}, false);
    config.stream = 1;
    (void)fitted_hash(config, (way){0}, false);
    config = t3r_default_config(SIDE, SIDE, 2, BUDGET);
    config.fit_widths = 2;
    assert_int_equal(t3r_plan(&config, &(t3r_plan_info){0}), T3R_ERR_CONFIG);
    assert_string_equal(t3r_config_error(&config), "fit_widths must be 0 or 1");
}
