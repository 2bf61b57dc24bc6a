/* SPDX-License-Identifier: Apache-2.0 */
/* libFuzzer: bags in memory, read like import does: pictures decoded, transforms composed, depth registered. Seeds:
 * `recording_tool seeds FOLDER` (tests/recordings). */
#include <stdlib.h>

#include "import/bags/bag_border.h"
#include "import/bags/bag_frames.h"
#include "import/bags/bag_pictures.h"
#include "import/bags/bag_size.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* written, so that the reads are not optimised away */
extern volatile uint32_t fuzz_bag_sum;
volatile uint32_t fuzz_bag_sum;

enum { MOST_FRAMES = 4 }; /* later ones are read in the same way */

static void touch_depth(const t3r_frame *frame)
{
    uint32_t sum = 0;
    for (uint32_t y = 0; y < frame->depth_height; y++) {
        for (uint32_t x = 0; x < frame->depth_width * 2; x++) {
            sum += frame->depth[(size_t)y * frame->depth_stride_bytes + x];
        }
    }
    fuzz_bag_sum = sum;
}

static void make_frames(t3r_recording *recording, bag_frames *frames, bag_pictures *pictures)
{
    char error[256];
    bag_size sized = {.width = 24, .height = 16};
    picture_inner inner;
    (void)bag_border_find(recording, &inner);
    for (uint32_t i = 0; i < t3r_recording_frame_count(recording) && i < MOST_FRAMES; i++) {
        t3r_capture_frame frame;
        error[0] = '\0';
        bool read = t3r_recording_frame(recording, i, &frame, error, sizeof error) == T3R_CAPTURE_FRAME &&
                    bag_frames_make(frames, i, &frame, error, sizeof error) == 0 &&
                    bag_pictures_hide(pictures, &frame.frame, frame.straightened) == 0 &&
                    bag_border_cut(&inner, &frame, error, sizeof error) == 0 &&
                    bag_size_apply(&sized, &frame, error, sizeof error) == 0;
        if (!read && error[0] == '\0') {
            abort();
        }
        if (read && frame.frame.depth != NULL) {
            touch_depth(&frame.frame);
        }
    }
    bag_size_free(&sized);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char error[256] = "";
    t3r_recording *recording = t3r_recording_parse(data, size, error, sizeof error);
    if (recording == NULL) {
        return 0;
    }
    bag_pictures pictures = {.large = true};
    bag_frames frames;
    t3r_recording_set_decoder(recording, bag_pictures_decoder(&pictures));
    const bag_frames_options options = {.near_ns = 20000000};
    if (bag_frames_open(&frames, recording, &options, error, sizeof error) == 0) {
        make_frames(recording, &frames, &pictures);
    } else if (error[0] == '\0') {
        abort();
    }
    bag_frames_close(&frames);
    t3r_recording_close(recording);
    bag_pictures_free(&pictures);
    return 0;
}
