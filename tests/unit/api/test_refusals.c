/* SPDX-License-Identifier: Apache-2.0 */
/* Calls that are refused immediately, and copies of an arena with impossible contents: each limit from both sides. */
#include "unit/unit.h"

#include "core/scene_frame.h"
#include "host/cpu.h"
#include "image/image.h"
#include "rgbd_frame.h"
#include "state/state.h"
#include "superclusters/superclusters.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE, BUDGET = 60 };

static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[1 << 20], copy[sizeof arena];
static size_t arena_bytes;
static uint8_t rgb[PIXELS * 3], depth[PIXELS * 2];

static t3r_frame some_frame(void)
{
    uint64_t seed = 3;
    for (uint32_t i = 0; i < PIXELS; i++) {
        const uint32_t steps = 1500 + i % SIDE * 9;
        for (uint32_t c = 0; c < 3; c++) {
            rgb[3 * i + c] = (uint8_t)unit_random(&seed);
        }
        depth[2 * i] = (uint8_t)steps;
        depth[2 * i + 1] = (uint8_t)(steps >> 8);
    }
    return rgbd_frame(rgb, depth, SIDE, SIDE, MILLIMETRE_Q40);
}

static t3r_camera some_camera(void)
{
    return straight_camera(SIDE);
}

static t3r_config some_config(void)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, 2, BUDGET);
    config.clusters = 6;
    config.refine = 1;
    return config;
}

static t3r_runtime *opened(const t3r_config *config)
{
    t3r_runtime *rt;
    t3r_plan_info plan;
    assert_int_equal(t3r_plan(config, &plan), T3R_OK);
    assert_true(plan.bytes <= sizeof arena);
    arena_bytes = plan.bytes;
    assert_int_equal(t3r_init(&rt, arena, arena_bytes, config), T3R_OK);
    return rt;
}

static void add(t3r_runtime *rt)
{
    const t3r_frame frame = some_frame();
    const t3r_camera camera = some_camera();
    assert_int_equal(t3r_add_view(rt, &frame, &camera), T3R_OK);
}

/* The interface description of a program compiled with another header. */
TEST(another_interface)
{
    const uint64_t other = t3r_header_interface() + 1;
    t3r_config config = some_config();
    t3r_plan_info plan;
    t3r_runtime *rt = opened(&config);
    size_t least, most;
    assert_int_equal(t3r_plan_as(other, &config, &plan), T3R_ERR_INTERFACE);
    assert_int_equal(t3r_plan_bytes_as(other, &config, &least, &most), T3R_ERR_INTERFACE);
    assert_int_equal(t3r_plan_within_as(other, SIZE_MAX, &config), T3R_ERR_INTERFACE);
    assert_int_equal(t3r_attach_as(other, &rt, arena, arena_bytes), T3R_ERR_INTERFACE);
    assert_null(rt);
    assert_int_equal(t3r_init_as(other, &rt, arena, arena_bytes, &config), T3R_ERR_INTERFACE);
    assert_null(rt);
    assert_int_equal(t3r_default_config_as(other, &config, sizeof config, SIDE, SIDE, 1, 1), T3R_ERR_INTERFACE);
    const t3r_config nothing = {0};
    assert_memory_equal(&config, &nothing, sizeof config);
    config = some_config();
    assert_int_equal(t3r_default_config_as(t3r_header_interface(), &config, sizeof config - 4, SIDE, SIDE, 1, 1),
                     T3R_ERR_INTERFACE);
    assert_memory_equal(&config, &nothing, sizeof config - 4);
    assert_int_equal(t3r_default_config_as(t3r_header_interface(), NULL, sizeof config, SIDE, SIDE, 1, 1),
                     T3R_ERR_ARGUMENT);
}

