/* SPDX-License-Identifier: Apache-2.0 */
/* Misuse of the C interface: null pointers, every field beyond its documented range, calls out of order. Each gives
 * the documented status and leaves the arena unchanged, to the byte. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/float64/drawing.h"
#include "rgbd_frame.h"
#include "sanitized_cpu.h"
#include "test.h"
#include "weights_maker.h"

enum { W = 32, H = 24, POINTS = W * H };

static const t3r_scene_frame plain_frame;

/* ---- a runtime and a copy of its arena ----------------------------------------------------------- */

typedef struct bench {
    t3r_config config;
    arena memory, before;
    t3r_runtime *rt;
} bench;

static bench bench_of(t3r_config config)
{
    bench b = {.config = config, .memory = arena_of(&config, ARENA_AT_MINIMUM)};
    b.before = arena_of_bytes(b.memory.count);
    assert_int_equal(t3r_init(&b.rt, b.memory.bytes, b.memory.count, &config), T3R_OK);
    vectors_if_sanitized(b.rt);
    return b;
}

static void bench_free(bench *b)
{
    arena_free(&b->memory);
    arena_free(&b->before);
}

static void remember(bench *b)
{
    memcpy(b->before.bytes, b->memory.bytes, b->memory.count);
}

static void refused_at(bench *b, t3r_status got, t3r_status want, int line)
{
    if (got != want) {
        fail_msg("line %d: status %d (%s), wanted %d", line, (int)got, t3r_error_text(got), (int)want);
    }
    if (memcmp(b->before.bytes, b->memory.bytes, b->memory.count) != 0) {
        fail_msg("line %d: a refused call changed the arena", line);
    }
}

/* The call is refused with the status, and the arena does not change. */
#define REFUSED(b, call, want)                                                                                         \
    do {                                                                                                               \
        remember(b);                                                                                                   \
        refused_at((b), (call), (want), __LINE__);                                                                     \
    } while (0)

/* ---- an input picture ---------------------------------------------------------------------------- */

static uint8_t pixels[T3R_PIXEL_FORMAT_COUNT][POINTS * 3];
static uint8_t depths[POINTS * 2];

static t3r_frame good_frame(void)
{
    for (size_t i = 0; i < POINTS; i++) {
        uint16_t millimetres = (uint16_t)(1500 + i % W * 4 + i / W * 3);
        depths[i * 2] = (uint8_t)millimetres;
        depths[i * 2 + 1] = (uint8_t)(millimetres >> 8);
        for (size_t c = 0; c < 3; c++) {
            pixels[T3R_PIXEL_RGB24][i * 3 + c] = (uint8_t)(i * (7 + c) + (i / W) * 13);
        }
    }
    return rgbd_frame(pixels[T3R_PIXEL_RGB24], depths, W, H, MILLIMETRE_Q40);
}

static t3r_config good_config(void)
{
    t3r_config c = t3r_default_config(W, H, 2, 200);
    c.clusters = 8;
    return c;
}

/* ---- tests --------------------------------------------------------------------------------------- */

TEST(null_pointers)
{
    bench b = bench_of(good_config());
    t3r_frame frame = good_frame();
    t3r_camera camera = plain_camera(30, W, H), undistorted;
    t3r_gaussian g = round_gaussian(0, 0, 1, 0.1, 0.5, 1, 1, 1);
    uint8_t rgb[POINTS * 3];
    t3r_target target = {.width = W, .height = H, .rgb = rgb, .rgb_stride_bytes = W * 3};
    t3r_scene scene;
    t3r_plan_info plan;
    t3r_runtime *rt = b.rt;
    assert_int_equal(t3r_plan(NULL, &plan), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_plan(&b.config, NULL), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_init(NULL, b.memory.bytes, b.memory.count, &b.config), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_init(&rt, NULL, b.memory.count, &b.config), T3R_ERR_ARGUMENT);
    assert_null(rt);
    rt = b.rt;
    REFUSED(&b, t3r_init(&rt, b.memory.bytes, b.memory.count, NULL), T3R_ERR_ARGUMENT);
    assert_null(rt);
    REFUSED(&b, t3r_attach(NULL, b.memory.bytes, b.memory.count), T3R_ERR_ARGUMENT);
    rt = b.rt;
    REFUSED(&b, t3r_attach(&rt, NULL, b.memory.count), T3R_ERR_ARGUMENT);
    assert_null(rt);
    REFUSED(&b, t3r_set_hooks(NULL, NULL), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_bind_head(NULL, NULL, 0), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_add_view(NULL, &frame, &camera), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_add_view(b.rt, NULL, &camera), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_add_view(b.rt, &frame, NULL), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_reset(NULL), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_plan_within(b.memory.count, NULL), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_reconstruct(NULL, NULL, &scene), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_reconstruct(b.rt, NULL, NULL), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_rebuild(NULL, NULL, &scene), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_rebuild(b.rt, NULL, NULL), T3R_ERR_ARGUMENT);
    static const uint16_t plane[POINTS];
    const uint16_t *const second_missing[] = {plane, NULL};
    const t3r_request half = {.importance = second_missing, .importance_stride_bytes = W * 2};
    bench two = bench_of(good_config());
    assert_int_equal(t3r_add_view(two.rt, &frame, &camera), T3R_OK);
    assert_int_equal(t3r_add_view(two.rt, &frame, &camera), T3R_OK);
    REFUSED(&two, t3r_reconstruct(two.rt, &half, &scene), T3R_ERR_ARGUMENT);
    REFUSED(&two, t3r_rebuild(two.rt, &half, &scene), T3R_ERR_ARGUMENT);
    bench_free(&two);
    REFUSED(&b, t3r_get_scene(NULL, &scene), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_get_scene(b.rt, NULL), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_scene_begin(NULL, &plain_frame), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_scene_begin(b.rt, NULL), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_scene_append(NULL, &g), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_scene_append(b.rt, NULL), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_render(NULL, &camera, &target), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_render(b.rt, NULL, &target), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_render(b.rt, &camera, NULL), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_render_passes(NULL), 0);
    REFUSED(&b, t3r_develop(NULL, &frame, &camera, rgb, NULL, &undistorted), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_develop(b.rt, NULL, &camera, rgb, NULL, &undistorted), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_develop(b.rt, &frame, NULL, rgb, NULL, &undistorted), T3R_ERR_ARGUMENT);
    REFUSED(&b, t3r_develop(b.rt, &frame, &camera, NULL, NULL, &undistorted), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_set_hooks(b.rt, NULL), T3R_OK);
    bench_free(&b);
}

