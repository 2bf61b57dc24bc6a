/* SPDX-License-Identifier: Apache-2.0 */
#include "import/bags/bag_straight.h"

#include <stdlib.h>
#include <string.h>

#include "core/little_endian.h"
#include "host/reason.h"
#include "import/bags/bag_size.h"
#include "import/frames/straighten.h"

int bag_straighten_colour(const lens *l, t3r_frame *frame, const uint8_t *valid, picture *out, char *error,
                          size_t error_bytes)
{
    const size_t pixels = (size_t)frame->width * frame->height;
    picture_free(out);
    const char *wrong = bag_size_colour(frame, out);
    if (wrong != NULL) {
        return t3r_reason(error, error_bytes, "%s", wrong);
    }
    if (valid != NULL && (out->valid = malloc(pixels)) == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    if (valid != NULL) {
        memcpy(out->valid, valid, pixels);
    }
    if (straighten(l, out, error, error_bytes) != 0) {
        return -1;
    }
    frame->format = T3R_PIXEL_RGB24;
    frame->planes[0] = out->samples;
    frame->planes[1] = NULL;
    frame->stride_bytes[0] = frame->width * 3;
    return 0;
}

int bag_straighten_depth(const lens *l, t3r_frame *frame, picture *out, char *error, size_t error_bytes)
{
    const uint32_t width = frame->depth_width, height = frame->depth_height;
    picture_free(out);
    uint16_t *samples = malloc((size_t)width * height * 2);
    if (samples == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    for (size_t i = 0; i < (size_t)width * height; i++) {
        samples[i] = t3r_load_le16(frame->depth + i / width * frame->depth_stride_bytes + i % width * 2);
    }
    *out = (picture){.width = width, .height = height, .channels = 1, .bits = 16, .samples = samples};
    if (straighten(l, out, error, error_bytes) != 0) {
        return -1;
    }
    samples = out->samples;
    for (size_t i = 0; i < (size_t)width * height; i++) {
        const uint16_t sample = samples[i];
        t3r_store_le16((uint8_t *)&samples[i], sample);
    }
    frame->depth = out->samples;
    frame->depth_stride_bytes = width * 2;
    return 0;
}