/* Each feature is taken if the processor has it, and refused otherwise. */
TEST(features_of_other_processors)
{
    const t3r_config config = some_config();
    t3r_runtime *rt = opened(&config);
    const uint32_t there = t3r_cpu_features();
    for (uint32_t bit = 0; bit < 32; bit++) {
        const uint32_t feature = UINT32_C(1) << bit;
        const t3r_kernels before = rt->kernels;
#if defined(__aarch64__)
        const bool is_taken = (feature & (T3R_CPU_NEON | T3R_CPU_DOTPROD)) != 0;
#else
        const bool is_taken = (feature & there) != 0;
#endif
        assert_int_equal(t3r_set_cpu(rt, feature), is_taken ? T3R_OK : T3R_ERR_ARGUMENT);
        assert_int_equal(t3r_get_cpu(rt), is_taken ? feature : before.features);
        if (!is_taken) {
            assert_memory_equal(&rt->kernels, &before, sizeof before);
            assert_int_equal(t3r_set_cpu(rt, there | feature), T3R_ERR_ARGUMENT);
        }
    }
    assert_int_equal(t3r_set_cpu(rt, there), T3R_OK);
    assert_int_equal(t3r_set_cpu(rt, UINT32_MAX), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_get_cpu(rt), there);
    assert_int_equal(t3r_set_cpu(rt, 0), T3R_OK);
    assert_int_equal(t3r_get_cpu(rt), 0);
}

TEST(missing_pointers)
{
    t3r_config config = some_config();
    size_t bytes;
    static const int16_t coefficients[3];
    static const int32_t ahead[3] = {0, 0, 1};
    uint16_t colour[3];
    assert_int_equal(t3r_harmonics_colour(NULL, 0, ahead, colour), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_harmonics_colour(coefficients, 0, NULL, colour), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_harmonics_colour(coefficients, 0, ahead, NULL), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_plan_bytes(NULL, &bytes, &bytes), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_plan_bytes(&config, NULL, &bytes), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_plan_bytes(&config, &bytes, NULL), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_set_cpu(NULL, 0), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_get_cpu(NULL), 0);
    assert_null(t3r_get_config(NULL));
    assert_int_equal(t3r_head_crc(NULL), 0);
    assert_int_equal(t3r_cluster_count(NULL), 0);
    assert_int_equal(t3r_cluster_batch_count(NULL), 0);
    assert_int_equal(t3r_refinement_passes(NULL), 0);
    assert_int_equal(t3r_render_passes(NULL), 0);
    t3r_runtime *rt = opened(&config);
    assert_int_equal(t3r_get_config(rt)->gaussians, config.gaussians);
    t3r_camera undistorted;
    const t3r_frame frame = some_frame();
    const t3r_camera camera = some_camera();
    assert_int_equal(t3r_develop(rt, &frame, &camera, rgb, NULL, NULL), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_set_ablation(rt, NULL), T3R_OK);
    add(rt);
    assert_int_equal(t3r_develop(rt, &frame, &camera, rgb, NULL, &undistorted), T3R_ERR_STATE);
    const t3r_scene_frame plain = {{0}, 0};
    assert_int_equal(t3r_scene_begin(rt, &plain), T3R_OK); /* no views, but a scene */
    assert_int_equal(t3r_develop(rt, &frame, &camera, rgb, NULL, &undistorted), T3R_ERR_STATE);
    assert_int_equal(t3r_add_rows(rt, &frame, &camera, 0, 1, 0, 1), T3R_ERR_STATE);
    config.views = 0;
    rt = opened(&config);
    assert_int_equal(t3r_develop(rt, &frame, &camera, rgb, NULL, &undistorted), T3R_ERR_STATE);
    config = some_config();
    config.stream = 1;
    rt = opened(&config);
    uint32_t overlap_q8;
    assert_int_equal(t3r_stream_overlap(rt, NULL, SIDE, SIDE, &overlap_q8), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_stream_overlap(rt, &camera, SIDE, SIDE, NULL), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_stream_overlap(rt, &camera, T3R_MAX_SIDE + 1, SIDE, &overlap_q8), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_stream_overlap(rt, &camera, SIDE, 1, &overlap_q8), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_stream_overlap(rt, &camera, SIDE, T3R_MAX_SIDE + 1, &overlap_q8), T3R_ERR_ARGUMENT);
    config.allocate = T3R_ALLOCATE_GIVEN;
    rt = opened(&config);
    assert_int_equal(t3r_stream_keyframe(rt, &frame, &camera, NULL), T3R_ERR_STATE);
    config = some_config();
    rt = opened(&config);
    assert_int_equal(t3r_stream_overlap(rt, &camera, SIDE, SIDE, &overlap_q8), T3R_ERR_STATE);
}

