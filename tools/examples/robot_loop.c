/* SPDX-License-Identifier: Apache-2.0 */
/* The loop of a robot: all memory of its map is one block of guaranteed size. Two frames at a time become as many
 * Gaussians as fit, and the map shows how far ahead the way is clear. Nothing is allocated once the camera is open, no
 * number is a float, and the size of the map is fixed at compile time:
 *
 *     cc -DROBOT_BYTES=589824 ...      less room: fewer Gaussians; too little: an error of the compiler */
#include <inttypes.h>
#include <stdio.h>

#include "trim3r_host.h"

#ifndef ROBOT_BYTES
#define ROBOT_BYTES (1 << 20)
#endif

enum { SIDE = 128, VIEWS = 2 };

static struct {
    _Alignas(T3R_ARENA_ALIGN) uint8_t arena[ROBOT_BYTES - sizeof(uint32_t[SIDE][SIDE])];
    uint32_t depth_q20[SIDE][SIDE]; /* depth ahead, in scene units */
} memory;
_Static_assert(sizeof memory <= ROBOT_BYTES, "ROBOT_BYTES must be a multiple of T3R_ARENA_ALIGN");

#define FITS(gaussians) (T3R_ARENA_MIN_BYTES(SIDE, SIDE, VIEWS, gaussians) <= sizeof memory.arena)
enum { LEAST = 512, GAUSSIANS = FITS(8192) ? 8192 : FITS(4096) ? 4096 : FITS(2048) ? 2048 : FITS(1024) ? 1024 : LEAST };
_Static_assert(FITS(LEAST), "ROBOT_BYTES have no room for any map");

static const t3r_target ahead = {SIDE, SIDE, .depth_q20 = &memory.depth_q20[0][0],
                                 .depth_stride_bytes = sizeof memory.depth_q20[0]};

/* Reports an unusable frame, which is skipped: the next one follows soon. */
static bool fine(t3r_status status, uint32_t frame)
{
    if (status != T3R_OK) {
        printf("frame %" PRIu32 ": %s\n", frame, t3r_error_text(status));
    }
    return status == T3R_OK;
}

/* Gets the camera of a frame: a recording has it; live, ask your odometry. */
static bool locate(t3r_capture_frame *frame)
{
    return frame->has_pose && frame->has_intrinsics;
}

/* Returns the distance of the nearest surface in the middle third of the view, in thousandths of world units; 0: there
 * is none. */
static uint64_t clear_way(const t3r_scene_frame *frame)
{
    uint32_t nearest = UINT32_MAX;
    for (int y = SIDE / 3; y < 2 * SIDE / 3; y++) {
        for (int x = SIDE / 3; x < 2 * SIDE / 3; x++) {
            const uint32_t depth = memory.depth_q20[y][x];
            nearest = depth != 0 && depth < nearest ? depth : nearest;
        }
    }
    /* a scene unit is 2^exponent world units; in metres, far fewer than 2^20 of them */
    return nearest == UINT32_MAX ? 0 : (uint64_t)nearest * 1000 >> (20 - frame->exponent);
}

static void look_ahead(t3r_runtime *rt, const t3r_camera *here, uint32_t index)
{
    t3r_camera eye = *here; /* its pose, and a lens of 60 degrees */
    eye.width = eye.height = SIDE;
    eye.fx_q16 = eye.fy_q16 = (int32_t)(INT64_C(56756) * SIDE);
    eye.cx_q16 = eye.cy_q16 = (SIDE - 1) << 15;
    eye.distortion = T3R_DISTORTION_NONE;
    t3r_scene scene;
    if (!fine(t3r_reconstruct(rt, NULL, &scene), index) || !fine(t3r_render(rt, &eye, &ahead), index)) {
        return;
    }
    const uint64_t mm = clear_way(&scene.frame);
    printf("frame %" PRIu32 ": %" PRIu32 " Gaussians, ", index, scene.count);
    if (mm == 0) {
        printf("nothing in sight\n");
    } else {
        printf("%" PRIu64 ".%03" PRIu64 " m ahead\n", mm / 1000, mm % 1000);
    }
}

int main(int argc, char **argv)
{
    char error[512] = "usage: robot_loop SOURCE";
    t3r_capture *source = argc == 2 ? t3r_capture_open(argv[1], NULL, error, sizeof error) : NULL;
    if (source == NULL) {
        printf("%s\n", error);
        return 1;
    }
    t3r_config config = t3r_default_config(SIDE, SIDE, VIEWS, GAUSSIANS);
    config.rim = 0; /* nothing where no camera looked */
    t3r_runtime *rt;
    if (!fine(t3r_init(&rt, memory.arena, sizeof memory.arena, &config), 0) ||
        !fine(t3r_set_cpu(rt, t3r_cpu_features()), 0)) {
        return 1;
    }
    t3r_capture_frame frame;
    int got, views = 0;
    while ((got = t3r_capture_next(source, &frame)) != T3R_CAPTURE_END && got != T3R_CAPTURE_LOST) {
        if (got == T3R_CAPTURE_FRAME) {
            views += fine(locate(&frame) ? t3r_add_view(rt, &frame.frame, &frame.camera) : T3R_ERR_CAMERA, frame.index);
        } else if (got == T3R_CAPTURE_FAILED) {
            printf("%s\n", t3r_capture_error(source));
        }
        if (views == VIEWS) {
            look_ahead(rt, &frame.camera, frame.index);
            views = fine(t3r_reset(rt), frame.index) ? 0 : views;
        }
    }
    if (got != T3R_CAPTURE_END) {
        printf("%s: stop\n", t3r_capture_error(source)); /* without images the robot stops */
    }
    t3r_capture_close(source);
    return got == T3R_CAPTURE_END ? 0 : 1;
}
