/* SPDX-License-Identifier: Apache-2.0 */
/* References for the training's float copies, for runtime.py: footprints from a head's outputs, and a picture
 * reconstructed by the runtime with the shipped `small` and drawn again. */
#include <stdlib.h>
#include <string.h>

#include "head/head_learned.c" /* uses its footprint_of() */
#include "trim3r_heads.h"

typedef struct tie_settings {
    uint32_t gaussians, allocate, gamma_q8, clusters, cluster_batches, seed, refine;
} tie_settings;

/* Computes footprints of `count` pixels. outputs: [count][T3R_HEAD_OUTPUTS]; spacing_q12 [count]; own colours, three
 * planes of [count] levels. made: [count][9], offset x, y and covariance xx, xy, yy Q12, opacity Q15, red, green, blue
 * Q7. */
void tie_footprints(uint32_t count, const int16_t *outputs, const uint32_t *spacing_q12, uint8_t *own, int32_t *made)
{
    t3r_view view = {.width = count, .height = 1, .colour = {own, own + count, own + 2 * (size_t)count}};
    for (uint32_t i = 0; i < count; i++) {
        t3r_footprint f = footprint_of(outputs + (size_t)T3R_HEAD_OUTPUTS * i, spacing_q12[i], &view, i);
        const int32_t row[9] = {f.offset_q12[0], f.offset_q12[1], f.xx_q12,       f.xy_q12,      f.yy_q12,
                                f.opacity_q15,   f.colour_q7[0],  f.colour_q7[1], f.colour_q7[2]};
        memcpy(made + (size_t)9 * i, row, sizeof row);
    }
}

static t3r_status draw_on_plane(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, uint8_t *drawn)
{
    t3r_scene scene;
    t3r_target target = {
        .width = frame->width, .height = frame->height, .rgb = drawn, .rgb_stride_bytes = 3 * frame->width};
    t3r_status status = t3r_bind_head(rt, t3r_head_small, t3r_head_small_bytes);
    status = status == T3R_OK ? t3r_add_view(rt, frame, camera) : status;
    status = status == T3R_OK ? t3r_reconstruct(rt, NULL, &scene) : status;
    return status == T3R_OK ? t3r_render(rt, camera, &target) : status;
}

/* Reconstructs the picture rgb, [height][width][3], on a plane two metres away, and draws it from the same camera into
 * `drawn`, likewise. intrinsics: fx, fy, cx, cy. */
int32_t tie_draw(uint32_t width, uint32_t height, const uint8_t *rgb, const double *intrinsics,
                 const tie_settings *settings, uint8_t *drawn)
{
    t3r_config config = t3r_default_config(width, height, 1, settings->gaussians);
    config.allocate = (t3r_allocation)settings->allocate;
    config.gamma_q8 = settings->gamma_q8;
    config.clusters = settings->clusters;
    config.cluster_batches = settings->cluster_batches;
    config.seed = settings->seed;
    config.head = T3R_HEAD_LEARNED;
    config.refine = settings->refine;
    t3r_plan_info plan;
    t3r_status status = t3r_plan(&config, &plan);
    if (status != T3R_OK) {
        return status;
    }
    size_t bytes = (plan.bytes + T3R_ARENA_ALIGN - 1) / T3R_ARENA_ALIGN * T3R_ARENA_ALIGN;
    void *arena = aligned_alloc(T3R_ARENA_ALIGN, bytes);
    uint8_t *depth = malloc((size_t)2 * width * height);
    t3r_runtime *rt;
    t3r_frame frame = {.format = T3R_PIXEL_RGB24,
                       .width = width,
                       .height = height,
                       .planes = {rgb},
                       .stride_bytes = {3 * width},
                       .depth = depth,
                       .depth_width = width,
                       .depth_height = height,
                       .depth_stride_bytes = 2 * width,
                       .depth_unit_q40 = 1099511628};
    t3r_camera camera = {.fx_q16 = (int32_t)(intrinsics[0] * 65536),
                         .fy_q16 = (int32_t)(intrinsics[1] * 65536),
                         .cx_q16 = (int32_t)(intrinsics[2] * 65536),
                         .cy_q16 = (int32_t)(intrinsics[3] * 65536),
                         .rotation_q30 = {1 << 30, 0, 0, 0}};
    status = T3R_ERR_ARENA;
    if (arena != NULL && depth != NULL) {
        for (size_t i = 0; i < (size_t)width * height; i++) {
            depth[2 * i] = 2000 & 255;
            depth[2 * i + 1] = 2000 >> 8;
        }
        status = t3r_init(&rt, arena, bytes, &config);
        status = status == T3R_OK ? draw_on_plane(rt, &frame, &camera, drawn) : status;
    }
    free(depth);
    free(arena);
    return status;
}