/* A camera for a picture of another size is refused by each call that takes one, and changes nothing. */
TEST(cameras_of_another_size)
{
    t3r_config config = some_config();
    const t3r_frame frame = some_frame();
    const t3r_target target = {.width = SIDE, .height = SIDE, .rgb = rgb, .rgb_stride_bytes = 3 * SIDE};
    const uint32_t sizes[][2] = {{SIDE, SIDE + 1}, {SIDE - 1, SIDE}, {2 * SIDE, 2 * SIDE}, {0, SIDE}, {SIDE, 0}};
    t3r_camera camera = some_camera(), found;
    uint32_t overlap_q8;
    t3r_scene scene;
    for (size_t i = 0; i <= sizeof sizes / sizeof sizes[0]; i++) {
        const bool fits = i == sizeof sizes / sizeof sizes[0];
        const t3r_status status = fits ? T3R_OK : T3R_ERR_CAMERA;
        camera.width = fits ? SIDE : sizes[i][0];
        camera.height = fits ? SIDE : sizes[i][1];
        config.stream = 0;
        t3r_runtime *rt = opened(&config);
        assert_int_equal(t3r_develop(rt, &frame, &camera, rgb, NULL, &found), status);
        assert_int_equal(t3r_add_rows(rt, &frame, &camera, 0, SIDE, 0, SIDE), status);
        assert_int_equal(t3r_add_view(rt, &frame, &camera), status);
        assert_int_equal(t3r_view_camera(rt, 0, &found), fits ? T3R_OK : T3R_ERR_ARGUMENT);
        if (fits) {
            assert_true(found.width == SIDE && found.height == SIDE);
        } else {
            add(rt);
        }
        assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
        assert_int_equal(t3r_render(rt, &camera, &target), status);
        config.stream = 1;
        rt = opened(&config);
        assert_int_equal(t3r_stream_keyframe(rt, &frame, &camera, NULL), status);
        if (!fits) {
            const t3r_camera any = some_camera();
            assert_int_equal(t3r_stream_keyframe(rt, &frame, &any, NULL), T3R_OK);
        }
        assert_int_equal(t3r_stream_overlap(rt, &camera, SIDE, SIDE, &overlap_q8), status);
    }
}

TEST(memory_that_is_no_arena)
{
    const t3r_config config = some_config();
    t3r_runtime *rt = opened(&config), *found;
    assert_int_equal(t3r_init(&found, arena + 1, arena_bytes, &config), T3R_ERR_ARENA);
    assert_null(found);
    assert_int_equal(t3r_attach(&found, arena + 1, arena_bytes), T3R_ERR_ARENA);
    assert_int_equal(t3r_attach(&found, arena, T3R_HEADER_BYTES - 1), T3R_ERR_ARENA);
    assert_int_equal(t3r_attach(&found, arena, arena_bytes - 1), T3R_ERR_EPOCH);
    memcpy(copy, arena, arena_bytes);
    t3r_runtime *const damaged = (t3r_runtime *)(void *)copy;
#define DAMAGED(change)                                                                                                \
    do {                                                                                                               \
        memcpy(copy, arena, arena_bytes);                                                                              \
        change;                                                                                                        \
        assert_int_equal(t3r_attach(&found, copy, arena_bytes), T3R_ERR_EPOCH);                                        \
        assert_null(found);                                                                                            \
    } while (0)
    DAMAGED(damaged->magic++);
    DAMAGED(damaged->bits_epoch++);
    DAMAGED(damaged->arena_bytes++);
    DAMAGED(damaged->layout_hash++);
    DAMAGED(damaged->config.width = 0);
    DAMAGED(damaged->config.max_gaussians *= 100); /* valid, but larger than the arena */
    assert_int_equal(t3r_attach(&rt, arena, arena_bytes), T3R_OK);
}

