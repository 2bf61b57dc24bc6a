/* SPDX-License-Identifier: Apache-2.0 */
/* Misuse reaches the caller's T3R_ASSERT and is still refused; errors in a file do not reach it. */
#include <string.h>

#include "noted_assert.h"
#include "test.h"
#include "trim3r.h"

static int noted;

void noted_assertion(void)
{
    noted++;
}

enum { SIDE = 16 };
static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[T3R_ARENA_BYTES(SIDE, SIDE, 1, 16)];

static t3r_runtime *fresh(void)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, 1, 16);
    t3r_runtime *rt;
    assert_int_equal(t3r_init(&rt, arena, sizeof arena, &config), T3R_OK);
    noted = 0;
    return rt;
}

TEST(misuse_is_asserted_and_refused)
{
    t3r_runtime *rt = fresh();
    t3r_scene scene;
    assert_int_equal(t3r_reconstruct(NULL, NULL, &scene), T3R_ERR_ARGUMENT);
    assert_int_equal(noted, 1);
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_ERR_STATE);
    assert_int_equal(noted, 2);
    assert_int_equal(t3r_render(rt, NULL, NULL), T3R_ERR_ARGUMENT);
    assert_int_equal(noted, 3);
    assert_int_equal(t3r_rebuild(rt, &(t3r_request){.gaussians = 4}, &scene), T3R_ERR_STATE);
    assert_int_equal(noted, 4);
}

TEST(bad_input_is_refused_without_assertion)
{
    t3r_runtime *rt = fresh();
    uint8_t pixels[SIDE * SIDE * 3] = {0};
    t3r_frame frame = {.format = T3R_PIXEL_RGB24,
                       .width = SIDE,
                       .height = SIDE,
                       .planes = {pixels},
                       .stride_bytes = {1},
                       .depth = pixels,
                       .depth_width = SIDE,
                       .depth_height = SIDE,
                       .depth_stride_bytes = SIDE * 2,
                       .depth_unit_q40 = 1};
    t3r_camera camera = {.fx_q16 = 16 << 16, .fy_q16 = 16 << 16, .rotation_q30 = {1 << 30}};
    assert_int_equal(t3r_add_view(rt, &frame, &camera), T3R_ERR_FRAME);
    frame.stride_bytes[0] = SIDE * 3;
    camera.fx_q16 = 0;
    assert_int_equal(t3r_add_view(rt, &frame, &camera), T3R_ERR_CAMERA);
    t3r_gaussian unsound;
    memset(&unsound, 0xff, sizeof unsound);
    t3r_scene_frame where = {0};
    assert_int_equal(t3r_scene_begin(rt, &where), T3R_OK);
    assert_int_equal(t3r_scene_append(rt, &unsound), T3R_ERR_ARGUMENT);
    assert_int_equal(noted, 0);
}