TEST(config_ranges)
{
    const t3r_config good = good_config();
    assert_null(t3r_config_error(&good));
    assert_non_null(t3r_config_error(NULL));
    static const struct {
        size_t field;
        uint32_t least_bad, most_good, too_low; /* too_low UINT32_MAX: 0 is allowed */
    } ranges[] = {
#define RANGE(field, low, high) {offsetof(t3r_config, field), (high) + 1u, (high), (low) == 0 ? UINT32_MAX : (low)-1u}
#define SETTING_RANGE(name, kind, low, high, ...) RANGE(name, low, high),
        T3R_SETTINGS(SETTING_RANGE) RANGE(max_gaussians, 200, T3R_MAX_GAUSSIANS), /* the budget is 200 */
        RANGE(gaussians, 1, 200),
    };
    const size_t settings = sizeof(t3r_config) / sizeof(uint32_t); /* rows of the table come first */
    for (size_t i = 0; i < sizeof ranges / sizeof ranges[0]; i++) {
        const size_t field = ranges[i].field;
        if (field == offsetof(t3r_config, seed) ||
            (i < settings && (field == offsetof(t3r_config, gaussians) ||
                              field == offsetof(t3r_config, max_gaussians) || field == offsetof(t3r_config, depth)))) {
            continue; /* any number is a seed; the others depend on each other and on the size */
        }
        const uint32_t bad[] = {ranges[i].least_bad, UINT32_MAX, ranges[i].too_low};
        for (size_t k = 0; k < 3; k++) {
            t3r_config c = good;
            t3r_plan_info plan;
            memcpy((uint8_t *)&c + ranges[i].field, &bad[k], sizeof bad[k]);
            assert_non_null(t3r_config_error(&c));
            assert_int_equal(t3r_plan(&c, &plan), T3R_ERR_CONFIG);
            arena a = arena_of(&good, ARENA_AT_FULL);
            t3r_runtime *rt = (t3r_runtime *)(void *)&c;
            assert_int_equal(t3r_init(&rt, a.bytes, a.count, &c), T3R_ERR_CONFIG);
            assert_null(rt);
            for (size_t byte = 0; byte < a.count; byte++) {
                assert_int_equal(((uint8_t *)a.bytes)[byte], 0xa5);
            }
            arena_free(&a);
        }
        t3r_config c = good;
        memcpy((uint8_t *)&c + ranges[i].field, &ranges[i].most_good, sizeof(uint32_t));
        assert_null(t3r_config_error(&c));
    }
    /* the defaults never fail where the four numbers are in range, and out of range are refused later */
    for (uint32_t side = T3R_MIN_SIDE; side <= T3R_MAX_SIDE; side *= 2) {
        t3r_config c = t3r_default_config(side, side, 2, side * side / 10);
        assert_null(t3r_config_error(&c));
    }
    t3r_config c = t3r_default_config(0, UINT32_MAX, 17, 0);
    assert_non_null(t3r_config_error(&c));
}

/* Adds an entry to bad[n]: `good` except for one field. */
#define BAD(field, value)                                                                                              \
    do {                                                                                                               \
        bad[n] = good;                                                                                                 \
        bad[n].field = (value);                                                                                        \
        n++;                                                                                                           \
    } while (0)