/* Damages numbers of the state, one at a time, in an arena that holds an analysis and a scene. */
TEST(states_that_cannot_be)
{
    t3r_config config = some_config();
    config.keep_analysis = 1;
    t3r_runtime *rt = opened(&config), *found;
    t3r_scene scene;
    add(rt);
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    t3r_runtime *const damaged = (t3r_runtime *)(void *)copy;
    memcpy(copy, arena, arena_bytes);
    assert_int_equal(t3r_attach(&found, copy, arena_bytes), T3R_OK);
    DAMAGED(damaged->gaussians = config.max_gaussians + 1);
    DAMAGED(damaged->analysed = 2);
    DAMAGED(damaged->has_scene = 2);
    DAMAGED(damaged->frame.exponent = T3R_EXPONENT_LEAST - 1);
    DAMAGED(damaged->frame.origin_q32[0] = INT64_C(1) << 62);
    DAMAGED(damaged->frame.origin_q32[2] = -(INT64_C(1) << 62));
    DAMAGED(damaged->frame.origin_q32[1] = (INT64_C(1) << 62) - 1); /* the camera is too far from it */
    DAMAGED(damaged->build.gaussians = config.max_gaussians + 1);
    DAMAGED(damaged->build.allocate = T3R_ALLOCATE_CONFIGURED);
    DAMAGED(damaged->build.allocate = T3R_ALLOCATE_COUNT);
    DAMAGED(damaged->build.refine = config.refine + 1);
    DAMAGED(damaged->build.head = T3R_HEAD_CONFIGURED);
    DAMAGED(damaged->next_slot = 1);
    DAMAGED(damaged->reuse.views = 1);
    DAMAGED(damaged->reuse.centres = 1);
    DAMAGED(damaged->stereo_pair[0] = T3R_PAIR_COUNT);
    DAMAGED(damaged->stereo_partner[0] = 2);
    DAMAGED(memset(damaged->camera[0].rotation_q30, 0, sizeof damaged->camera[0].rotation_q30));
    DAMAGED(memset(damaged->given[0].rotation_q30, 0, sizeof damaged->given[0].rotation_q30));
    DAMAGED(damaged->depth_unit_q40[0] = T3R_MAX_DEPTH_UNIT_Q40 + 1);
    DAMAGED(damaged->median_depth_q20 = 2 << 20);
    DAMAGED(((t3r_cluster *)t3r_buffer_at(damaged, T3R_BUFFER_CLUSTERS))->texture_q4 = UINT16_MAX + 1u);
    DAMAGED(((t3r_gaussian *)t3r_buffer_at(damaged, T3R_BUFFER_SCENE))->position_q20[0] = INT32_MIN);
    DAMAGED(((t3r_gaussian *)t3r_buffer_at(damaged, T3R_BUFFER_SCENE))->position_q20[2] = INT32_MAX);
}

