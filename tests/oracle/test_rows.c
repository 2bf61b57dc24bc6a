/* SPDX-License-Identifier: Apache-2.0 */
/* Views that come in strips of rows have the hashes of whole frames; strips out of order are refused. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/float64/drawing.h"
#include "rgbd_frame.h"
#include "test.h"

enum { W = 32, H = 24, FROM_W = 50, FROM_H = 38, DEPTH_W = 36, DEPTH_H = 27, MOST = FROM_W * FROM_H };

static uint8_t colour[MOST * 3], chroma[MOST], depth[MOST * 2];

static t3r_frame frame_of(t3r_pixel_format format, uint32_t width, uint32_t height)
{
    for (uint32_t i = 0; i < sizeof colour; i++) {
        colour[i] = (uint8_t)(i * i / 7 + i % 31 * 5);
    }
    for (uint32_t i = 0; i < sizeof chroma; i++) {
        chroma[i] = (uint8_t)(90 + i * 13 % 70);
    }
    for (uint32_t i = 0; i < MOST; i++) {
        const uint32_t steps = i % 97 == 0 ? 0 : 1500 + i * 37 % 900;
        depth[2 * i] = (uint8_t)steps;
        depth[2 * i + 1] = (uint8_t)(steps >> 8);
    }
    t3r_frame frame = rgbd_frame(colour, depth, width, height, MILLIMETRE_Q40);
    frame.format = format;
    if (format == T3R_PIXEL_NV12) {
        frame.planes[1] = chroma;
        frame.stride_bytes[0] = frame.stride_bytes[1] = width;
    } else if (format == T3R_PIXEL_YUYV) {
        frame.stride_bytes[0] = 2 * width;
    }
    frame.depth_width = DEPTH_W;
    frame.depth_height = DEPTH_H;
    frame.depth_stride_bytes = 2 * DEPTH_W;
    return frame;
}

static t3r_camera camera_of(uint32_t width, uint32_t height, t3r_distortion distortion)
{
    return (t3r_camera){.fx_q16 = (int32_t)width << 16,
                        .fy_q16 = (int32_t)width << 16,
                        .cx_q16 = (int32_t)width << 15,
                        .cy_q16 = (int32_t)height << 15,
                        .distortion = distortion,
                        .distortion_q24 = {-(1 << 20), 1 << 17},
                        .rotation_q30 = {1 << 30, 0, 0, 0}};
}

typedef struct session {
    arena memory;
    t3r_runtime *rt;
    uint64_t hash;
} session;

static void on_hash(void *user, t3r_stage stage, uint64_t hash)
{
    session *s = user;
    s->hash = s->hash * 31 + hash + stage;
}

static void begin(session *s, t3r_config config)
{
    *s = (session){.memory = arena_of(&config, ARENA_AT_MINIMUM)};
    assert_int_equal(t3r_init(&s->rt, s->memory.bytes, s->memory.count, &config), T3R_OK);
    const t3r_hooks hooks = {.user = s, .stage_hash = on_hash};
    assert_int_equal(t3r_set_hooks(s->rt, &hooks), T3R_OK);
}

static t3r_config config_of(void)
{
    t3r_config config = t3r_default_config(W, H, 2, 100);
    config.refine = 0;
    return config;
}

static uint64_t hash_of_scene(session *s)
{
    t3r_scene scene;
    assert_int_equal(t3r_reconstruct(s->rt, NULL, &scene), T3R_OK);
    return s->hash;
}

/* Copies rows to memory of exactly their size, so that sanitizers see a read beyond them. */
static const uint8_t *rows_of(const uint8_t *plane, uint32_t stride, uint32_t row, uint32_t rows)
{
    uint8_t *copy = malloc((size_t)stride * rows + 1);
    assert_non_null(copy);
    memcpy(copy, plane + (size_t)stride * row, (size_t)stride * rows);
    return copy;
}

