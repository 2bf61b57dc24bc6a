/* SPDX-License-Identifier: Apache-2.0 */
#include "study/stress/capture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "reconstruction/developed_frame.h"

bool stress_capture_open(stress_capture *capture, uint32_t width, uint32_t height, uint32_t views, double depth_unit)
{
    size_t pixels = (size_t)width * height;
    *capture = (stress_capture){.width = width, .height = height, .views = views, .depth_unit = depth_unit};
    bool done = true;
    for (uint32_t v = 0; v <= views; v++) {
        capture->view[v].rgb = calloc(pixels, 3);
        capture->view[v].depth = calloc(pixels, sizeof(uint16_t));
        done = done && capture->view[v].rgb != NULL && capture->view[v].depth != NULL;
    }
    return done;
}

void stress_capture_free(stress_capture *capture)
{
    for (uint32_t v = 0; v <= T3R_MAX_VIEWS; v++) {
        free(capture->view[v].rgb);
        free(capture->view[v].depth);
    }
    *capture = (stress_capture){0};
}

bool stress_capture_copy(stress_capture *copy, const stress_capture *capture)
{
    size_t pixels = (size_t)capture->width * capture->height;
    bool done = stress_capture_open(copy, capture->width, capture->height, capture->views, capture->depth_unit);
    for (uint32_t v = 0; v <= capture->views && done; v++) {
        memcpy(copy->view[v].rgb, capture->view[v].rgb, pixels * 3);
        memcpy(copy->view[v].depth, capture->view[v].depth, pixels * sizeof(uint16_t));
        copy->view[v].camera = capture->view[v].camera;
        copy->view[v].colour_only = capture->view[v].colour_only;
    }
    return done;
}

uint32_t stress_capture_valid(const stress_capture *capture)
{
    size_t pixels = (size_t)capture->width * capture->height;
    uint32_t valid = 0;
    for (uint32_t v = 0; v < capture->views; v++) {
        for (size_t i = 0; i < pixels; i++) {
            valid += capture->view[v].depth[i] != 0;
        }
    }
    return valid;
}

/* Converts a fixed-point camera to doubles, exactly. */
static t3r_recorded_camera camera_of(const t3r_camera *camera, uint32_t width, uint32_t height)
{
    t3r_recorded_camera c = {.width = width, .height = height};
    c.fx = camera->fx_q16 * 0x1p-16;
    c.fy = camera->fy_q16 * 0x1p-16;
    c.cx = camera->cx_q16 * 0x1p-16;
    c.cy = camera->cy_q16 * 0x1p-16;
    for (int i = 0; i < 3; i++) {
        c.position[i] = ldexp((double)camera->position_q32[i], -32);
    }
    for (int i = 0; i < 4; i++) {
        c.rotation[i] = camera->rotation_q30[i] * 0x1p-30;
    }
    return c;
}

static int develop(stress_capture *capture, uint32_t v, const t3r_capture_frame *frame, const char *path)
{
    t3r_camera camera;
    capture->view[v].colour_only = frame->frame.depth == NULL;
    uint16_t *depth = capture->view[v].colour_only ? NULL : capture->view[v].depth;
    const int code = developed_capture(frame, path, frame->index, capture->width, capture->height, capture->view[v].rgb,
                                       depth, &camera);
    if (code == CLI_OK) {
        capture->view[v].camera = camera_of(&camera, capture->width, capture->height);
    }
    return code;
}

int stress_capture_read(stress_capture *capture, const evaluation_case *what, const reconstruction_options *settings)
{
    t3r_capture_frame frames[T3R_MAX_VIEWS + 1];
    double depth_unit = 0; /* of the first frame with depth */
    *capture = (stress_capture){0};
    for (uint32_t v = 0; v <= what->context_count; v++) {
        uint32_t index = v < what->context_count ? what->context[v] : what->target;
        int code = recorded_frame_read(what->recording, what->path, index, &frames[v]);
        if (code != CLI_OK) {
            return code;
        }
        if (depth_unit == 0 && frames[v].frame.depth != NULL) {
            depth_unit = ldexp((double)frames[v].frame.depth_unit_q40, -40);
        }
    }
    uint32_t width = settings->config.width != 0 ? settings->config.width : frames[0].frame.width;
    uint32_t height = settings->config.height != 0 ? settings->config.height : frames[0].frame.height;
    if (!stress_capture_open(capture, width, height, what->context_count, depth_unit == 0 ? 1 : depth_unit)) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    int code = CLI_OK;
    for (uint32_t v = 0; v <= what->context_count && code == CLI_OK; v++) {
        code = develop(capture, v, &frames[v], what->path);
    }
    return code;
}

static bool write_frames(const stress_capture *capture, FILE *file, t3r_recorder *recorder)
{
    t3r_recording_header header = {
        .camera = "camera", .source = "perturbed frames", .clock = "synthetic", .depth_unit = capture->depth_unit};
    bool done = t3r_recorder_begin(recorder, t3r_file_sink(file), &header) == 0;
    for (uint32_t v = 0; v <= capture->views && done; v++) {
        const stress_view *view = &capture->view[v];
        t3r_recorded_frame frame = {.stamp_ns = (int64_t)v * 1000000000 / 30,
                                    .format = T3R_PIXEL_RGB24,
                                    .width = capture->width,
                                    .height = capture->height,
                                    .planes = {view->rgb},
                                    .stride_bytes = {capture->width * 3},
                                    .depth = view->colour_only ? NULL : view->depth,
                                    .depth_width = capture->width,
                                    .depth_height = capture->height,
                                    .camera = view->camera};
        done = t3r_recorder_frame(recorder, &frame) == 0;
    }
    return done && t3r_recorder_end(recorder) == 0;
}

t3r_recording *stress_capture_recording(const stress_capture *capture, uint8_t **bytes)
{
    char *memory = NULL, error[512] = "the frames cannot be recorded";
    size_t count = 0;
    t3r_recorder *recorder = malloc(t3r_recorder_bytes());
    FILE *file = recorder == NULL ? NULL : open_memstream(&memory, &count);
    bool done = file != NULL && write_frames(capture, file, recorder);
    done = file != NULL && fclose(file) == 0 && done;
    free(recorder);
    *bytes = (uint8_t *)memory;
    t3r_recording *recording = done ? t3r_recording_parse(*bytes, count, error, sizeof error) : NULL;
    if (recording == NULL) {
        cli_error(CLI_BAD_INPUT, "%s", error);
        free(memory);
        *bytes = NULL;
    }
    return recording;
}
