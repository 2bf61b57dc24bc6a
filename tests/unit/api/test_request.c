/* SPDX-License-Identifier: Apache-2.0 */
/* Requests of builds: every part of a request, alone and with the others, gives the scene of a configuration with
 * these values, applies only to its call, and changes nothing when it is refused. */
#include "rgbd_frame.h"
#include "trim3r_heads.h"
#include "unit/unit.h"

#include "state/ablation.h"
#include "state/state.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE, MOST = PIXELS, BUDGET = 300, FEWER = 120, HALF_DB = 128 };

static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[1 << 21], before[sizeof arena];
static size_t arena_bytes;
static uint8_t rgb[PIXELS * 3], depth[PIXELS * 2];
static uint16_t importance[PIXELS];
static const uint16_t *const planes[] = {importance};

static int make_view(void **state)
{
    (void)state;
    uint64_t seed = 7;
    for (uint32_t i = 0; i < PIXELS; i++) {
        uint32_t steps = i % SIDE < 13 ? 1500 : 2000 + i / SIDE * 3;
        for (uint32_t c = 0; c < 3; c++) {
            rgb[3 * i + c] = (uint8_t)(i % SIDE * 5 + unit_random(&seed) % (i / SIDE < 12 ? 90 : 6));
        }
        depth[2 * i] = (uint8_t)steps;
        depth[2 * i + 1] = (uint8_t)(steps >> 8);
        importance[i] = (uint16_t)(unit_random(&seed) % 5000);
    }
    return 0;
}

static t3r_config good_config(void)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, 1, MOST);
    config.gaussians = BUDGET;
    config.clusters = 12;
    config.cluster_batches = 24;
    config.refine = 1;
    config.refine_stride = 1;
    config.keep_analysis = 1;
    return config;
}

static t3r_runtime *with_view(const t3r_config *config)
{
    t3r_plan_info plan;
    t3r_runtime *rt;
    assert_int_equal(t3r_plan(config, &plan), T3R_OK);
    assert_true(plan.bytes <= sizeof arena);
    arena_bytes = plan.bytes;
    assert_int_equal(t3r_init(&rt, arena, arena_bytes, config), T3R_OK);
    t3r_frame frame = rgbd_frame(rgb, depth, SIDE, SIDE, MILLIMETRE_Q40);
    t3r_camera camera = straight_camera(SIDE);
    assert_int_equal(t3r_bind_head(rt, t3r_head_tiny, t3r_head_tiny_bytes), T3R_OK);
    assert_int_equal(t3r_add_view(rt, &frame, &camera), T3R_OK);
    return rt;
}

typedef struct kept_scene {
    uint32_t count;
    t3r_gaussian gaussians[MOST];
} kept_scene;

static void keep(kept_scene *to, const t3r_scene *scene)
{
    to->count = scene->count;
    memcpy(to->gaussians, scene->gaussians, scene->count * sizeof *scene->gaussians);
}

static void expect_same(const kept_scene *expected, const t3r_scene *scene)
{
    assert_int_equal(scene->count, expected->count);
    assert_memory_equal(scene->gaussians, expected->gaussians, scene->count * sizeof *scene->gaussians);
}

/* Makes the scene of a configuration with the request's values, and the parts that only a request has. */
static void expected_of(const t3r_request *request, kept_scene *expected)
{
    t3r_config config = good_config();
    config.gaussians = request->gaussians != 0 ? request->gaussians : config.gaussians;
    config.allocate = request->allocate != 0 ? request->allocate : config.allocate;
    config.allocate = request->importance != NULL ? T3R_ALLOCATE_GIVEN : config.allocate;
    config.head = request->head != 0 ? request->head : config.head;
    t3r_request rest = {.max_loss_q8 = request->max_loss_q8,
                        .importance = request->importance,
                        .importance_stride_bytes = request->importance_stride_bytes};
    t3r_runtime *rt = with_view(&config);
    t3r_scene scene;
    assert_int_equal(t3r_reconstruct(rt, &rest, &scene), T3R_OK);
    keep(expected, &scene);
}

TEST(every_combination)
{
    static kept_scene plain, expected;
    const t3r_config config = good_config();
    expected_of(&(t3r_request){0}, &plain);
    assert_int_equal(plain.count, BUDGET);
    for (uint32_t parts = 0; parts < 64; parts++) {
        t3r_request request = {
            .gaussians = parts & 1 ? FEWER : 0,
            .max_loss_q8 = parts & 2 ? HALF_DB : 0,
            .allocate = parts & 4 ? T3R_ALLOCATE_UNIFORM : T3R_ALLOCATE_CONFIGURED,
            .head = parts & 8 ? T3R_HEAD_LEARNED : T3R_HEAD_CONFIGURED,
            .importance = parts & 16 ? planes : NULL,
            .importance_stride_bytes = parts & 32 || parts & 16 ? SIDE * 2 : 0, /* has no meaning without planes */
        };
        t3r_scene scene;
        t3r_runtime *rt;
        if (request.importance != NULL && request.allocate != 0) {
            rt = with_view(&config);
            assert_int_equal(t3r_reconstruct(rt, &request, &scene), T3R_ERR_ARGUMENT);
            request.allocate = T3R_ALLOCATE_GIVEN; /* redundant */
        }
        expected_of(&request, &expected);
        assert_true(expected.count <= (request.gaussians != 0 ? request.gaussians : BUDGET));
        rt = with_view(&config);
        assert_int_equal(t3r_reconstruct(rt, &request, &scene), T3R_OK);
        expect_same(&expected, &scene);
        assert_int_equal(t3r_rebuild(rt, NULL, &scene), T3R_OK); /* no trace of the request is left */
        expect_same(&plain, &scene);
        assert_memory_equal(&rt->config, &config, sizeof config);
        assert_int_equal(t3r_rebuild(rt, &request, &scene), T3R_OK);
        expect_same(&expected, &scene);
        assert_int_equal(t3r_rebuild(rt, &(t3r_request){0}, &scene), T3R_OK);
        expect_same(&plain, &scene);
    }
}

