/* SPDX-License-Identifier: Apache-2.0 */
/* Sentences about errors of calls that take a frame. */
#include "api/adding_checks.h"
#include "api/keyframe_checks.h"
#include "image/develop_checks.h"
#include "sentence.h"

/* Writes the sentence of an error that the image stage finds in a frame that passed the checks. These do not find it
 * again, and the call may have discarded the rows before. */
static t3r_status developed(t3r_status status, t3r_status found, const t3r_runtime *rt, t3r_fault *fault)
{
    switch (found == status || rt == NULL ? T3R_OK : status) {
    case T3R_ERR_CAMERA:
        t3r_note(fault, "camera.distortion_q24: more than half of the picture lies beyond what this lens can show", 0,
                 0, 0, 0);
        return status;
    case T3R_ERR_NO_DEPTH:
        t3r_note(fault, "frame.depth has no measurement at the working size of # x #: 0 = not measured",
                 rt->config.width, rt->config.height, 0, 0);
        return status;
    default:
        return found;
    }
}

const char *t3r_add_view_error(t3r_status status, const t3r_runtime *rt, const t3r_frame *frame,
                               const t3r_camera *camera, char *text, size_t text_bytes)
{
    t3r_fault fault;
    t3r_frame shown;
    t3r_camera resized;
    const t3r_status found = t3r_add_view_checks(rt, frame, camera, &shown, &resized, &fault);
    return t3r_sentence(status, developed(status, found, rt, &fault), &fault, text, text_bytes);
}

const char *t3r_add_rows_error(t3r_status status, const t3r_runtime *rt, const t3r_frame *frame,
                               const t3r_camera *camera, uint32_t row, uint32_t rows, uint32_t depth_row,
                               uint32_t depth_rows, char *text, size_t text_bytes)
{
    t3r_fault fault;
    t3r_frame shown;
    t3r_camera resized;
    t3r_strip strip;
    t3r_strips after;
    const t3r_status found = t3r_add_rows_checks(rt, frame, camera, row, rows, depth_row, depth_rows, &shown, &resized,
                                                 &strip, &after, &fault);
    return t3r_sentence(status, developed(status, found, rt, &fault), &fault, text, text_bytes);
}

const char *t3r_develop_error(t3r_status status, const t3r_runtime *rt, const t3r_frame *frame,
                              const t3r_camera *camera, const uint8_t *rgb_out, const uint16_t *depth_out,
                              const t3r_camera *undistorted, char *text, size_t text_bytes)
{
    (void)depth_out;
    t3r_fault fault;
    t3r_camera resized;
    const t3r_status found = t3r_develop_call_checks(rt, frame, camera, rgb_out, undistorted, &resized, &fault);
    return t3r_sentence(status, developed(status, found, rt, &fault), &fault, text, text_bytes);
}

/* Writes the sentence of an error that a stream finds in a frame that passed the checks. */
static t3r_status streamed(t3r_status status, const t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera,
                           t3r_fault *fault)
{
    if (status == T3R_ERR_CAMERA && rt->keyframes > 0) {
        T3R_PASS(t3r_far_checks(camera, &rt->frame, fault));
    }
    T3R_CHECK(fault, status != T3R_ERR_NO_DEPTH || frame->depth != NULL, T3R_ERR_NO_DEPTH,
              "frame.depth is NULL: a stream's frames have a depth plane");
    return developed(status, T3R_OK, rt, fault);
}

const char *t3r_stream_keyframe_error(t3r_status status, const t3r_runtime *rt, const t3r_frame *frame,
                                      const t3r_camera *camera, const t3r_stream_report *report, char *text,
                                      size_t text_bytes)
{
    (void)report;
    t3r_fault fault;
    t3r_camera resized;
    t3r_status found = t3r_keyframe_checks(rt, frame, camera, &resized, &fault);
    found = found == T3R_OK ? streamed(status, rt, frame, camera, &fault) : found;
    return t3r_sentence(status, found, &fault, text, text_bytes);
}

const char *t3r_stream_again_error(t3r_status status, const t3r_runtime *rt, const t3r_frame *frame,
                                   const t3r_camera *camera, uint32_t round, char *text, size_t text_bytes)
{
    t3r_fault fault;
    t3r_camera resized;
    t3r_status found = t3r_again_checks(rt, frame, camera, round, &resized, &fault);
    found = found == T3R_OK ? streamed(status, rt, frame, camera, &fault) : found;
    return t3r_sentence(status, found, &fault, text, text_bytes);
}

/* Writes the sentence of an error that the comparison with the newest keyframe finds in a camera that passed the
 * checks. */
static t3r_status compared(const t3r_runtime *rt, const t3r_camera *camera, uint32_t width, uint32_t height,
                           t3r_fault *fault)
{
    t3r_camera resized;
    T3R_PASS(t3r_resized_checks(rt, camera, width, height, &resized, fault));
    return t3r_far_checks(camera, &rt->frame, fault);
}

const char *t3r_stream_overlap_error(t3r_status status, const t3r_runtime *rt, const t3r_camera *camera, uint32_t width,
                                     uint32_t height, const uint32_t *overlap_q8, char *text, size_t text_bytes)
{
    t3r_fault fault;
    t3r_status found = t3r_overlap_checks(rt, camera, width, height, overlap_q8, &fault);
    found = found == T3R_OK ? compared(rt, camera, width, height, &fault) : found;
    return t3r_sentence(status, found, &fault, text, text_bytes);
}
