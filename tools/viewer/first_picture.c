/* SPDX-License-Identifier: Apache-2.0 */
#include "viewer/first_picture.h"

#include <stdlib.h>

#include "host/cpu.h"
#include "pictures/png_bytes.h"
#include "reconstruction/reconstruction.h"
#include "scene/scene_append.h"

#define WIDEST 320u

static t3r_status draw(const scene_file *scene, const t3r_config *config, void *arena, size_t arena_bytes,
                       const scene_eye *eye, uint8_t *rgb)
{
    const t3r_target target = {
        .width = eye->width, .height = eye->height, .rgb = rgb, .rgb_stride_bytes = eye->width * 3};
    t3r_runtime *runtime;
    uint32_t refused;
    t3r_status status = t3r_init(&runtime, arena, arena_bytes, config);
    status = status == T3R_OK ? t3r_set_cpu(runtime, t3r_cpu_features()) : status;
    status = status == T3R_OK ? scene_append_all(runtime, scene, eye, &refused) : status;
    return status == T3R_OK ? t3r_render(runtime, eye->camera, &target) : status;
}

uint8_t *first_picture_png(const bundle *data, const t3r_camera *camera, size_t *count)
{
    const uint32_t whole_width = data->config.width, whole_height = data->config.height;
    const uint32_t width = whole_width < WIDEST ? whole_width : WIDEST;
    const uint32_t scaled = (whole_height * width + whole_width / 2) / whole_width;
    const uint32_t height = scaled < T3R_MIN_SIDE ? T3R_MIN_SIDE : scaled;
    const t3r_camera smaller = reconstruction_camera(camera, whole_width, whole_height, width, height);
    const scene_eye eye = {&smaller, width, height};
    const t3r_config config = t3r_default_config(width, height, 0, data->scene->count);
    t3r_plan_info plan;
    void *arena = NULL;
    *count = 0;
    uint8_t *png = NULL, *rgb = malloc((size_t)width * height * 3);
    if (rgb != NULL && t3r_plan(&config, &plan) == T3R_OK && posix_memalign(&arena, T3R_ARENA_ALIGN, plan.bytes) == 0 &&
        draw(data->scene, &config, arena, plan.bytes, &eye, rgb) == T3R_OK) {
        png = png_bytes(width, height, 3, rgb, count);
    }
    free(arena);
    free(rgb);
    return png;
}