/* Each allocation and head differs from the configured one, so that none is confused with another. */
TEST(every_allocation_and_head)
{
    static kept_scene expected;
    const t3r_config config = good_config();
    for (int allocation = T3R_ALLOCATE_CONFIGURED + 1; allocation < T3R_ALLOCATE_GIVEN; allocation++) {
        for (int head = T3R_HEAD_CONFIGURED + 1; head < T3R_HEAD_LEARNED; head++) {
            const t3r_request request = {.allocate = (t3r_allocation)allocation, .head = (t3r_head)head};
            expected_of(&request, &expected);
            t3r_runtime *rt = with_view(&config);
            t3r_scene scene;
            assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
            const bool same = scene.count == expected.count &&
                              memcmp(scene.gaussians, expected.gaussians, scene.count * sizeof *scene.gaussians) == 0;
            assert_int_equal(same, allocation == T3R_ALLOCATE_DENSITY && head == T3R_HEAD_ANALYTIC);
            assert_int_equal(t3r_rebuild(rt, &request, &scene), T3R_OK);
            expect_same(&expected, &scene);
        }
    }
}

TEST(a_refused_request_leaves_all_as_it_was)
{
    const t3r_request refused[] = {
        {.gaussians = MOST + 1},
        {.max_loss_q8 = T3R_MAX_LOSS_Q8 + 1},
        {.allocate = T3R_ALLOCATE_COUNT},
        {.allocate = T3R_ALLOCATE_GIVEN},
        {.head = T3R_HEAD_COUNT},
        {.head = T3R_HEAD_LEARNED},
        {.importance = planes, .importance_stride_bytes = SIDE * 2 - 2},
        {.importance = planes, .importance_stride_bytes = SIDE * 2, .max_loss_q8 = T3R_MAX_LOSS_Q8 + 1},
        {.importance = planes, .importance_stride_bytes = SIDE * 2, .allocate = T3R_ALLOCATE_DENSITY},
    };
    const t3r_config config = good_config();
    t3r_runtime *rt = with_view(&config);
    t3r_scene scene;
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    assert_int_equal(t3r_bind_head(rt, NULL, 0), T3R_OK);
    memcpy(before, arena, arena_bytes);
    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; i++) {
        assert_true(t3r_reconstruct(rt, &refused[i], &scene) != T3R_OK);
        assert_true(t3r_rebuild(rt, &refused[i], &scene) != T3R_OK);
        assert_memory_equal(arena, before, arena_bytes);
    }
    assert_int_equal(t3r_rebuild(rt, NULL, &scene), T3R_OK);
    assert_memory_equal(scene.gaussians, before + ((uint8_t *)(uintptr_t)scene.gaussians - arena),
                        scene.count * sizeof *scene.gaussians);
}

TEST(a_bounded_loss_needs_its_settings)
{
    const t3r_request requests[] = {
        {.max_loss_q8 = HALF_DB},
        {.max_loss_q8 = HALF_DB, .importance = planes, .importance_stride_bytes = SIDE * 2},
    };
    for (size_t i = 0; i < 2; i++) {
        for (int missing = 0; missing < 2; missing++) {
            t3r_config config = good_config();
            *(missing ? &config.keep_analysis : &config.refine) = 0;
            t3r_runtime *rt = with_view(&config);
            t3r_scene scene;
            memcpy(before, arena, arena_bytes);
            assert_int_equal(t3r_reconstruct(rt, &requests[i], &scene), T3R_ERR_STATE);
            assert_memory_equal(arena, before, arena_bytes);
        }
    }
}

/* Switched on, each changes the scene; it stays after a reset; switched off, it leaves no trace. */
TEST(ablations)
{
    static kept_scene plain;
    const t3r_config config = good_config();
    const t3r_ablation switches[] = {{.shuffle = 1}, {.unadapted = 1}};
    expected_of(&(t3r_request){0}, &plain);
    assert_int_equal(t3r_set_ablation(NULL, NULL), T3R_ERR_ARGUMENT);
    for (size_t i = 0; i < 2; i++) {
        t3r_runtime *rt = with_view(&config);
        t3r_scene scene;
        assert_int_equal(t3r_set_ablation(rt, &switches[i]), T3R_OK);
        assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
        assert_int_equal(scene.count, plain.count);
        assert_memory_not_equal(scene.gaussians, plain.gaussians, scene.count * sizeof *scene.gaussians);
        assert_int_equal(t3r_reset(rt), T3R_OK);
        assert_memory_equal(&rt->ablation, &switches[i], sizeof switches[i]);
        rt = with_view(&config);
        assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
        expect_same(&plain, &scene);
    }
}

ALL_TESTS_WITH(make_view, NULL)
