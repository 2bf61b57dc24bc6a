/* SPDX-License-Identifier: Apache-2.0 */
#include "scene.h"

#include "trim3r.h"
#include "trim3r_heads.h"

enum { SIDE = SCENE_SIDE, VIEWS = SCENE_VIEWS, BUDGET = SCENE_BUDGET };

static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[T3R_ARENA_BYTES(SIDE, SIDE, VIEWS, BUDGET)];
static uint8_t colour[SIDE][SIDE][3], depth[SIDE][SIDE][2], view[SIDE][SIDE][3];

/* FNV-1a by words of 64 bits. */
static void fold(void *user, t3r_stage stage, uint64_t hash)
{
    uint64_t *folded = user;
    *folded = (*folded ^ hash ^ (uint64_t)stage) * UINT64_C(1099511628211);
}

/* Draws a leaning wall with squares and spots, seen from `shift` pixels further to the right. */
static void draw_wall(int shift)
{
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            const int millimetres = 1500 + 8 * y;
            const uint32_t speck = (uint32_t)((x + shift) * 73 + y * 151) * 2654435761u >> 24;
            colour[y][x][0] = (uint8_t)speck;
            colour[y][x][1] = (uint8_t)((x + shift) / 8 % 2 == y / 8 % 2 ? 200 : 40);
            colour[y][x][2] = 120;
            depth[y][x][0] = (uint8_t)millimetres;
            depth[y][x][1] = (uint8_t)(millimetres >> 8);
        }
    }
}

/* Adds context views, or keyframes of a stream. */
static t3r_status add_views(t3r_runtime *rt, const t3r_config *config, t3r_camera *camera)
{
    const t3r_frame frame = {.format = T3R_PIXEL_RGB24,
                             .width = SIDE,
                             .height = SIDE,
                             .planes = {&colour[0][0][0]},
                             .stride_bytes = {SIDE * 3},
                             .depth = &depth[0][0][0],
                             .depth_width = SIDE,
                             .depth_height = SIDE,
                             .depth_stride_bytes = SIDE * 2,
                             .depth_unit_q40 = 1099511628};
    t3r_status status = T3R_OK;
    for (uint32_t v = 0; v < config->views && status == T3R_OK; v++) {
        draw_wall(4 * (int)v);
        status = config->stream ? t3r_stream_keyframe(rt, &frame, camera, 0) : t3r_add_view(rt, &frame, camera);
        camera->position_q32[0] += INT64_C(1) << 29; /* 12.5 cm to the right */
    }
    return status;
}

t3r_status fold_scene(const t3r_config *config, uint32_t cpu, void *memory, size_t bytes, uint64_t *folded)
{
    const t3r_hooks hooks = {.user = folded, .stage_hash = fold};
    const t3r_target target = {.width = SIDE, .height = SIDE, .rgb = &view[0][0][0], .rgb_stride_bytes = SIDE * 3};
    t3r_camera camera = {.fx_q16 = SIDE << 16,
                         .fy_q16 = SIDE << 16,
                         .cx_q16 = (SIDE - 1) << 15,
                         .cy_q16 = (SIDE - 1) << 15,
                         .rotation_q30 = {1 << 30}};
    t3r_runtime *rt;
    t3r_scene scene;
    *folded = UINT64_C(14695981039346656037);
    t3r_status status = t3r_init(&rt, memory, bytes, config);
    if (status == T3R_OK) {
        status = t3r_set_cpu(rt, cpu);
    }
    if (status == T3R_OK) {
        status = t3r_set_hooks(rt, &hooks);
    }
    if (status == T3R_OK && config->head == T3R_HEAD_LEARNED) {
        status = t3r_bind_head(rt, t3r_head_small, t3r_head_small_bytes);
    }
    if (status == T3R_OK) {
        status = add_views(rt, config, &camera);
    }
    if (status == T3R_OK && !config->stream) {
        status = t3r_reconstruct(rt, 0, &scene);
    }
    return status == T3R_OK ? t3r_render(rt, &camera, &target) : status;
}

uint64_t build_scene(uint32_t cpu)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, VIEWS, BUDGET);
    config.head = T3R_HEAD_LEARNED;
    uint64_t folded;
    const t3r_status status = fold_scene(&config, cpu, arena, sizeof arena, &folded);
    return status == T3R_OK ? folded : (uint64_t)status;
}