TEST(frame_ranges)
{
    bench b = bench_of(good_config());
    t3r_camera camera = plain_camera(30, W, H);
    const t3r_frame good = good_frame();
    t3r_frame bad[40];
    size_t n = 0;
    BAD(format, T3R_PIXEL_FORMAT_COUNT);
    BAD(format, (t3r_pixel_format)-1);
    BAD(width, 0);
    BAD(width, 1);
    BAD(width, T3R_MAX_SIDE + 1);
    BAD(width, UINT32_MAX);
    BAD(height, 0);
    BAD(height, 1);
    BAD(height, T3R_MAX_SIDE + 1);
    BAD(height, UINT32_MAX);
    BAD(stride_bytes[0], 0);
    BAD(stride_bytes[0], W * 3 - 1);
    BAD(depth_width, 0);
    BAD(depth_width, T3R_MAX_SIDE + 1);
    BAD(depth_height, 0);
    BAD(depth_height, UINT32_MAX);
    BAD(depth_stride_bytes, W * 2 - 1);
    BAD(depth_stride_bytes, 0);
    BAD(depth_unit_q40, 0);
    for (size_t i = 0; i < n; i++) {
        REFUSED(&b, t3r_add_view(b.rt, &bad[i], &camera), T3R_ERR_FRAME);
    }
    /* 4:2:2 wants an even width, 4:2:0 both sides even and its second plane */
    n = 0;
    for (int format = T3R_PIXEL_YUYV; format <= T3R_PIXEL_NV12; format++) {
        BAD(format, (t3r_pixel_format)format);
        bad[n - 1].width = W - 1;
        bad[n - 1].stride_bytes[1] = W;
        bad[n - 1].planes[1] = pixels[0];
    }
    BAD(format, T3R_PIXEL_NV12);
    bad[n - 1].height = H - 1;
    bad[n - 1].planes[1] = pixels[0];
    bad[n - 1].stride_bytes[1] = W;
    BAD(format, T3R_PIXEL_NV12);
    bad[n - 1].planes[1] = pixels[0];
    bad[n - 1].stride_bytes[1] = W - 1;
    for (size_t i = 0; i < n; i++) {
        REFUSED(&b, t3r_add_view(b.rt, &bad[i], &camera), T3R_ERR_FRAME);
    }
    t3r_frame missing = good;
    missing.planes[0] = NULL;
    remember(&b);
    t3r_status status = t3r_add_view(b.rt, &missing, &camera);
    refused_at(&b, status, status == T3R_ERR_ARGUMENT ? T3R_ERR_ARGUMENT : T3R_ERR_FRAME, __LINE__);
    missing = good;
    missing.format = T3R_PIXEL_NV12;
    remember(&b);
    status = t3r_add_view(b.rt, &missing, &camera);
    refused_at(&b, status, status == T3R_ERR_ARGUMENT ? T3R_ERR_ARGUMENT : T3R_ERR_FRAME, __LINE__);
    /* documented values are accepted: a frame of 2 x 2, depth of another size, no depth where none is needed */
    assert_int_equal(t3r_add_view(b.rt, &good, &camera), T3R_OK);
    assert_int_equal(t3r_reset(b.rt), T3R_OK);
    t3r_frame small = good;
    small.width = small.height = 2;
    small.depth_width = 2;
    small.depth_height = 3;
    assert_int_equal(t3r_add_view(b.rt, &small, &camera), T3R_OK);
    assert_int_equal(t3r_reset(b.rt), T3R_OK); /* developing needs the planes of a runtime without views */
    small.depth = NULL;
    small.depth_width = small.depth_height = small.depth_stride_bytes = 0;
    small.depth_unit_q40 = 0;
    uint8_t rgb[POINTS * 3];
    t3r_camera undistorted;
    assert_int_equal(t3r_develop(b.rt, &small, &camera, rgb, NULL, &undistorted), T3R_OK);
    bench_free(&b);
}