static t3r_status strip(t3r_runtime *rt, const t3r_frame *whole, const t3r_camera *camera, uint32_t row, uint32_t rows,
                        uint32_t depth_row, uint32_t depth_rows)
{
    t3r_frame part = *whole;
    part.planes[0] = rows_of(whole->planes[0], whole->stride_bytes[0], row, rows);
    if (whole->planes[1] != NULL) {
        part.planes[1] = rows_of(whole->planes[1], whole->stride_bytes[1], row / 2, rows / 2);
    }
    part.depth = rows_of(whole->depth, whole->depth_stride_bytes, depth_row, depth_rows);
    const t3r_status status = t3r_add_rows(rt, &part, camera, row, rows, depth_row, depth_rows);
    free((void *)(uintptr_t)part.planes[0]);
    free((void *)(uintptr_t)part.planes[1]);
    free((void *)(uintptr_t)part.depth);
    return status;
}

static uint32_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* Adds colour in strips of `rows`, each with `depth_rows` of depth, then the rest of the depth. */
static void add_in_strips(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, uint32_t rows,
                          uint32_t depth_rows)
{
    uint32_t row = 0, depth_row = 0;
    while (row < frame->height || depth_row < frame->depth_height) {
        const uint32_t now = least(rows, frame->height - row);
        const uint32_t depth_now = least(depth_rows, frame->depth_height - depth_row);
        assert_int_equal(strip(rt, frame, camera, row, now, depth_row, depth_now), T3R_OK);
        row += now;
        depth_row += depth_now;
    }
}

TEST(strips_have_the_bits_of_frames)
{
    static const t3r_pixel_format formats[] = {T3R_PIXEL_RGB24, T3R_PIXEL_YUYV, T3R_PIXEL_NV12};
    static const uint32_t heights[][2] = {{1, 1}, {7, 7}, {16, 3}, {2, 27}, {38, 1}};
    for (uint32_t i = 0; i < 3 * 2 * 2; i++) {
        const t3r_pixel_format format = formats[i % 3];
        const bool resized = i / 3 % 2 == 0;
        const t3r_frame frame = frame_of(format, resized ? FROM_W : W, resized ? FROM_H : H);
        const t3r_camera camera =
            camera_of(frame.width, frame.height, i < 6 ? T3R_DISTORTION_NONE : T3R_DISTORTION_RADTAN);
        session whole;
        begin(&whole, config_of());
        assert_int_equal(t3r_add_view(whole.rt, &frame, &camera), T3R_OK);
        assert_int_equal(t3r_add_view(whole.rt, &frame, &camera), T3R_OK);
        const uint64_t want = hash_of_scene(&whole);
        for (size_t h = 0; h < sizeof heights / sizeof heights[0]; h++) {
            session rows;
            begin(&rows, config_of());
            const uint32_t count = format == T3R_PIXEL_NV12 ? heights[h][0] + heights[h][0] % 2 : heights[h][0];
            add_in_strips(rows.rt, &frame, &camera, count, heights[h][1]);
            add_in_strips(rows.rt, &frame, &camera, count, heights[h][1]);
            assert_int_equal(strip(rows.rt, &frame, &camera, 0, 2, 0, 1), T3R_ERR_STATE); /* both views are complete */
            assert_true(hash_of_scene(&rows) == want);
            arena_free(&rows.memory);
        }
        arena_free(&whole.memory);
    }
}

