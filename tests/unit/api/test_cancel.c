/* SPDX-License-Identifier: Apache-2.0 */
/* A build that is cancelled at any of its steps reports it, leaves no scene, and the next build makes the scene that
 * it would have made before. */
#include "unit/unit.h"

#include "rgbd_frame.h"
#include "state/state.h"
#include "weights_maker.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE, BUDGET = 60, HALF_DB = 128 };

static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[1 << 20];
static uint8_t rgb[PIXELS * 3], depth[PIXELS * 2];
static t3r_gaussian expected[BUDGET];

typedef struct steps {
    uint32_t calls, cancel_at; /* 0 = never */
} steps;

static int progress(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    steps *s = user;
    assert_true(stage < T3R_STAGE_COUNT && done <= total);
    return ++s->calls == s->cancel_at;
}

static void add_two(t3r_runtime *rt)
{
    t3r_camera camera = straight_camera(SIDE);
    uint64_t seed = 3;
    for (uint32_t v = 0; v < 2; v++) {
        for (uint32_t i = 0; i < PIXELS; i++) {
            const uint32_t mm = i % SIDE < 11 ? 1500 : 2000 + i / SIDE * 3;
            for (uint32_t c = 0; c < 3; c++) {
                rgb[3 * i + c] = (uint8_t)(i % SIDE * 5 + unit_random(&seed) % 60);
            }
            depth[2 * i] = (uint8_t)mm;
            depth[2 * i + 1] = (uint8_t)(mm >> 8);
        }
        const t3r_frame frame = rgbd_frame(rgb, depth, SIDE, SIDE, MILLIMETRE_Q40);
        camera.position_q32[0] = (int64_t)v << 27;
        assert_int_equal(t3r_add_view(rt, &frame, &camera), T3R_OK);
    }
}

typedef struct plan {
    const char *name;
    t3r_head head;
    uint32_t clusters, keep_analysis;
    t3r_request request;
} plan;

static const plan plans[] = {
    {"one SuperCluster", T3R_HEAD_ANALYTIC, 1, 0, {0}},
    {"SuperClusters", T3R_HEAD_ANALYTIC, 6, 0, {0}},
    {"a network", T3R_HEAD_LEARNED, 6, 0, {0}},
    {"a bounded loss", T3R_HEAD_ANALYTIC, 6, 1, {.max_loss_q8 = HALF_DB}},
};

static void at_every_step(const plan *p, const uint8_t *weights, size_t weight_bytes)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, 2, BUDGET);
    config.head = p->head;
    config.head_column_bytes = SMALL_SHAPE_COLUMN_BYTES;
    config.clusters = p->clusters;
    config.keep_analysis = p->keep_analysis;
    config.refine = 1;
    t3r_runtime *rt;
    t3r_plan_info info;
    t3r_scene scene;
    steps s = {0};
    const t3r_hooks hooks = {.user = &s, .progress = progress};
    assert_int_equal(t3r_plan(&config, &info), T3R_OK);
    assert_true(info.bytes <= sizeof arena);
    assert_int_equal(t3r_init(&rt, arena, info.bytes, &config), T3R_OK);
    assert_int_equal(t3r_bind_head(rt, weights, weight_bytes), T3R_OK);
    assert_int_equal(t3r_set_hooks(rt, &hooks), T3R_OK);
    add_two(rt);
    assert_int_equal(t3r_reconstruct(rt, &p->request, &scene), T3R_OK);
    const uint32_t calls = s.calls, count = scene.count;
    assert_true(calls > 10 && count <= BUDGET);
    memcpy(expected, scene.gaussians, count * sizeof *expected);
    for (uint32_t at = 1; at <= calls; at++) {
        assert_int_equal(t3r_reset(rt), T3R_OK);
        add_two(rt);
        s = (steps){0, at};
        if (t3r_reconstruct(rt, &p->request, &scene) != T3R_ERR_CANCELLED || s.calls != at) {
            fail_msg("%s: not cancelled at step %u of %u", p->name, at, calls);
        }
        assert_int_equal(t3r_get_scene(rt, &scene), T3R_ERR_STATE);
    }
    s = (steps){0};
    assert_int_equal(t3r_reset(rt), T3R_OK);
    add_two(rt);
    assert_int_equal(t3r_reconstruct(rt, &p->request, &scene), T3R_OK);
    assert_int_equal(s.calls, calls);
    assert_int_equal(scene.count, count);
    assert_memory_equal(scene.gaussians, expected, count * sizeof *expected);
}

TEST(builds)
{
    size_t bytes;
    uint8_t *weights = make_weights(small_shape, small_layers, 8, 8, 1, &bytes);
    for (size_t i = 0; i < sizeof plans / sizeof plans[0]; i++) {
        at_every_step(&plans[i], weights, bytes);
    }
    free(weights);
}