TEST(camera_ranges)
{
    t3r_config config = good_config();
    bench b = bench_of(config);
    t3r_frame frame = good_frame();
    const t3r_camera good = plain_camera(30, W, H);
    t3r_camera bad[64];
    size_t n = 0;
    BAD(width, W); /* of no height */
    BAD(height, H);
    BAD(fx_q16, 0);
    BAD(fx_q16, (8 << 16) - 1);
    BAD(fx_q16, 16384 << 16);
    BAD(fx_q16, INT32_MAX);
    BAD(fx_q16, INT32_MIN);
    BAD(fy_q16, -(30 << 16));
    BAD(fy_q16, (8 << 16) - 1);
    BAD(fy_q16, 16384 << 16);
    BAD(cx_q16, 16384 << 16);
    BAD(cx_q16, -(16384 << 16));
    BAD(cx_q16, INT32_MIN);
    BAD(cy_q16, 16384 << 16);
    BAD(cy_q16, -(16384 << 16));
    BAD(cy_q16, INT32_MAX);
    BAD(rotation_q30[0], 0);
    BAD(rotation_q30[0], (1 << 29) - (1 << 16));
    BAD(rotation_q30[0], 3 * (1 << 29) + (1 << 16));
    BAD(rotation_q30[0], INT32_MIN);
    BAD(rotation_q30[3], INT32_MAX);
    const size_t of_target_too = n;
    BAD(distortion, T3R_DISTORTION_COUNT);
    BAD(distortion, (t3r_distortion)-1);
    for (size_t i = 0; i < n; i++) {
        REFUSED(&b, t3r_add_view(b.rt, &frame, &bad[i]), T3R_ERR_CAMERA);
    }
    uint8_t rgb[POINTS * 3];
    t3r_camera undistorted;
    for (size_t i = 0; i < n; i++) {
        REFUSED(&b, t3r_develop(b.rt, &frame, &bad[i], rgb, NULL, &undistorted), T3R_ERR_CAMERA);
    }
    t3r_gaussian g = round_gaussian(0, 0, 1, 0.1, 0.5, 1, 1, 1);
    load_scene(b.rt, &plain_frame, &g, 1);
    t3r_target target = {.width = W, .height = H, .rgb = rgb, .rgb_stride_bytes = W * 3};
    for (size_t i = 0; i < of_target_too; i++) {
        REFUSED(&b, t3r_render(b.rt, &bad[i], &target), T3R_ERR_CAMERA);
    }
    /* the ends of the ranges are taken, and a position anywhere gives an answer */
    t3r_camera edge = good;
    edge.fx_q16 = 8 << 16;
    edge.fy_q16 = (16384 << 16) - 1;
    edge.cx_q16 = -(16384 << 16) + 1;
    edge.cy_q16 = (16384 << 16) - 1;
    edge.rotation_q30[0] = (1 << 29) + (1 << 16);
    assert_int_equal(t3r_render(b.rt, &edge, &target), T3R_OK);
    edge.rotation_q30[0] = 3 * (1 << 29) - (1 << 16);
    assert_int_equal(t3r_render(b.rt, &edge, &target), T3R_OK);
    static const int64_t places[] = {INT64_MIN, INT64_MIN + 1, -1, 1, INT64_MAX};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        for (int k = 0; k < 3; k++) {
            t3r_camera far = good;
            far.position_q32[k] = places[i];
            t3r_status status = t3r_render(b.rt, &far, &target);
            assert_true(status == T3R_OK || status == T3R_ERR_CAMERA);
        }
    }
    bench_free(&b);
}

TEST(gaussian_ranges)
{
    bench b = bench_of(good_config());
    assert_int_equal(t3r_scene_begin(b.rt, &plain_frame), T3R_OK);
    const t3r_gaussian good = round_gaussian(0, 0, 1, 0.1, 0.5, 1, 1, 1);
    t3r_gaussian bad[16];
    size_t n = 0;
    BAD(factor_exponent, -61);
    BAD(factor_exponent, 16);
    BAD(factor_exponent, INT8_MIN);
    BAD(factor_exponent, INT8_MAX);
    BAD(colour_q7[0], 32641);
    BAD(colour_q7[1], 32641);
    BAD(colour_q7[2], UINT16_MAX);
    BAD(opacity_q15, 32768);
    BAD(opacity_q15, UINT16_MAX);
    BAD(reserved[0], 1);
    BAD(reserved[2], 255);
    for (size_t i = 0; i < n; i++) {
        REFUSED(&b, t3r_scene_append(b.rt, &bad[i]), T3R_ERR_ARGUMENT);
    }
    t3r_gaussian edge = good;
    edge.factor_exponent = -60;
    edge.opacity_q15 = 32767;
    edge.colour_q7[0] = 32640;
    edge.view = 255;
    assert_int_equal(t3r_scene_append(b.rt, &edge), T3R_OK);
    edge.factor_exponent = 15;
    assert_int_equal(t3r_scene_append(b.rt, &edge), T3R_OK);
    t3r_scene scene;
    assert_int_equal(t3r_get_scene(b.rt, &scene), T3R_OK);
    assert_int_equal(scene.count, 2);
    for (uint32_t i = scene.count; i < b.config.max_gaussians; i++) {
        assert_int_equal(t3r_scene_append(b.rt, &good), T3R_OK);
    }
    REFUSED(&b, t3r_scene_append(b.rt, &good), T3R_ERR_FULL);
    bench_free(&b);
}

