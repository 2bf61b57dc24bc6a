/* SPDX-License-Identifier: Apache-2.0 */
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

/* ---- frames that cannot be read ---- */

int posed_recording_losses_open(posed_recording_losses *losses, uint32_t frames, bool strict)
{
    *losses = (posed_recording_losses){.strict = strict, .gone = calloc((size_t)frames + 1, sizeof *losses->gone)};
    return losses->gone != NULL ? 0 : -1;
}

void posed_recording_losses_close(posed_recording_losses *losses)
{
    free(losses->gone);
    text_list_free(&losses->frames);
    text_list_free(&losses->parts);
}

/* Adds a line unless there are enough. */
static int note(text_list *list, const char *why, char *error, size_t error_bytes)
{
    return list->count >= POSED_RECORDING_LINES || text_list_add(list, "%s", why) == 0
               ? 0
               : t3r_reason(error, error_bytes, "out of memory");
}

int posed_recording_lose(posed_recording_losses *losses, uint32_t index, const char *why, char *error,
                         size_t error_bytes)
{
    if (losses->strict) {
        return t3r_reason(error, error_bytes, "%s", why);
    }
    losses->gone[index] = true;
    losses->gone_count++;
    return note(&losses->frames, why, error, error_bytes);
}

/* Copies the triplets whose frames are all written, with their new numbers. Returns NULL without memory. */
static t3r_triplet *kept_triplets(const t3r_recording *recording, const posed_recording_losses *losses, uint32_t *count)
{
    const uint32_t frames = t3r_recording_frame_count(recording), all = t3r_recording_triplet_count(recording);
    t3r_triplet *triplets = malloc(((size_t)all + 1) * sizeof *triplets);
    uint32_t *places = malloc(((size_t)frames + 1) * sizeof *places);
    *count = 0;
    for (uint32_t i = 0, place = 0; places != NULL && i < frames; i++) {
        places[i] = place;
        place += !losses->gone[i];
    }
    for (uint32_t i = 0; triplets != NULL && places != NULL && i < all; i++) {
        const t3r_triplet t = t3r_recording_triplet(recording, i);
        if (!losses->gone[t.context[0]] && !losses->gone[t.context[1]] && !losses->gone[t.target]) {
            triplets[(*count)++] = (t3r_triplet){{places[t.context[0]], places[t.context[1]]}, places[t.target]};
        }
    }
    if (places == NULL) {
        free(triplets);
        triplets = NULL;
    }
    free(places);
    return triplets;
}

/* ---- writing ---- */

static int write_frame(t3r_recorder *recorder, const t3r_recording *recording, uint32_t index,
                       const posed_recording_change *change, posed_recording_losses *losses,
                       posed_recording_totals *totals, char *error, size_t error_bytes)
{
    t3r_capture_frame frame;
    char why[400] = "", lost[400];
    if (t3r_recording_frame_readable(recording, index, &frame, lost, sizeof lost, why, sizeof why) !=
        T3R_CAPTURE_FRAME) {
        return posed_recording_lose(losses, index, why, error, error_bytes); /* names the frame */
    }
    if (lost[0] != '\0' && losses->strict) {
        return t3r_reason(error, error_bytes, "%s", lost);
    }
    const bool no_depth = lost[0] != '\0' && frame.frame.depth == NULL &&
                          t3r_recording_frame_message(recording, index, T3R_USE_DEPTH).data != NULL;
    char reason[360];
    if (change->make(change->user, index, &frame, reason, sizeof reason) != 0) {
        t3r_reason(why, sizeof why, "frame %u: %s", index, reason);
        return posed_recording_lose(losses, index, why, error, error_bytes);
    }
    losses->part_count += lost[0] != '\0';
    losses->depth_count += no_depth;
    if (lost[0] != '\0' && note(&losses->parts, lost, error, error_bytes) != 0) {
        return -1;
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
                          const posed_recording_change *change, FILE *stream, posed_recording_losses *losses,
                          posed_recording_totals *totals, char *error, size_t error_bytes)
{
    const uint32_t frames = t3r_recording_frame_count(recording), gone_before = losses->gone_count;
    *totals = (posed_recording_totals){0};
    text_list_free(&losses->parts);
    losses->part_count = losses->depth_count = 0;
    t3r_triplet *triplets = kept_triplets(recording, losses, &totals->triplets);
    t3r_recorder *recorder = malloc(t3r_recorder_bytes());
    int status = triplets != NULL && recorder != NULL ? 0 : t3r_reason(error, error_bytes, "out of memory");
    t3r_recording_header header = {.camera = "camera",
                                   .source = source,
                                   .clock = t3r_recording_clock(recording),
                                   .depth_unit = ldexp((double)t3r_recording_depth_unit_q40(recording), -40),
                                   .triplets = triplets,
                                   .triplet_count = totals->triplets};
    if (status == 0 && recording_options_apply(stored, &header) != 0) {
        status = t3r_reason(error, error_bytes, "out of memory");
    }
    if (status == 0 && t3r_recorder_begin(recorder, t3r_file_sink(stream), &header) != 0) {
        status = t3r_reason(error, error_bytes, "cannot be written");
    }
    for (uint32_t i = 0; i < frames && status == 0; i++) {
        cli_progress("writing", i, frames);
        status = losses->gone[i] ? 0 : write_frame(recorder, recording, i, change, losses, totals, error, error_bytes);
    }
    if (status == 0 && losses->gone_count == frames) {
        status = t3r_reason(error, error_bytes, "%s", losses->frames.lines[0]);
    }
    if (status == 0 && losses->depth_count > 0 && losses->depth_count == t3r_recording_pairing(recording).with_depth) {
        status = t3r_reason(error, error_bytes, "%s", losses->parts.lines[0]);
    }
    if (status == 0 && t3r_recorder_end(recorder) != 0) {
        status = t3r_reason(error, error_bytes, "cannot be written");
    }
    if (status == 0 && losses->gone_count > gone_before && t3r_recording_triplet_count(recording) > 0) {
        status = POSED_RECORDING_AGAIN;
    }
    t3r_chunk_packer_close(header.packer);
    free(recorder);
    free(triplets);
    return status;
}
