#include "import/folders/posed_recording.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "host/reason.h"

/* Converts a camera exactly: its fixed-point numbers have at most 53 bits. */
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

static int write_frame(t3r_recorder *recorder, const t3r_recording *recording, uint32_t index,
                       const posed_recording_change *change, posed_recording_totals *totals, char *error,
                       size_t error_bytes)
{
    t3r_capture_frame frame;
    char why[256] = "";
    if (t3r_recording_frame(recording, index, &frame, why, sizeof why) != T3R_CAPTURE_FRAME) {
        return t3r_reason(error, error_bytes, "%s", why); /* names the frame */
    }
    if (change->make(change->user, index, &frame, why, sizeof why) != 0) {
        return t3r_reason(error, error_bytes, "frame %u: %s", index, why);
    }
    t3r_recorded_frame out = {.stamp_ns = frame.stamp_ns,
                              .format = frame.frame.format,
                              .width = frame.frame.width,
                              .height = frame.frame.height,
                              .depth_z16 = frame.frame.depth,
                              .depth_width = frame.frame.depth_width,
                              .depth_height = frame.frame.depth_height,
                              .depth_stride_bytes = frame.frame.depth_stride_bytes,
                              .unposed = !frame.has_pose,
                              .uncalibrated = !frame.has_intrinsics,
                              .camera = camera_of(&frame)};
    memcpy(out.planes, frame.frame.planes, sizeof out.planes);
    memcpy(out.stride_bytes, frame.frame.stride_bytes, sizeof out.stride_bytes);
    totals->frames++;
    totals->depth_frames += frame.frame.depth != NULL;
    totals->posed_frames += frame.has_pose;
    if (frame.stamp_ns < 0) {
        return t3r_reason(error, error_bytes, "frame %u: its stamp is before 1970", index);
    }
    return t3r_recorder_frame(recorder, &out) == 0
               ? 0
               : t3r_reason(error, error_bytes, "frame %u cannot be written", index);
}

int posed_recording_write(const t3r_recording *recording, const char *source, const recording_options *stored,
                          const posed_recording_change *change, FILE *stream, posed_recording_totals *totals,
                          char *error, size_t error_bytes)
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
                                   .depth_unit = ldexp((double)t3r_recording_depth_unit_q40(recording), -40),
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
        status = write_frame(recorder, recording, i, change, totals, error, error_bytes);
    }
    if (status == 0 && t3r_recorder_end(recorder) != 0) {
        status = t3r_reason(error, error_bytes, "cannot be written");
    }
    t3r_chunk_packer_close(header.packer);
    free(recorder);
    free(triplets);
    return status;
}