TEST(target_ranges)
{
    bench b = bench_of(good_config());
    t3r_gaussian g = round_gaussian(0, 0, 1, 0.1, 0.5, 1, 1, 1);
    load_scene(b.rt, &plain_frame, &g, 1);
    t3r_camera camera = plain_camera(30, W, H);
    static uint8_t rgb[POINTS * 3];
    static uint32_t depth[POINTS];
    static uint16_t alpha[POINTS];
    const t3r_target good = {
        .width = W,
        .height = H,
        .rgb = rgb,
        .rgb_stride_bytes = W * 3,
        .depth_q20 = depth,
        .depth_stride_bytes = W * 4,
        .alpha_q15 = alpha,
        .alpha_stride_bytes = W * 2,
    };
    t3r_target bad[16];
    size_t n = 0;
    BAD(width, 0);
    BAD(width, W + 1);
    BAD(width, UINT32_MAX);
    BAD(height, 0);
    BAD(height, H + 1);
    BAD(rgb_stride_bytes, W * 3 - 1);
    BAD(depth_stride_bytes, W * 4 - 4);
    BAD(depth_stride_bytes, W * 4 + 2);
    BAD(alpha_stride_bytes, W * 2 - 2);
    BAD(alpha_stride_bytes, W * 2 + 1);
    BAD(depth_q20, (uint32_t *)((uintptr_t)depth + 2));
    BAD(alpha_q15, (uint16_t *)((uintptr_t)alpha + 1));
    for (size_t i = 0; i < n; i++) {
        REFUSED(&b, t3r_render(b.rt, &camera, &bad[i]), T3R_ERR_ARGUMENT);
    }
    assert_int_equal(t3r_render(b.rt, &camera, &good), T3R_OK);
    bench_free(&b);
}

TEST(calls_out_of_order)
{
    t3r_frame frame = good_frame(), blind = frame;
    blind.depth = NULL;
    t3r_camera camera = plain_camera(30, W, H);
    uint8_t rgb[POINTS * 3];
    t3r_target target = {.width = W, .height = H, .rgb = rgb, .rgb_stride_bytes = W * 3};
    t3r_gaussian g = round_gaussian(0, 0, 1, 0.1, 0.5, 1, 1, 1);
    t3r_scene scene;
    bench b = bench_of(good_config());
    static const uint16_t plane[POINTS];
    const uint16_t *const planes[] = {plane, plane};
    const t3r_request ten = {.gaussians = 10};
    const t3r_request ten_given = {.gaussians = 10, .importance = planes, .importance_stride_bytes = W * 2};
    REFUSED(&b, t3r_reconstruct(b.rt, NULL, &scene), T3R_ERR_STATE);
    REFUSED(&b, t3r_reconstruct(b.rt, &ten_given, &scene), T3R_ERR_STATE);
    REFUSED(&b, t3r_rebuild(b.rt, NULL, &scene), T3R_ERR_STATE);
    REFUSED(&b, t3r_rebuild(b.rt, &ten, &scene), T3R_ERR_STATE);
    REFUSED(&b, t3r_rebuild(b.rt, &ten_given, &scene), T3R_ERR_STATE);
    REFUSED(&b, t3r_get_scene(b.rt, &scene), T3R_ERR_STATE);
    REFUSED(&b, t3r_scene_append(b.rt, &g), T3R_ERR_STATE);
    REFUSED(&b, t3r_render(b.rt, &camera, &target), T3R_ERR_STATE);
    REFUSED(&b, t3r_add_view(b.rt, &blind, &camera), T3R_ERR_NO_DEPTH);
    assert_int_equal(t3r_add_view(b.rt, &frame, &camera), T3R_OK);
    assert_int_equal(t3r_add_view(b.rt, &frame, &camera), T3R_OK);
    REFUSED(&b, t3r_add_view(b.rt, &frame, &camera), T3R_ERR_STATE);
    assert_int_equal(t3r_reset(b.rt), T3R_OK);
    /* depth with holes only: the view is refused, or the reconstruction */
    static const uint8_t holes[POINTS * 2];
    t3r_frame empty = frame;
    empty.depth = holes;
    t3r_status status = t3r_add_view(b.rt, &empty, &camera);
    assert_int_equal(status == T3R_OK ? t3r_reconstruct(b.rt, NULL, &scene) : status, T3R_ERR_NO_DEPTH);
    assert_int_equal(t3r_reset(b.rt), T3R_OK);
    REFUSED(&b, t3r_reconstruct(b.rt, NULL, &scene), T3R_ERR_STATE);
    assert_int_equal(t3r_add_view(b.rt, &frame, &camera), T3R_OK);
    assert_int_equal(t3r_reconstruct(b.rt, NULL, &scene), T3R_OK);
    assert_int_equal(scene.count, b.config.gaussians);
    assert_int_equal(scene.valid_points, POINTS);
    /* the analysis was not kept */
    REFUSED(&b, t3r_rebuild(b.rt, NULL, &scene), T3R_ERR_STATE);
    REFUSED(&b, t3r_rebuild(b.rt, &ten, &scene), T3R_ERR_STATE);
    REFUSED(&b, t3r_rebuild(b.rt, &ten_given, &scene), T3R_ERR_STATE);
    assert_int_equal(t3r_render(b.rt, &camera, &target), T3R_OK);
    assert_int_equal(t3r_reset(b.rt), T3R_OK);
    REFUSED(&b, t3r_get_scene(b.rt, &scene), T3R_ERR_STATE);
    bench_free(&b);

    t3r_config keep = good_config();
    keep.keep_analysis = 1;
    b = bench_of(keep);
    assert_int_equal(t3r_add_view(b.rt, &frame, &camera), T3R_OK);
    REFUSED(&b, t3r_rebuild(b.rt, NULL, &scene), T3R_ERR_STATE);
    assert_int_equal(t3r_reconstruct(b.rt, NULL, &scene), T3R_OK);
    const uint16_t *const odd[] = {(const uint16_t *)(const void *)((const uint8_t *)plane + 1)};
    const t3r_request bad[] = {
        {.gaussians = keep.max_gaussians + 1},
        {.max_loss_q8 = T3R_MAX_LOSS_Q8 + 1},
        {.allocate = T3R_ALLOCATE_COUNT},
        {.head = T3R_HEAD_COUNT},
        /* importance: its budget, rows too short, odd, planes out of step, another allocation */
        {.gaussians = keep.max_gaussians + 1, .importance = planes, .importance_stride_bytes = W * 2},
        {.importance = planes, .importance_stride_bytes = W * 2 - 2},
        {.importance = planes, .importance_stride_bytes = W * 2 + 1},
        {.importance = planes, .importance_stride_bytes = 0},
        {.importance = odd, .importance_stride_bytes = W * 2},
        {.allocate = T3R_ALLOCATE_PIXEL, .importance = planes, .importance_stride_bytes = W * 2},
        {.allocate = T3R_ALLOCATE_COUNT, .importance = planes, .importance_stride_bytes = W * 2},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        REFUSED(&b, t3r_rebuild(b.rt, &bad[i], &scene), T3R_ERR_ARGUMENT);
        REFUSED(&b, t3r_reconstruct(b.rt, &bad[i], &scene), T3R_ERR_ARGUMENT);
    }
    /* `given` without importance and the learned head without weights are refused */
    const t3r_request unserved[] = {{.allocate = T3R_ALLOCATE_GIVEN}, {.head = T3R_HEAD_LEARNED}};
    for (size_t i = 0; i < sizeof unserved / sizeof unserved[0]; i++) {
        REFUSED(&b, t3r_rebuild(b.rt, &unserved[i], &scene), T3R_ERR_STATE);
        REFUSED(&b, t3r_reconstruct(b.rt, &unserved[i], &scene), T3R_ERR_STATE);
    }
    assert_int_equal(t3r_rebuild(b.rt, &ten_given, &scene), T3R_OK);
    assert_int_equal(scene.count, 10);
    assert_int_equal(t3r_rebuild(b.rt, NULL, &scene), T3R_OK); /* a request applies to its call only */
    assert_int_equal(scene.count, keep.gaussians);
    for (uint32_t z = 1; z <= keep.max_gaussians; z += 33) {
        assert_int_equal(t3r_rebuild(b.rt, &(t3r_request){.gaussians = z}, &scene), T3R_OK);
        assert_int_equal(scene.count, z);
    }
    bench_free(&b);

    /* an arena that only renders accepts no view */
    t3r_config render_only = render_config(5, W, H);
    b = bench_of(render_only);
    REFUSED(&b, t3r_add_view(b.rt, &frame, &camera), T3R_ERR_STATE);
    REFUSED(&b, t3r_reconstruct(b.rt, NULL, &scene), T3R_ERR_STATE);
    bench_free(&b);
}