TEST(strips_out_of_order_are_refused)
{
    const t3r_frame frame = frame_of(T3R_PIXEL_RGB24, FROM_W, FROM_H);
    const t3r_camera camera = camera_of(FROM_W, FROM_H, T3R_DISTORTION_NONE);
    session whole, s;
    begin(&whole, config_of());
    assert_int_equal(t3r_add_view(whole.rt, &frame, &camera), T3R_OK);
    const uint64_t want = hash_of_scene(&whole);
    arena_free(&whole.memory);

    begin(&s, config_of());
    assert_int_equal(t3r_add_rows(NULL, &frame, &camera, 0, 1, 0, 1), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_add_rows(s.rt, NULL, &camera, 0, 1, 0, 1), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_add_rows(s.rt, &frame, NULL, 0, 1, 0, 1), T3R_ERR_ARGUMENT);
    assert_int_equal(strip(s.rt, &frame, &camera, 4, 1, 0, 1), T3R_ERR_STATE); /* not begun */
    assert_int_equal(strip(s.rt, &frame, &camera, 0, 9, 0, 9), T3R_OK);
    const struct {
        uint32_t row, rows, depth_row, depth_rows;
        t3r_status status;
    } wrong[] = {
        {8, 2, 9, 1, T3R_ERR_STATE},          {10, 2, 9, 1, T3R_ERR_STATE}, {9, 2, 8, 1, T3R_ERR_STATE},
        {9, 2, 10, 1, T3R_ERR_STATE},         {9, 2, 0, 0, T3R_ERR_STATE},  {9, 30, 9, 1, T3R_ERR_FRAME},
        {9, UINT32_MAX, 9, 1, T3R_ERR_FRAME}, {39, 0, 9, 1, T3R_ERR_FRAME}, {9, 1, 9, 19, T3R_ERR_FRAME},
        {9, 1, 9, UINT32_MAX, T3R_ERR_FRAME}, {9, 1, 28, 0, T3R_ERR_FRAME},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        assert_int_equal(
            t3r_add_rows(s.rt, &frame, &camera, wrong[i].row, wrong[i].rows, wrong[i].depth_row, wrong[i].depth_rows),
            wrong[i].status);
    }
    t3r_camera moved = camera;
    moved.position_q32[2] = 1;
    assert_int_equal(strip(s.rt, &frame, &moved, 9, 1, 9, 1), T3R_ERR_STATE);
    t3r_frame other = frame;
    other.depth_unit_q40++;
    assert_int_equal(strip(s.rt, &other, &camera, 9, 1, 9, 1), T3R_ERR_STATE);
    other.depth = NULL;
    assert_int_equal(t3r_add_rows(s.rt, &other, &camera, 9, 1, 9, 1), T3R_ERR_NO_DEPTH);
    t3r_scene scene;
    /* the refused calls have not removed the earlier rows */
    assert_int_equal(strip(s.rt, &frame, &camera, 9, 29, 9, 18), T3R_OK);
    assert_true(hash_of_scene(&s) == want);
    assert_int_equal(strip(s.rt, &frame, &camera, 0, 1, 0, 1), T3R_ERR_STATE); /* there is a scene */
    arena_free(&s.memory);

    t3r_runtime *attached;
    begin(&s, config_of());
    for (int call = 0; call < 4; call++) { /* each discards the rows so far */
        assert_int_equal(strip(s.rt, &frame, &camera, 0, 9, 0, 9), T3R_OK);
        if (call == 0) {
            assert_int_equal(t3r_reset(s.rt), T3R_OK);
        } else if (call == 1) {
            assert_int_equal(t3r_attach(&attached, s.memory.bytes, s.memory.count), T3R_OK);
        } else if (call == 2) {
            assert_int_equal(t3r_add_view(s.rt, &frame, &camera), T3R_OK);
        } else {
            assert_int_equal(t3r_reconstruct(s.rt, NULL, &scene), T3R_OK);
            assert_int_equal(t3r_reset(s.rt), T3R_OK);
        }
        assert_int_equal(strip(s.rt, &frame, &camera, 9, 1, 9, 1), T3R_ERR_STATE);
    }
    /* a view that starts again midway, and one without a measurement */
    assert_int_equal(strip(s.rt, &frame, &camera, 0, 9, 0, 9), T3R_OK);
    add_in_strips(s.rt, &frame, &camera, 5, 5);
    memset(depth, 0, sizeof depth);
    assert_int_equal(strip(s.rt, &frame, &camera, 0, 30, 0, 27), T3R_OK);
    assert_int_equal(strip(s.rt, &frame, &camera, 30, 8, 27, 0), T3R_ERR_NO_DEPTH);
    assert_int_equal(strip(s.rt, &frame, &camera, 30, 8, 27, 0), T3R_ERR_STATE);
    const t3r_camera nowhere = {.fx_q16 = 1};
    assert_int_equal(strip(s.rt, &frame, &nowhere, 0, 8, 0, 0), T3R_ERR_CAMERA);
    arena_free(&s.memory);
}