TEST(warm_states_that_cannot_be)
{
    t3r_config config = some_config();
    config.warm = 1;
    t3r_runtime *rt = opened(&config), *found;
    t3r_scene scene;
    t3r_runtime *const damaged = (t3r_runtime *)(void *)copy;
    add(rt);
    DAMAGED(damaged->next_slot = 1); /* the second slot is still empty */
    add(rt);
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    add(rt); /* replaces the first one */
    assert_int_equal(rt->next_slot, 1);
    memcpy(copy, arena, arena_bytes);
    assert_int_equal(t3r_attach(&found, copy, arena_bytes), T3R_OK);
    DAMAGED(damaged->next_slot = 2);
    DAMAGED(damaged->reuse.views = 4);
    DAMAGED(damaged->reuse.centres = 0);
    DAMAGED(((t3r_cluster *)t3r_buffer_at(damaged, T3R_BUFFER_KEPT_CLUSTERS))->centre_q19[0] = INT32_MIN);
    DAMAGED(((t3r_cluster *)t3r_buffer_at(damaged, T3R_BUFFER_KEPT_CLUSTERS))->centre_q19[1] = INT32_MAX);
}

TEST(streams_that_cannot_be)
{
    t3r_config config = some_config();
    config.stream = config.warm = 1;
    config.max_gaussians = 2 * BUDGET;
    t3r_runtime *rt = opened(&config), *found;
    t3r_runtime *const damaged = (t3r_runtime *)(void *)copy;
    const t3r_frame frame = some_frame();
    const t3r_camera camera = some_camera();
    DAMAGED(damaged->views = 1); /* before the first keyframe */
    DAMAGED(damaged->views = damaged->next_slot = 1);
    DAMAGED(damaged->keyframes = 1);
    DAMAGED(damaged->gaussians = 1);
    DAMAGED(damaged->has_scene = 1);
    assert_int_equal(t3r_stream_keyframe(rt, &frame, &camera, NULL), T3R_OK);
    memcpy(copy, arena, arena_bytes);
    assert_int_equal(t3r_attach(&found, copy, arena_bytes), T3R_OK);
    DAMAGED(damaged->analysed = 1);
    DAMAGED(damaged->next_slot = 2);
    DAMAGED(damaged->next_slot = 0);
    DAMAGED(damaged->gaussians = BUDGET + 1);
    DAMAGED(damaged->keyframes = 0);
    DAMAGED(damaged->reuse.views = 1);
    assert_int_equal(t3r_stream_keyframe(rt, &frame, &camera, NULL), T3R_OK);
    DAMAGED(damaged->next_slot = 2); /* all are present */
    assert_int_equal(t3r_stream_keyframe(rt, &frame, &camera, NULL), T3R_OK);
    memcpy(copy, arena, arena_bytes);
    assert_int_equal(t3r_attach(&found, copy, arena_bytes), T3R_OK);
}
#undef DAMAGED

TEST(scenes_out_of_range)
{
    const t3r_config config = some_config();
    t3r_runtime *rt = opened(&config);
    const int64_t most = (INT64_C(1) << 62) - 1;
    const struct {
        t3r_scene_frame frame;
        t3r_status status;
    } frames[] = {
        {{{most, -most, 0}, T3R_EXPONENT_LEAST}, T3R_OK},
        {{{0, 0, most}, T3R_EXPONENT_MOST}, T3R_OK},
        {{{most + 1, 0, 0}, 0}, T3R_ERR_ARGUMENT},
        {{{0, -most - 1, 0}, 0}, T3R_ERR_ARGUMENT},
        {{{0, 0, 0}, T3R_EXPONENT_LEAST - 1}, T3R_ERR_ARGUMENT},
        {{{0, 0, 0}, T3R_EXPONENT_MOST + 1}, T3R_ERR_ARGUMENT},
    };
    for (size_t i = 0; i < sizeof frames / sizeof frames[0]; i++) {
        assert_int_equal(t3r_scene_begin(rt, &frames[i].frame), frames[i].status);
    }
}