/* Exactly min(Z, valid points) Gaussians; valid points are the measured ones, without filled holes. */
TEST(budgets)
{
    t3r_frame frame = good_frame();
    uint32_t measured = POINTS;
    for (size_t i = 3; i < POINTS; i += 7) { /* bracketed on all sides: fillable */
        depths[i * 2] = depths[i * 2 + 1] = 0;
        measured--;
    }
    t3r_camera camera = plain_camera(30, W, H);
    size_t weights_bytes;
    uint8_t *weights = make_weights(small_shape, small_layers, 8, 8, 1, &weights_bytes);
    static uint16_t importance[POINTS];
    for (size_t i = 0; i < POINTS; i++) {
        importance[i] = (uint16_t)(i * 7919 % 1000);
    }
    const uint16_t *const planes[] = {importance};
    for (int allocation = 1; allocation < T3R_ALLOCATE_COUNT; allocation++) {
        const bool given = allocation == T3R_ALLOCATE_GIVEN;
        /* heads get the retained points: each head with one mode, each mode with one head */
        for (int head = 1; head < (allocation == T3R_ALLOCATE_DENSITY ? (int)T3R_HEAD_COUNT : 2); head++) {
            const uint32_t wanted[] = {1, 2, measured / 20, measured / 2, measured - 1, measured, measured + 1, POINTS};
            t3r_config config = good_config();
            config.max_gaussians = config.gaussians = POINTS;
            config.allocate = (t3r_allocation)allocation;
            config.head = (t3r_head)head;
            config.head_column_bytes = SMALL_SHAPE_COLUMN_BYTES;
            config.keep_analysis = 1;
            bench b = bench_of(config);
            t3r_scene scene;
            assert_int_equal(t3r_bind_head(b.rt, weights, weights_bytes), T3R_OK);
            assert_int_equal(t3r_add_view(b.rt, &frame, &camera), T3R_OK);
            t3r_request request = {.importance = given ? planes : NULL, .importance_stride_bytes = W * 2};
            assert_int_equal(t3r_reconstruct(b.rt, &request, &scene), T3R_OK);
            assert_int_equal(scene.valid_points, measured);
            for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++) {
                request.gaussians = wanted[i];
                assert_int_equal(t3r_rebuild(b.rt, &request, &scene), T3R_OK);
                uint32_t expected = wanted[i] < measured ? wanted[i] : measured;
                if (scene.count != expected) {
                    fail_msg("%s, %s: %u Gaussians for a budget of %u with %u valid points",
                             t3r_allocation_name(config.allocate), t3r_head_name(config.head), scene.count, wanted[i],
                             measured);
                }
            }
            bench_free(&b);
        }
    }
    free(weights);
}

