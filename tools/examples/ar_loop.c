/* SPDX-License-Identifier: Apache-2.0 */
/* The loop of AR glasses: every frame becomes Gaussians as it arrives, and these are drawn from where the head will be
 * when the next frame arrives. Prints a line per frame on stderr, and the views on stdout as consecutive PPM pictures:
 *
 *     trim3r room --frames 60 -o room.mcap
 *     ar_loop replay:room.mcap | ffplay -f image2pipe -c:v ppm -
 *
 * The same works with v4l2:, libcamera: and opencv:, once locate() asks your tracker. */
#include <inttypes.h>
#include <stdio.h>
#include <unistd.h>

#include "trim3r_heads.h"
#include "trim3r_host.h"

enum { SIDE = 256, GAUSSIANS = 6000 };

static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[T3R_ARENA_BYTES(SIDE, SIDE, 1, GAUSSIANS)];
static uint8_t view[SIDE][SIDE][3];

static const t3r_target display = {SIDE, SIDE, .rgb = &view[0][0][0], .rgb_stride_bytes = sizeof view[0]};
static const int32_t focal_q16 = (int32_t)(0.8660254 * SIDE * 65536); /* 60 degrees wide */

/* Waits for the next frame; false: there are no more. */
static bool next_frame(t3r_capture *source, t3r_capture_frame *frame)
{
    int got;
    do {
        got = t3r_capture_next(source, frame);
        if (got == T3R_CAPTURE_FAILED || got == T3R_CAPTURE_LOST) {
            fprintf(stderr, "%s\n", t3r_capture_error(source));
        }
        if (got == T3R_CAPTURE_LOST && t3r_capture_reopen(source) != T3R_CAPTURE_FRAME) {
            sleep(1); /* until it is plugged in again */
        }
    } while (got != T3R_CAPTURE_FRAME && got != T3R_CAPTURE_END);
    return got == T3R_CAPTURE_FRAME;
}

/* Gets the camera of a frame: a recording has it; live, ask your tracker. */
static bool locate(t3r_capture_frame *frame)
{
    return frame->has_pose && frame->has_intrinsics;
}

/* Predicts the display's camera one frame later, by repeating the motion from the last frame to this one. */
static t3r_camera foresee(const t3r_camera *last, const t3r_camera *now)
{
    t3r_camera next = {
        SIDE, SIDE, focal_q16, focal_q16, (SIDE - 1) << 15, (SIDE - 1) << 15, .distortion = T3R_DISTORTION_NONE};
    double dot = 0; /* negative: the last rotation is nearer as -q, which is the same rotation */
    for (int i = 0; i < 4; i++) {
        dot += (double)last->rotation_q30[i] * now->rotation_q30[i];
    }
    for (int i = 0; i < 4; i++) { /* 2/3 keeps the length within 0.5 to 1.5: the runtime normalises */
        const int64_t from = dot < 0 ? -(int64_t)last->rotation_q30[i] : last->rotation_q30[i];
        next.rotation_q30[i] = (int32_t)((2 * (int64_t)now->rotation_q30[i] - from) * 2 / 3);
    }
    for (int i = 0; i < 3; i++) {
        next.position_q32[i] = 2 * now->position_q32[i] - last->position_q32[i];
    }
    return next;
}

static t3r_status start(t3r_runtime **rt)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, 1, GAUSSIANS);
    config.head = T3R_HEAD_LEARNED;
    t3r_status status = t3r_init(rt, arena, sizeof arena, &config);
    status = status == T3R_OK ? t3r_set_cpu(*rt, t3r_cpu_features()) : status;
    return status == T3R_OK ? t3r_bind_head(*rt, t3r_head_small, t3r_head_small_bytes) : status;
}

static t3r_status build_and_draw(t3r_runtime *rt, const t3r_capture_frame *frame, const t3r_camera *viewpoint)
{
    t3r_scene scene;
    t3r_status status = t3r_reset(rt);
    status = status == T3R_OK ? t3r_add_view(rt, &frame->frame, &frame->camera) : status;
    status = status == T3R_OK ? t3r_reconstruct(rt, NULL, &scene) : status;
    return status == T3R_OK ? t3r_render(rt, viewpoint, &display) : status;
}

int main(int argc, char **argv)
{
    char error[512] = "usage: ar_loop SOURCE >VIEWS.ppm";
    t3r_runtime *rt;
    t3r_status status = start(&rt);
    t3r_capture *source = argc == 2 ? t3r_capture_open(argv[1], NULL, error, sizeof error) : NULL;
    if (source == NULL || status != T3R_OK) {
        fprintf(stderr, "%s\n", source == NULL ? error : t3r_error_text(status));
        return 1;
    }
    t3r_capture_frame frame;
    t3r_camera last = {0};
    for (bool moving = false; next_frame(source, &frame);) {
        if (!locate(&frame)) {
            fprintf(stderr, "frame %" PRIu32 ": %s\n", frame.index, t3r_error_text(T3R_ERR_CAMERA));
            continue;
        }
        const t3r_camera ahead = foresee(moving ? &last : &frame.camera, &frame.camera);
        status = build_and_draw(rt, &frame, &ahead);
        fprintf(stderr, "frame %" PRIu32 ": %s\n", frame.index, status == T3R_OK ? "shown" : t3r_error_text(status));
        if (status == T3R_OK) {
            printf("P6\n%d %d\n255\n", SIDE, SIDE);
            fwrite(view, sizeof view, 1, stdout);
            fflush(stdout);
        }
        last = frame.camera;
        moving = true;
    }
    t3r_capture_close(source);
    return 0;
}
