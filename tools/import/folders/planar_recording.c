/* SPDX-License-Identifier: Apache-2.0 */
#include "import/folders/planar_recording.h"

#include <math.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "import/frames/frame.h"

#define PLANE_STEPS 2000u /* in thousandths of a unit: two units away */

static t3r_recorded_camera plane_camera(uint32_t width, uint32_t height)
{
    return (t3r_recorded_camera){.width = width,
                                 .height = height,
                                 .fx = width,
                                 .fy = width,
                                 .cx = (width - 1) / 2.0,
                                 .cy = (height - 1) / 2.0,
                                 .rotation = {1, 0, 0, 0}};
}

/* Writes one frame to a recording in memory; returns NULL when memory is out. */
static uint8_t *record(const t3r_recorded_frame *frame, size_t *count)
{
    char *bytes = NULL;
    t3r_recording_header header = {
        .camera = "planar", .source = "one image", .clock = "synthetic", .depth_unit = 0.001};
    t3r_recorder *recorder = malloc(t3r_recorder_bytes());
    FILE *file = recorder == NULL ? NULL : open_memstream(&bytes, count);
    if (file == NULL) {
        free(recorder);
        return NULL;
    }
    int failed = t3r_recorder_begin(recorder, t3r_file_sink(file), &header) != 0 ||
                 t3r_recorder_frame(recorder, frame) != 0 || t3r_recorder_end(recorder) != 0;
    failed |= fclose(file) != 0;
    free(recorder);
    if (failed) {
        free(bytes);
        return NULL;
    }
    return (uint8_t *)bytes;
}

static uint8_t *record_plane(t3r_recorded_frame *frame, size_t *count)
{
    size_t pixels = (size_t)frame->width * frame->height;
    uint16_t *depth = malloc(pixels * sizeof *depth);
    if (depth == NULL) {
        return NULL;
    }
    for (size_t i = 0; i < pixels; i++) {
        depth[i] = PLANE_STEPS;
    }
    frame->depth = depth;
    frame->depth_width = frame->width;
    frame->depth_height = frame->height;
    frame->camera = plane_camera(frame->width, frame->height);
    uint8_t *bytes = record(frame, count);
    free(depth);
    return bytes;
}

t3r_recording *planar_recording(char *path, uint32_t width, uint32_t height, uint8_t **bytes)
{
    /* import requires a camera; record_plane() replaces this one */
    posed_frame posed = {
        .image = path,
        .intrinsics =
            {.width = NAN, .height = NAN, .fx = NAN, .fy = NAN, .cx = NAN, .cy = NAN, .angle_x = 0.5, .angle_y = NAN},
        .pose = {.rotation = {1, 0, 0, 0}}};
    import_buffers buffers;
    t3r_recorded_frame frame;
    t3r_recording *recording = NULL;
    char error[512] = "out of memory";
    size_t count = 0;
    *bytes = NULL;
    if (import_frame("", &posed, NULL, width, height, &buffers, &frame, error, sizeof error) == 0) {
        *bytes = record_plane(&frame, &count);
    }
    import_buffers_free(&buffers);
    if (*bytes != NULL) {
        recording = t3r_recording_parse(*bytes, count, error, sizeof error);
    }
    if (recording == NULL) {
        cli_error(CLI_BAD_INPUT, "%s", error);
        free(*bytes);
        *bytes = NULL;
    }
    return recording;
}
