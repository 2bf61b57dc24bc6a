/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/developed_frame.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "host/cpu.h"
#include "reconstruction/reconstruction_error.h"

int developed_capture(const t3r_capture_frame *frame, const char *path, uint32_t index, uint32_t width, uint32_t height,
                      uint8_t *rgb, uint16_t *depth, t3r_camera *camera)
{
    /* in an arena of its own, because one that holds a scene cannot take frames */
    t3r_config config = t3r_default_config(width, height, 1, 1);
    t3r_runtime *runtime;
    t3r_plan_info plan;
    void *arena = NULL;
    t3r_status status = t3r_plan(&config, &plan);
    if (status != T3R_OK || posix_memalign(&arena, T3R_ARENA_ALIGN, plan.min_bytes) != 0) {
        return status != T3R_OK ? reconstruction_error(status, "image stage", &config, 0)
                                : cli_error(CLI_BAD_INPUT, "out of memory");
    }
    (void)t3r_init(&runtime, arena, plan.min_bytes, &config);
    (void)t3r_set_cpu(runtime, t3r_cpu_features());
    status = t3r_develop(runtime, &frame->frame, &frame->camera, rgb, depth, camera);
    char reason[T3R_ERROR_BYTES];
    const char *const text =
        t3r_develop_error(status, runtime, &frame->frame, &frame->camera, rgb, depth, camera, reason, sizeof reason);
    free(arena);
    return status == T3R_OK ? CLI_OK : cli_error(CLI_BAD_INPUT, "%s: frame %" PRIu32 ": %s", path, index, text);
}

int developed_frame(const t3r_recording *recording, const char *path, uint32_t index, uint32_t width, uint32_t height,
                    uint8_t *rgb, uint16_t *depth, t3r_camera *camera)
{
    t3r_capture_frame frame;
    int code = recorded_frame_read(recording, path, index, &frame);
    return code == CLI_OK ? developed_capture(&frame, path, index, width, height, rgb, depth, camera) : code;
}

/* Develops a white picture with the frame's lens: what stays black is beyond it. */
static int develop_white(const t3r_capture_frame *frame, const char *path, uint32_t index, uint32_t width,
                         uint32_t height, uint8_t *shown)
{
    const size_t row = (size_t)frame->frame.width * 3, bytes = row * frame->frame.height;
    uint8_t *white = malloc(bytes), *rgb = malloc((size_t)width * height * 3);
    int code = CLI_OK;
    if (white == NULL || rgb == NULL) {
        code = cli_error(CLI_BAD_INPUT, "out of memory");
    } else {
        t3r_camera camera;
        t3r_capture_frame blank = {.camera = frame->camera};
        blank.frame = (t3r_frame){.format = T3R_PIXEL_RGB24,
                                  .width = frame->frame.width,
                                  .height = frame->frame.height,
                                  .planes = {memset(white, 255, bytes)},
                                  .stride_bytes = {(uint32_t)row}};
        code = developed_capture(&blank, path, index, width, height, rgb, NULL, &camera);
    }
    for (size_t i = 0; code == CLI_OK && i < (size_t)width * height; i++) {
        shown[i] = rgb[3 * i] != 0 ? 255 : 0;
    }
    free(rgb);
    free(white);
    return code;
}

int developed_shown(const t3r_capture_frame *frame, const char *path, uint32_t index, uint32_t width, uint32_t height,
                    uint8_t *shown)
{
    if (frame->camera.distortion == T3R_DISTORTION_NONE) {
        memset(shown, 255, (size_t)width * height);
        return CLI_OK;
    }
    return develop_white(frame, path, index, width, height, shown);
}
