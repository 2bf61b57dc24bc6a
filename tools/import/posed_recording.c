#include "import/posed_recording.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bytes.h"
#include "cli/cli.h"
#include "reason.h"

/* Exact: fixed point of at most 53 bits. */
static t3r_recorded_camera camera_of(const t3r_capture_frame *frame)
{
    const t3r_camera *in = &frame->camera;
    t3r_recorded_camera out = {.width = frame->frame.width,
                               .height = frame->frame.height,
                               .fx = ldexp(in->fx_q16, -16),
                               .fy = ldexp(in->fy_q16, -16),
                               .cx = ldexp(in->cx_q16, -16),
                               .cy = ldexp(in->cy_q16, -16),
                               .distortion = in->distortion};
    for (int i = 0; i < 5; i++) {
        out.coefficients[i] = ldexp(in->distortion_q24[i], -24);
    }
    for (int i = 0; i < 3; i++) {
        out.position[i] = ldexp((double)in->position_q32[i], -32);
    }
    for (int i = 0; i < 4; i++) {
        out.rotation[i] = ldexp(in->rotation_q30[i], -30);
    }
    return out;
}

/* Rows without gaps, host order; NULL when memory is out. */
static uint16_t *depth_of(const t3r_frame *frame)
{
    uint16_t *out = malloc((size_t)frame->depth_width * frame->depth_height * sizeof *out);
    for (uint32_t y = 0; y < frame->depth_height && out != NULL; y++) {
        const uint8_t *row = frame->depth + (size_t)y * frame->depth_stride_bytes;
        for (uint32_t x = 0; x < frame->depth_width; x++) {
            out[(size_t)y * frame->depth_width + x] = t3r_load_le16(row + 2 * x);
        }
    }
    return out;
}

static int write_frame(t3r_recorder *recorder, const t3r_recording *recording, uint32_t index, char *error,
                       size_t error_bytes)
{
    t3r_capture_frame frame;
    char why[256] = "";
    if (t3r_recording_frame(recording, index, &frame, why, sizeof why) != T3R_CAPTURE_FRAME) {
        return t3r_reason(error, error_bytes, "frame %u: %s", index, why);
    }
    t3r_recorded_frame out = {.stamp_ns = frame.stamp_ns,
                              .format = frame.frame.format,
                              .width = frame.frame.width,
                              .height = frame.frame.height,
                              .camera = camera_of(&frame)};
    memcpy(out.planes, frame.frame.planes, sizeof out.planes);
    memcpy(out.stride_bytes, frame.frame.stride_bytes, sizeof out.stride_bytes);
    uint16_t *depth = NULL;
    if (frame.frame.depth != NULL) {
        out.depth = depth = depth_of(&frame.frame);
        out.depth_width = frame.frame.depth_width;
        out.depth_height = frame.frame.depth_height;
        if (depth == NULL) {
            return t3r_reason(error, error_bytes, "out of memory");
        }
    }
    int status = t3r_recorder_frame(recorder, &out);
    free(depth);
    return status == 0 ? 0 : t3r_reason(error, error_bytes, "frame %u cannot be written", index);
}

/* Of the first frame with depth. */
static double depth_unit_of(const t3r_recording *recording)
{
    t3r_capture_frame frame;
    char why[16];
    for (uint32_t i = 0; i < t3r_recording_frame_count(recording); i++) {
        if (t3r_recording_frame(recording, i, &frame, why, sizeof why) == T3R_CAPTURE_FRAME &&
            frame.frame.depth != NULL) {
            return ldexp((double)frame.frame.depth_unit_q40, -40);
        }
    }
    return 0.001;
}

int posed_recording_write(const t3r_recording *recording, const char *source, const recording_options *stored,
                          FILE *stream, char *error, size_t error_bytes)
{
    uint32_t frames = t3r_recording_frame_count(recording), count = t3r_recording_triplet_count(recording);
    t3r_triplet *triplets = malloc((count + 1) * sizeof *triplets);
    t3r_recorder *recorder = malloc(t3r_recorder_bytes());
    int status = triplets != NULL && recorder != NULL ? 0 : t3r_reason(error, error_bytes, "out of memory");
    for (uint32_t i = 0; i < count && status == 0; i++) {
        triplets[i] = t3r_recording_triplet(recording, i);
    }
    t3r_recording_header header = {.camera = "camera",
                                   .source = source,
                                   .clock = t3r_recording_clock(recording),
                                   .depth_unit = depth_unit_of(recording),
                                   .triplets = triplets,
                                   .triplet_count = count};
    if (status == 0 && recording_options_apply(stored, &header) != 0) {
        status = t3r_reason(error, error_bytes, "out of memory");
    }
    if (status == 0 && t3r_recorder_begin(recorder, t3r_file_sink(stream), &header) != 0) {
        status = t3r_reason(error, error_bytes, "cannot be written");
    }
    for (uint32_t i = 0; i < frames && status == 0; i++) {
        cli_progress("writing", i, frames);
        status = write_frame(recorder, recording, i, error, error_bytes);
    }
    if (status == 0 && t3r_recorder_end(recorder) != 0) {
        status = t3r_reason(error, error_bytes, "cannot be written");
    }
    t3r_chunk_packer_close(header.packer);
    free(recorder);
    free(triplets);
    return status;
}