/* Planes' memory that is reused after the scene is built must never be taken for an analysis: a second reconstruction
 * is refused, or gives the same scene. */
TEST(planes_lent_away)
{
    t3r_frame frame = good_frame();
    t3r_camera camera = plain_camera(30, W, H);
    uint8_t rgb[POINTS * 3];
    t3r_target target = {.width = W, .height = H, .rgb = rgb, .rgb_stride_bytes = W * 3};
    t3r_gaussian g = round_gaussian(0, 0, 1, 0.1, 0.5, 1, 1, 1), expected[200];
    for (uint32_t keep = 0; keep < 2; keep++) {
        for (int between = 0; between < 4; between++) {
            t3r_config config = good_config();
            config.keep_analysis = keep;
            bench b = bench_of(config);
            t3r_scene scene;
            assert_int_equal(t3r_add_view(b.rt, &frame, &camera), T3R_OK);
            assert_int_equal(t3r_reconstruct(b.rt, NULL, &scene), T3R_OK);
            assert_int_equal(scene.count, 200);
            memcpy(expected, scene.gaussians, sizeof expected);
            if (between & 1) {
                assert_int_equal(t3r_render(b.rt, &camera, &target), T3R_OK);
            }
            if (between & 2) {
                t3r_status status = t3r_scene_begin(b.rt, &plain_frame);
                for (int i = 0; status == T3R_OK && i < 200; i++) {
                    assert_int_equal(t3r_scene_append(b.rt, &g), T3R_OK);
                }
            }
            for (int again = 0; again < 2; again++) {
                t3r_status status = again == 0 && keep ? t3r_rebuild(b.rt, &(t3r_request){.gaussians = 200}, &scene)
                                                       : t3r_reconstruct(b.rt, NULL, &scene);
                assert_true(status == T3R_OK || status == T3R_ERR_STATE);
                if (status == T3R_OK && memcmp(scene.gaussians, expected, sizeof expected) != 0) {
                    fail_msg("keep_analysis %u, in between %s%s: %s gives another scene", keep,
                             between & 1 ? "a render " : "", between & 2 ? "a scene from outside" : "",
                             again == 0 && keep ? "t3r_rebuild()" : "t3r_reconstruct()");
                }
            }
            /* a view added now is refused, or does not change the scene */
            if (t3r_add_view(b.rt, &frame, &camera) == T3R_OK && t3r_get_scene(b.rt, &scene) == T3R_OK) {
                assert_memory_equal(scene.gaussians, expected, sizeof expected);
            }
            bench_free(&b);
        }
    }
}

/* ---- cancelling ---------------------------------------------------------------------------------- */

typedef struct fuse {
    uint32_t calls, cancel_at;
} fuse;

static int burn(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    fuse *f = user;
    assert_true((int)stage >= 0 && stage < T3R_STAGE_COUNT);
    assert_true(done <= total);
    return f->calls++ == f->cancel_at;
}

