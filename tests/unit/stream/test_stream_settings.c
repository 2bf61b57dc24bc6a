/* SPDX-License-Identifier: Apache-2.0 */
/* Streams with each setting at its other end: the map stays within its budget, and the same calls make the same map. */
#include "unit/unit.h"

#include <stdbool.h>

#include "rgbd_frame.h"
#include "state/state.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE, BUDGET = 80, KEYFRAMES = 4 };

static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[1 << 20];
static uint8_t rgb[PIXELS * 3], depth[PIXELS * 2];

/* Goes to and fro along both axes, so that Gaussians leave the picture on each side. */
static t3r_camera camera_at(uint32_t step)
{
    t3r_camera camera = straight_camera(SIDE);
    camera.position_q32[0] = (int64_t)(step ^ step >> 1) << 29;
    camera.position_q32[1] = (int64_t)(step % 3) << 29;
    return camera;
}

static t3r_frame frame_at(uint32_t step)
{
    for (uint32_t i = 0; i < PIXELS; i++) {
        const uint32_t mm = i % 37 == 0 ? 0 : i / SIDE < 9 ? 1600 : 2000;
        for (uint32_t c = 0; c < 3; c++) {
            rgb[3 * i + c] = (uint8_t)((i % SIDE + 2 * step) * 37 % 101 * 2 + i / SIDE * c);
        }
        depth[2 * i] = (uint8_t)mm;
        depth[2 * i + 1] = (uint8_t)(mm >> 8);
    }
    return rgbd_frame(rgb, depth, SIDE, SIDE, MILLIMETRE_Q40);
}

static uint32_t run(const t3r_config *config, t3r_gaussian map[BUDGET])
{
    t3r_runtime *rt;
    t3r_plan_info plan;
    t3r_scene scene;
    assert_int_equal(t3r_plan(config, &plan), T3R_OK);
    assert_true(plan.bytes <= sizeof arena);
    assert_int_equal(t3r_init(&rt, arena, plan.bytes, config), T3R_OK);
    for (uint32_t step = 0; step < KEYFRAMES; step++) {
        const t3r_camera camera = camera_at(step);
        const t3r_frame frame = frame_at(step);
        t3r_stream_report report;
        assert_int_equal(t3r_stream_keyframe(rt, &frame, &camera, &report), T3R_OK);
        assert_true(report.gaussians > 0 && report.gaussians <= BUDGET);
        assert_int_equal(report.keyframes, step + 1);
    }
    t3r_camera wrong = camera_at(0);
    uint32_t overlap_q8;
    wrong.fx_q16 = 0;
    assert_int_equal(t3r_stream_overlap(rt, &wrong, SIDE, SIDE, &overlap_q8), T3R_ERR_CAMERA);
    assert_int_equal(t3r_get_scene(rt, &scene), T3R_OK);
    memcpy(map, scene.gaussians, scene.count * sizeof *map);
    return scene.count;
}

TEST(each_setting)
{
    static t3r_gaussian first[BUDGET], again[BUDGET], usual[BUDGET];
    t3r_config base = t3r_default_config(SIDE, SIDE, 2, BUDGET);
    base.stream = 1;
    base.refine = 1;
    base.gate = 0; /* the pictures have little to do with each other */
    const uint32_t usually = run(&base, usual);
    t3r_config other[16];
    size_t n = 0;
#define OTHER(field, value) (other[n] = base, other[n].field = (value), n++)
    OTHER(bridge_radius, 0);
    OTHER(flying, 0);
    OTHER(exposure, 0);
    OTHER(refine, 0);
    OTHER(views, 1);
    OTHER(warm, 1);
    OTHER(structural, 1);
    OTHER(align, 0);
    OTHER(remember, 1);
    OTHER(refine_stride, 1);
    OTHER(refine_stride, 2);
    OTHER(clusters, 5);
    OTHER(allocate, T3R_ALLOCATE_PAPER);
    OTHER(allocate, T3R_ALLOCATE_PIXEL);
    OTHER(allocate, T3R_ALLOCATE_UNIFORM);
    OTHER(allocate, T3R_ALLOCATE_RANDOM);
#undef OTHER
    for (size_t i = 0; i < n; i++) {
        const uint32_t count = run(&other[i], first);
        assert_int_equal(run(&other[i], again), count);
        assert_memory_equal(first, again, count * sizeof *first);
        const bool clustered = other[i].allocate == T3R_ALLOCATE_PAPER || other[i].allocate == T3R_ALLOCATE_PIXEL;
        /* a stream has one SuperCluster, so these are one allocation, and refines without the structural loss, with
         * the given poses */
        if (clustered || other[i].clusters != 0 || other[i].structural != 0 || other[i].align == 0) {
            assert_int_equal(count, usually);
            assert_memory_equal(first, usual, count * sizeof *first);
        }
    }
}

/* With fitted passes a keyframe takes a stream's maximum; otherwise the requested number. */
TEST(fitted_passes_have_a_bound)
{
    static t3r_gaussian fitted[BUDGET], bound[BUDGET], more[BUDGET];
    t3r_config config = t3r_default_config(SIDE, SIDE, 2, BUDGET);
    config.stream = 1;
    config.gate = 0;
    config.fit_passes = 1;
    config.refine = 2 * T3R_STREAM_REFINE;
    const uint32_t count = run(&config, fitted);
    config.fit_passes = 0;
    assert_int_equal(run(&config, more), count);
    config.refine = T3R_STREAM_REFINE;
    assert_int_equal(run(&config, bound), count);
    assert_memory_equal(fitted, bound, count * sizeof *fitted);
    assert_memory_not_equal(fitted, more, count * sizeof *fitted);
}

/* A damaged arena may hold another head than the configuration's, with unbound weights. */
TEST(a_stream_builds_as_it_is_configured)
{
    const t3r_camera camera = camera_at(0);
    const t3r_frame frame = frame_at(0);
    t3r_config config = t3r_default_config(SIDE, SIDE, 2, BUDGET);
    config.stream = 1;
    t3r_runtime *rt;
    t3r_plan_info plan;
    assert_int_equal(t3r_plan(&config, &plan), T3R_OK);
    assert_int_equal(t3r_init(&rt, arena, plan.bytes, &config), T3R_OK);
    rt->build.head = T3R_HEAD_LEARNED;
    assert_int_equal(t3r_attach(&rt, arena, plan.bytes), T3R_OK);
    assert_int_equal(t3r_stream_keyframe(rt, &frame, &camera, NULL), T3R_OK);
    assert_int_equal(rt->build.head, T3R_HEAD_ANALYTIC);
}