/* A camera too far from the scene's origin for Q20, at each of the three consecutive limits. */
TEST(cameras_too_far_away)
{
    const struct {
        int64_t position_q32, origin_q32;
        int32_t exponent;
        t3r_status status;
    } cases[] = {
        {INT64_C(1023) << 32, 0, 0, T3R_OK},
        {INT64_C(1025) << 32, 0, 0, T3R_ERR_CAMERA},
        {INT64_C(1) << 61, -(INT64_C(1) << 61), T3R_EXPONENT_MOST, T3R_ERR_CAMERA},
        {(INT64_C(1) << 30) + 1, 0, T3R_EXPONENT_LEAST, T3R_ERR_CAMERA}, /* more than the shift to the left allows */
        {1 << 12, 0, T3R_EXPONENT_LEAST, T3R_OK},
        {1 << 29, 0, T3R_EXPONENT_LEAST, T3R_ERR_CAMERA},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        t3r_camera camera = some_camera();
        t3r_pose pose;
        camera.position_q32[1] = cases[i].position_q32;
        const t3r_scene_frame frame = {{0, cases[i].origin_q32, 0}, cases[i].exponent};
        assert_int_equal(t3r_pose_in_scene(&camera, &frame, &pose), cases[i].status);
    }
}

/* Strips without depth, pairs of rows, and colour after all of the depth. */
TEST(strips)
{
    t3r_config config = some_config();
    t3r_runtime *rt = opened(&config);
    t3r_frame frame = some_frame();
    const t3r_camera camera = some_camera();
    frame.format = T3R_PIXEL_NV12;
    frame.stride_bytes[0] = frame.stride_bytes[1] = SIDE;
    frame.planes[1] = rgb + PIXELS;
    assert_int_equal(t3r_add_rows(rt, &frame, &camera, 0, 3, 0, 1), T3R_ERR_FRAME);
    assert_int_equal(t3r_add_rows(rt, &frame, &camera, 1, 2, 0, 1), T3R_ERR_FRAME);
    frame.width = 0;
    assert_int_equal(t3r_add_rows(rt, &frame, &camera, 0, 2, 0, 1), T3R_ERR_FRAME);
    frame = some_frame();
    assert_int_equal(t3r_add_rows(rt, &frame, &camera, 0, 0, 0, SIDE), T3R_OK); /* all of the depth first */
    t3r_frame colour = frame;
    for (uint32_t y = 0; y < SIDE; y += 8) {
        colour.planes[0] = rgb + (size_t)3 * SIDE * y;
        assert_int_equal(t3r_add_rows(rt, &colour, &camera, y, 8, SIDE, 0), T3R_OK);
    }
    assert_int_equal(rt->views, 1);
    assert_int_equal(t3r_add_rows(rt, &frame, &camera, 0, 8, 0, 0), T3R_OK);
    assert_int_equal(t3r_add_rows(rt, &frame, &camera, 0, 0, 0, 8),
                     T3R_ERR_STATE); /* starts no frame, continues none */
    t3r_frame lower = frame;         /* of the plane's width, but still resized */
    lower.height = SIDE / 2;
    assert_int_equal(t3r_add_view(rt, &lower, &camera), T3R_OK);
    config.warm = 1;
    rt = opened(&config);
    add(rt);
    add(rt);
    assert_int_equal(t3r_add_rows(rt, &frame, &camera, 0, 8, 0, 8), T3R_ERR_STATE); /* strips replace no view */
    config = some_config();
    config.depth = T3R_DEPTH_STEREO;
    rt = opened(&config);
    frame.depth = NULL;
    assert_int_equal(t3r_add_rows(rt, &frame, &camera, 0, SIDE / 2, 7, 7), T3R_OK); /* rows of depth are ignored */
    colour = frame;
    colour.planes[0] = rgb + (size_t)3 * SIDE * (SIDE / 2);
    assert_int_equal(t3r_add_rows(rt, &colour, &camera, SIDE / 2, SIDE / 2, 0, 0), T3R_OK);
    assert_int_equal(rt->views, 1);
    t3r_scene scene;
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_ERR_STATE); /* stereo needs two */
}
