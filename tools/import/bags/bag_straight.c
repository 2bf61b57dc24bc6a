/* SPDX-License-Identifier: Apache-2.0 */
#include "import/bags/bag_straight.h"

#include <stdlib.h>

#include "core/little_endian.h"
#include "host/reason.h"
#include "image/image.h"
#include "import/frames/straighten.h"

/* Converts colour of any format to RGB. Returns -1 without memory. */
static int take_colour(const t3r_frame *frame, picture *out)
{
    const size_t pixels = (size_t)frame->width * frame->height;
    uint8_t *planes = malloc(pixels * 3), *rgb = malloc(pixels * 3);
    *out = (picture){.width = frame->width, .height = frame->height, .channels = 3, .bits = 8, .samples = rgb};
    if (planes != NULL && rgb != NULL) {
        uint8_t *const rows[3] = {planes, planes + pixels, planes + 2 * pixels};
        t3r_image_colour(&t3r_kernels_c, frame, frame->width, frame->height, 0, frame->height, rows, NULL);
        for (size_t i = 0; i < 3 * pixels; i++) {
            rgb[i] = rows[i % 3][i / 3];
        }
    }
    free(planes);
    return planes != NULL && rgb != NULL ? 0 : -1;
}

int bag_straighten_colour(const lens *l, t3r_frame *frame, picture *out, char *error, size_t error_bytes)
{
    picture_free(out);
    if (take_colour(frame, out) != 0) {
        return t3r_reason(error, error_bytes, "out of memory");
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
