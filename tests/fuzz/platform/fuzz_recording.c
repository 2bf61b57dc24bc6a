/* SPDX-License-Identifier: Apache-2.0 */
/* libFuzzer: recordings in memory, every frame read. Seeds: `recording_tool seeds FOLDER` (tests/recordings). */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "recording/recording.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* written, so that the reads are not optimised away */
extern volatile uint32_t fuzz_recording_sum;
volatile uint32_t fuzz_recording_sum;

/* Reads every byte of a frame, so that a sanitizer notices an invalid one. */
static uint32_t touch(const uint8_t *rows, uint32_t stride, uint32_t row_bytes, uint32_t count)
{
    uint32_t sum = 0;
    for (uint32_t y = 0; y < count; y++) {
        for (uint32_t x = 0; x < row_bytes; x++) {
            sum += rows[(size_t)y * stride + x];
        }
    }
    return sum;
}

static uint32_t touch_frame(const t3r_frame *frame)
{
    static const uint8_t pixel_bytes[T3R_PIXEL_FORMAT_COUNT] = {3, 3, 1, 2, 2, 1};
    if ((uint32_t)frame->format >= T3R_PIXEL_FORMAT_COUNT || frame->width < 2 || frame->width > T3R_MAX_SIDE ||
        frame->height < 2 || frame->height > T3R_MAX_SIDE) {
        abort();
    }
    uint32_t row_bytes = frame->width * pixel_bytes[frame->format];
    uint32_t sum = touch(frame->planes[0], frame->stride_bytes[0], row_bytes, frame->height);
    if (frame->format == T3R_PIXEL_NV12) {
        sum += touch(frame->planes[1], frame->stride_bytes[1], row_bytes, frame->height / 2);
    }
    if (frame->depth != NULL) {
        sum += touch(frame->depth, frame->depth_stride_bytes, frame->depth_width * 2, frame->depth_height);
    }
    return sum;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char error[256] = "";
    t3r_recording *recording = t3r_recording_parse(data, size, error, sizeof error);
    if (recording == NULL) {
        if (error[0] == '\0') {
            abort(); /* a refusal without a reason */
        }
        return 0;
    }
    for (uint32_t i = 0; i < t3r_recording_frame_count(recording); i++) {
        t3r_capture_frame frame;
        error[0] = '\0';
        if (t3r_recording_frame(recording, i, &frame, error, sizeof error) == T3R_CAPTURE_FRAME) {
            fuzz_recording_sum = touch_frame(&frame.frame);
        } else if (error[0] == '\0') {
            abort();
        }
    }
    for (uint32_t i = 0; i < t3r_recording_triplet_count(recording); i++) {
        if (t3r_recording_triplet(recording, i).target >= t3r_recording_frame_count(recording)) {
            abort();
        }
    }
    t3r_recording_close(recording);
    return 0;
}
