/* SPDX-License-Identifier: Apache-2.0 */
/* features_driver: prints a line for each feature, of a scene that uses it, and a line of a call that needs it. A
 * library without a feature prints "unsupported" there, and all other lines unchanged. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "consumers/scene.h"
#include "trim3r.h"

static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[4 << 20];

static t3r_config plain_config(void)
{
    t3r_config config = t3r_default_config(SCENE_SIDE, SCENE_SIDE, 1, SCENE_BUDGET);
    /* on by default if the library has the features that they need */
    config.refine = config.fit_widths = config.align = config.rim = 0;
    return config;
}

static void print_scene(const char *name, const t3r_config *config)
{
    uint64_t folded;
    const t3r_status status = fold_scene(config, 0, arena, sizeof arena, &folded);
    if (status == T3R_OK) {
        printf("%s: %016" PRIx64 "\n", name, folded);
    } else if (status == T3R_ERR_UNSUPPORTED) {
        printf("%s: unsupported: %s\n", name, t3r_config_error(config));
    } else {
        printf("%s: %s\n", name, t3r_error_text(status));
    }
}

static void print_scenes(void)
{
    t3r_config config = plain_config();
    print_scene("plain", &config);
    config.views = SCENE_VIEWS;
    print_scene("comparison", &config);
    config.align = 1;
    print_scene("align", &config);
    config.align = 0;
    config.depth = T3R_DEPTH_STEREO;
    print_scene("stereo", &config);
    config = plain_config();
    config.views = SCENE_VIEWS;
    config.stream = 1;
    print_scene("streams", &config);
    config = plain_config();
    config.backdrop = 1;
    print_scene("backdrop", &config);
    config = plain_config();
    config.head = T3R_HEAD_LEARNED;
    print_scene("learned", &config);
    config = plain_config();
    config.refine = 4;
    print_scene("refinement", &config);
    config = plain_config();
    config.allocate = T3R_ALLOCATE_UNIFORM;
    print_scene("allocations", &config);
    config = plain_config();
    config.wavelet = T3R_WAVELET_HAAR;
    print_scene("wavelets", &config);
    config = plain_config();
    config.workers = 2;
    print_scene("workers", &config);
    config.workers = 1;
    config.warm = 1;
    print_scene("warm", &config);
}

static void print_call(const char *name, t3r_status status)
{
    printf("%s, a call: %s\n", name, status == T3R_ERR_UNSUPPORTED ? "unsupported" : t3r_error_text(status));
}

/* Makes a black picture with depth everywhere, and its camera. */
static t3r_frame black_frame(t3r_camera *camera)
{
    static uint8_t colour[SCENE_SIDE * SCENE_SIDE * 3], depth[SCENE_SIDE * SCENE_SIDE * 2];
    const t3r_frame frame = {.format = T3R_PIXEL_RGB24,
                             .width = SCENE_SIDE,
                             .height = SCENE_SIDE,
                             .planes = {colour},
                             .stride_bytes = {SCENE_SIDE * 3},
                             .depth = depth,
                             .depth_width = SCENE_SIDE,
                             .depth_height = SCENE_SIDE,
                             .depth_stride_bytes = SCENE_SIDE * 2,
                             .depth_unit_q40 = 1 << 30};
    *camera = (t3r_camera){.fx_q16 = SCENE_SIDE << 16,
                           .fy_q16 = SCENE_SIDE << 16,
                           .cx_q16 = SCENE_SIDE << 15,
                           .cy_q16 = SCENE_SIDE << 15,
                           .rotation_q30 = {1 << 30}};
    memset(depth, 3, sizeof depth);
    return frame;
}

/* Adds slight distortion to a camera. */
static t3r_camera wide_angle(t3r_camera camera)
{
    camera.distortion = T3R_DISTORTION_RADTAN;
    camera.distortion_q24[0] = 1 << 18;
    return camera;
}

static t3r_status add_wide_angle(t3r_runtime *rt)
{
    t3r_camera camera;
    const t3r_frame frame = black_frame(&camera);
    camera = wide_angle(camera);
    return t3r_add_view(rt, &frame, &camera);
}

/* Prints a line for a refused keyframe of such a lens, after which the map has changed. */
static void print_lost_keyframe(void)
{
    static uint8_t before[sizeof arena];
    t3r_config config = plain_config();
    config.stream = 1;
    config.gate = 0; /* the frame is black */
    t3r_camera camera;
    const t3r_frame frame = black_frame(&camera);
    const t3r_camera lens = wide_angle(camera);
    t3r_runtime *rt;
    if (t3r_init(&rt, arena, sizeof arena, &config) != T3R_OK ||
        t3r_stream_keyframe(rt, &frame, &camera, NULL) != T3R_OK) {
        return; /* no streams */
    }
    memcpy(before, arena, sizeof arena);
    if (t3r_stream_keyframe(rt, &frame, &lens, NULL) == T3R_ERR_UNSUPPORTED &&
        memcmp(before, arena, sizeof arena) != 0) {
        printf("lenses, a keyframe: refused, and the map has changed\n");
    }
}

/* Prints lines of a runtime without views. */
static void print_calls(void)
{
    const t3r_config config = plain_config();
    const t3r_request bounded = {.max_loss_q8 = 256}, random = {.allocate = T3R_ALLOCATE_RANDOM};
    const t3r_frame frame = {0};
    const t3r_camera camera = {0};
    t3r_runtime *rt;
    t3r_scene scene;
    print_call("plain", t3r_init(&rt, arena, sizeof arena, &config));
    print_call("streams", t3r_stream_keyframe(rt, &frame, &camera, NULL));
    print_call("learned", t3r_bind_head(rt, arena, 1));
    print_call("loss", t3r_reconstruct(rt, &bounded, &scene));
    print_call("allocations", t3r_reconstruct(rt, &random, &scene));
    print_call("lenses", add_wide_angle(rt));
}

int main(void)
{
    printf("features %02x, %u passes of refinement\n", (unsigned)t3r_features(),
           (unsigned)t3r_default_config(SCENE_SIDE, SCENE_SIDE, 1, 1).refine);
    print_scenes();
    print_calls();
    print_lost_keyframe();
    return 0;
}
