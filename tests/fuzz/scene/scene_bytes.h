/* SPDX-License-Identifier: Apache-2.0 */
/* Any bytes as a scene file: an error, or a scene that the runtime accepts as a whole and draws. */
#ifndef T3R_TESTS_FUZZ_SCENE_BYTES_H
#define T3R_TESTS_FUZZ_SCENE_BYTES_H

#include <stdint.h>
#include <stdlib.h>

#include "scene/scene_append.h"
#include "scene/scene_file.h"
#include "trim3r.h"

static inline void fuzz_draw(scene_file *scene)
{
    enum { MOST = 64 };
    static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[T3R_ARENA_MIN_BYTES(T3R_MIN_SIDE, T3R_MIN_SIDE, 0, MOST)];
    t3r_config config = t3r_default_config(T3R_MIN_SIDE, T3R_MIN_SIDE, 0, MOST);
    t3r_camera camera = {
        .fx_q16 = 8 << 16, .fy_q16 = 8 << 16, .cx_q16 = 4 << 16, .cy_q16 = 4 << 16, .rotation_q30 = {1 << 30, 0, 0, 0}};
    for (int axis = 0; axis < 3; axis++) {
        camera.position_q32[axis] = scene->frame.origin_q32[axis];
    }
    uint8_t rgb[T3R_MIN_SIDE * T3R_MIN_SIDE * 3];
    t3r_target target = {
        .width = T3R_MIN_SIDE, .height = T3R_MIN_SIDE, .rgb = rgb, .rgb_stride_bytes = 3 * T3R_MIN_SIDE};
    t3r_runtime *runtime;
    uint32_t index;
    scene->count = scene->count < MOST ? scene->count : MOST;
    if (t3r_init(&runtime, arena, sizeof arena, &config) != T3R_OK ||
        scene_append_all(runtime, scene, &(scene_eye){&camera, T3R_MIN_SIDE, T3R_MIN_SIDE}, &index) != T3R_OK ||
        t3r_render(runtime, &camera, &target) != T3R_OK) {
        abort();
    }
}

static inline int fuzz_scene(const char *name, const uint8_t *data, size_t size)
{
    scene_file scene;
    char error[256] = "";
    if (scene_file_parse(name, data, size, 0, &scene, error, sizeof error) != 0) {
        if (error[0] == '\0' || scene.gaussians != NULL || scene.harmonics_q12 != NULL) {
            abort();
        }
        return 0;
    }
    if (scene.count == 0 || scene.gaussians == NULL || (scene.degree > 0) != (scene.harmonics_q12 != NULL)) {
        abort();
    }
    fuzz_draw(&scene);
    scene_file_free(&scene);
    return 0;
}

#endif
