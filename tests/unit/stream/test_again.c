/* SPDX-License-Identifier: Apache-2.0 */
/* Keyframes shown again: they correct colours by the part of their round, add nothing and remove nothing; a frame that
 * cannot be shown changes nothing. */
#include "unit/unit.h"

#include "rgbd_frame.h"
#include "state/state.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE, BUDGET = 300 };

static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[1 << 20];
static uint8_t rgb[PIXELS * 3], depth[PIXELS * 2];

static t3r_runtime *begin(uint32_t gate)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, 1, BUDGET);
    t3r_plan_info plan;
    t3r_runtime *rt;
    config.stream = 1;
    config.views = 2;
    config.refine = 2;
    config.gate = gate;
    config.exposure = config.fill_radius = config.bridge_radius = 0;
    assert_int_equal(t3r_plan(&config, &plan), T3R_OK);
    assert_true(plan.bytes <= sizeof arena);
    assert_int_equal(t3r_init(&rt, arena, plan.bytes, &config), T3R_OK);
    return rt;
}

/* Makes a frame of a grey wall so many millimetres in front of the camera. */
static t3r_frame wall(uint8_t level, uint32_t mm)
{
    memset(rgb, level, sizeof rgb);
    for (uint32_t i = 0; i < PIXELS; i++) {
        depth[2 * i] = (uint8_t)mm;
        depth[2 * i + 1] = (uint8_t)(mm >> 8);
    }
    return rgbd_frame(rgb, depth, SIDE, SIDE, MILLIMETRE_Q40);
}

static void take(t3r_runtime *rt, uint8_t level)
{
    const t3r_frame frame = wall(level, 2000);
    const t3r_camera camera = straight_camera(SIDE);
    assert_int_equal(t3r_stream_keyframe(rt, &frame, &camera, NULL), T3R_OK);
}

static void show(t3r_runtime *rt, uint8_t level, uint32_t mm, uint32_t round)
{
    const t3r_frame frame = wall(level, mm);
    const t3r_camera camera = straight_camera(SIDE);
    assert_int_equal(t3r_stream_again(rt, &frame, &camera, round), T3R_OK);
}

static t3r_scene scene_of(const t3r_runtime *rt)
{
    t3r_scene scene;
    assert_int_equal(t3r_get_scene(rt, &scene), T3R_OK);
    return scene;
}

static double mean_level(const t3r_runtime *rt)
{
    const t3r_scene scene = scene_of(rt);
    double sum = 0;
    for (uint32_t i = 0; i < scene.count; i++) {
        sum += scene.gaussians[i].colour_q7[0] / 128.0;
    }
    return sum / scene.count;
}

TEST(corrects_by_the_part_of_the_round)
{
    double before = 255;
    for (uint32_t round = 1; round <= 64; round *= 4) {
        t3r_runtime *rt = begin(0);
        for (int i = 0; i < 4; i++) {
            take(rt, 130);
        }
        const double last = mean_level(rt);
        show(rt, 90, 2000, round);
        const double moved = last - mean_level(rt);
        assert_true(moved < before * 0.6 && (round > 16 || moved > 0.5));
        before = moved;
    }
}

TEST(adds_nothing_and_removes_nothing)
{
    t3r_runtime *rt = begin(0);
    take(rt, 130);
    const uint32_t count = scene_of(rt).count, keyframes = rt->keyframes;
    show(rt, 130, 3000, 1); /* sees through the wall */
    show(rt, 130, 1000, 1); /* hides it */
    show(rt, 130, 2000, 2);
    assert_int_equal(scene_of(rt).count, count);
    assert_int_equal(rt->keyframes, keyframes);
    take(rt, 130);
    assert_int_equal(rt->keyframes, keyframes + 1);
    assert_int_equal(scene_of(rt).count, count); /* the map shows the wall */
}

TEST(a_frame_that_cannot_be_shown_changes_nothing)
{
    for (uint32_t gate = 0; gate <= 1; gate++) {
        t3r_runtime *rt = begin(gate);
        t3r_frame frame = wall(130, 2000);
        t3r_camera camera = straight_camera(SIDE);
        assert_int_equal(t3r_stream_again(rt, &frame, &camera, 1), T3R_ERR_STATE);
        take(rt, 130);
        static uint8_t copy[sizeof arena];
        memcpy(copy, arena, sizeof arena);
        assert_int_equal(t3r_stream_again(rt, &frame, &camera, 0), T3R_ERR_ARGUMENT);
        assert_int_equal(t3r_stream_again(rt, &frame, &camera, T3R_MAX_ROUND + 1), T3R_ERR_ARGUMENT);
        camera.position_q32[0] = INT64_C(1) << 50;
        assert_int_equal(t3r_stream_again(rt, &frame, &camera, 1), T3R_ERR_CAMERA);
        camera.position_q32[0] = 0;
        frame.depth = NULL;
        assert_int_equal(t3r_stream_again(rt, &frame, &camera, 1), T3R_ERR_NO_DEPTH);
        assert_memory_equal(copy, arena, sizeof arena);
        const t3r_scene before = scene_of(rt);
        frame = wall(130, 0);
        assert_int_equal(t3r_stream_again(rt, &frame, &camera, 1), T3R_ERR_NO_DEPTH);
        const t3r_scene after = scene_of(rt);
        assert_int_equal(after.count, before.count);
        const t3r_runtime *was = (const void *)copy;
        assert_true(rt->views == was->views && rt->next_slot == was->next_slot && rt->keyframes == was->keyframes);
        assert_memory_equal(&rt->camera, &was->camera, sizeof rt->camera);
    }
}