TEST(cancelling)
{
    t3r_frame frame = good_frame();
    t3r_camera camera = plain_camera(30, W, H);
    bench b = bench_of(good_config());
    t3r_scene scene;
    assert_int_equal(t3r_add_view(b.rt, &frame, &camera), T3R_OK);
    assert_int_equal(t3r_reconstruct(b.rt, NULL, &scene), T3R_OK);
    t3r_gaussian *expected = malloc(scene.count * sizeof *expected);
    assert_non_null(expected);
    const uint32_t count = scene.count;
    memcpy(expected, scene.gaussians, count * sizeof *expected);
    fuse f = {0, UINT32_MAX};
    t3r_hooks hooks = {.user = &f, .progress = burn};
    uint32_t cancelled = 0;
    for (uint32_t at = 0; at < 10000; at++) {
        assert_int_equal(t3r_set_hooks(b.rt, &hooks), T3R_OK);
        f = (fuse){0, UINT32_MAX};
        assert_int_equal(t3r_reset(b.rt), T3R_OK);
        assert_int_equal(t3r_add_view(b.rt, &frame, &camera), T3R_OK);
        f = (fuse){0, at};
        t3r_status status = t3r_reconstruct(b.rt, NULL, &scene);
        if (status == T3R_OK) {
            assert_true(f.calls <= at); /* past its last call */
            break;
        }
        assert_int_equal(status, T3R_ERR_CANCELLED);
        assert_int_equal(f.calls, at + 1); /* no call after a cancelling one */
        cancelled++;
        /* a cancelled call does not affect later ones */
        assert_int_equal(t3r_set_hooks(b.rt, NULL), T3R_OK);
        assert_int_equal(t3r_reset(b.rt), T3R_OK);
        assert_int_equal(t3r_add_view(b.rt, &frame, &camera), T3R_OK);
        assert_int_equal(t3r_reconstruct(b.rt, NULL, &scene), T3R_OK);
        assert_int_equal(scene.count, count);
        assert_memory_equal(scene.gaussians, expected, count * sizeof *expected);
    }
    print_message("reconstruction can be cancelled at %u points\n", cancelled);
    assert_true(cancelled > 3);
    uint8_t rgb[POINTS * 3];
    t3r_target target = {.width = W, .height = H, .rgb = rgb, .rgb_stride_bytes = W * 3};
    f = (fuse){0, 0};
    assert_int_equal(t3r_set_hooks(b.rt, &hooks), T3R_OK);
    assert_int_equal(t3r_render(b.rt, &camera, &target), T3R_ERR_CANCELLED);
    f = (fuse){0, UINT32_MAX};
    assert_int_equal(t3r_render(b.rt, &camera, &target), T3R_OK);
    free(expected);
    bench_free(&b);
}

static const char *stage_name(int i)
{
    return t3r_stage_name((t3r_stage)i);
}

static const char *allocation_name(int i)
{
    return t3r_allocation_name((t3r_allocation)i);
}

static const char *head_name(int i)
{
    return t3r_head_name((t3r_head)i);
}

static const char *wavelet_name(int i)
{
    return t3r_wavelet_name((t3r_wavelet)i);
}

static const char *pixel_format_name(int i)
{
    return t3r_pixel_format_name((t3r_pixel_format)i);
}

static const char *depth_name(int i)
{
    return t3r_depth_name((t3r_depth)i);
}

static const char *preset_name(int i)
{
    return t3r_preset_name((t3r_preset)i);
}

TEST(texts)
{
    char version[32];
    snprintf(version, sizeof version, "%d.%d.%d", T3R_VERSION_MAJOR, T3R_VERSION_MINOR, T3R_VERSION_PATCH);
    assert_string_equal(t3r_version(), version);
    assert_string_equal(T3R_VERSION, version);
    for (int status = -100; status <= 100; status++) {
        const char *text = t3r_error_text((t3r_status)status);
        assert_non_null(text);
        assert_true(text[0] != '\0');
        for (int other = T3R_ERR_INTERFACE; other < status && status <= 0; other++) {
            assert_string_not_equal(text, t3r_error_text((t3r_status)other));
        }
    }
    static const struct {
        const char *(*name)(int);
        int first, count;
    } tables[] = {
        {stage_name, 0, T3R_STAGE_COUNT},
        {allocation_name, T3R_ALLOCATE_CONFIGURED + 1, T3R_ALLOCATE_COUNT},
        {head_name, T3R_HEAD_CONFIGURED + 1, T3R_HEAD_COUNT},
        {wavelet_name, 0, T3R_WAVELET_COUNT},
        {pixel_format_name, 0, T3R_PIXEL_FORMAT_COUNT},
        {depth_name, 0, T3R_DEPTH_COUNT},
        {preset_name, 0, T3R_PRESET_COUNT},
    };
    for (int pair = -2; pair <= T3R_PAIR_COUNT; pair++) {
        assert_non_null(t3r_pair_text((t3r_pair)pair));
        for (int other = 0; other < pair; other++) {
            assert_string_not_equal(t3r_pair_text((t3r_pair)pair), t3r_pair_text((t3r_pair)other));
        }
    }
    for (size_t i = 0; i < sizeof tables / sizeof tables[0]; i++) {
        assert_null(tables[i].name(tables[i].first - 1));
        assert_null(tables[i].name(tables[i].count));
        assert_null(tables[i].name(1 << 30));
        for (int k = tables[i].first; k < tables[i].count; k++) {
            assert_non_null(tables[i].name(k));
            for (int other = tables[i].first; other < k; other++) {
                assert_string_not_equal(tables[i].name(k), tables[i].name(other));
            }
        }
    }
}
