/* SPDX-License-Identifier: Apache-2.0 */
/* Depth by stereo of pictures tall enough for blocks of 8, 16, 32 and 64 rows: a wall two metres away. */
#include "unit/unit.h"

#include "rgbd_frame.h"

enum { W = 48, SHIFT = 4, BUDGET = 200 };

/* Adds a camera `index` eighths of a metre to the right, which sees the wall 4 pixels further to the left. */
static void add(t3r_runtime *rt, uint32_t height, uint32_t index, const uint8_t *wall, uint8_t *rgb)
{
    const t3r_camera camera = {.fx_q16 = 64 << 16,
                               .fy_q16 = (int32_t)height << 16,
                               .cx_q16 = (W - 1) << 15,
                               .cy_q16 = (int32_t)(height - 1) << 15,
                               .position_q32 = {(int64_t)index << 29},
                               .rotation_q30 = {1 << 30}};
    for (uint32_t i = 0; i < W * height; i++) {
        const uint8_t colour = wall[i / W * (W + SHIFT) + i % W + SHIFT * index];
        rgb[3 * i] = rgb[3 * i + 1] = rgb[3 * i + 2] = colour;
    }
    const t3r_frame frame = rgbd_frame(rgb, NULL, W, height, 1);
    assert_int_equal(t3r_add_view(rt, &frame, &camera), T3R_OK);
}

TEST(every_height_of_blocks)
{
    static const uint32_t heights[] = {64, 200, 520, 1700};
    for (size_t h = 0; h < sizeof heights / sizeof heights[0]; h++) {
        const uint32_t height = heights[h];
        t3r_config config = t3r_default_config(W, height, 2, BUDGET);
        config.depth = T3R_DEPTH_STEREO;
        config.refine = 0;
        t3r_plan_info plan;
        assert_int_equal(t3r_plan(&config, &plan), T3R_OK);
        void *arena = aligned_alloc(T3R_ARENA_ALIGN, plan.bytes / T3R_ARENA_ALIGN * T3R_ARENA_ALIGN + T3R_ARENA_ALIGN);
        assert_non_null(arena);
        t3r_runtime *rt;
        assert_int_equal(t3r_init(&rt, arena, plan.bytes, &config), T3R_OK);
        uint64_t seed = 9;
        uint8_t *wall = unit_array((size_t)(W + SHIFT) * height, 1), *rgb = unit_array((size_t)W * height, 3);
        for (uint32_t i = 0; i < (W + SHIFT) * height; i++) {
            wall[i] = (uint8_t)unit_between(&seed, 20, 235);
        }
        add(rt, height, 0, wall, rgb);
        add(rt, height, 1, wall, rgb);
        t3r_scene scene;
        assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
        assert_int_equal(scene.count, BUDGET);
        uint32_t right = 0;
        for (uint32_t i = 0; i < BUDGET; i++) {
            const double z = ldexp(scene.gaussians[i].position_q20[2], scene.frame.exponent - 20);
            right += fabs(z - 2) < 0.1;
        }
        print_message("%u rows: %u of %u\n", height, right, BUDGET);
        assert_true(right > BUDGET * 3 / 4);
        free(rgb);
        free(wall);
        free(arena);
    }
}
