/* SPDX-License-Identifier: Apache-2.0 */
#include "import/frames/crop.h"

#include <stdlib.h>

#include "image/image.h"

/* Returns a b / c rounded to nearest, halves up; sides are at most 2^14, so nothing overflows. */
static uint32_t share(uint32_t a, uint32_t b, uint32_t c)
{
    return (2 * a * b + c) / (2 * c);
}

t3r_crop import_largest_crop(uint32_t picture_width, uint32_t picture_height, uint32_t width, uint32_t height)
{
    t3r_crop crop = {.width = picture_width, .height = picture_height};
    if (picture_width * height > picture_height * width) {
        crop.width = share(picture_height, width, height);
    } else {
        crop.height = share(picture_width, height, width);
    }
    crop.width = crop.width == 0 ? 1 : crop.width;
    crop.height = crop.height == 0 ? 1 : crop.height;
    crop.x = (picture_width - crop.width) / 2;
    crop.y = (picture_height - crop.height) / 2;
    return crop;
}

t3r_crop import_crop_in_proportion(const t3r_crop *crop, uint32_t from_width, uint32_t from_height, uint32_t width,
                                   uint32_t height)
{
    t3r_crop out = {.x = share(crop->x, width, from_width), .y = share(crop->y, height, from_height)};
    out.width = share(crop->x + crop->width, width, from_width) - out.x;
    out.height = share(crop->y + crop->height, height, from_height) - out.y;
    return out;
}

int import_crop_colour(const picture *in, const t3r_crop *crop, uint32_t width, uint32_t height, uint8_t *rgb)
{
    t3r_frame frame = {
        .format = in->channels == 3 ? T3R_PIXEL_RGB24 : T3R_PIXEL_GREY, .width = crop->width, .height = crop->height};
    frame.stride_bytes[0] = in->width * in->channels;
    frame.planes[0] =
        (const uint8_t *)in->samples + (size_t)crop->y * frame.stride_bytes[0] + (size_t)crop->x * in->channels;
    size_t pixels = (size_t)width * height;
    uint8_t *memory = malloc(pixels * 3);
    void *work = malloc(t3r_image_work_bytes(width));
    int status = memory != NULL && work != NULL && t3r_image_check(&frame) == T3R_OK ? 0 : -1;
    if (status == 0) {
        uint8_t *const planes[3] = {memory, memory + pixels, memory + 2 * pixels};
        t3r_image_colour(&t3r_kernels_c, &frame, width, height, 0, height, planes, work);
        for (size_t i = 0; i < pixels; i++) {
            for (size_t c = 0; c < 3; c++) {
                rgb[i * 3 + c] = planes[c][i];
            }
        }
    }
    free(work);
    free(memory);
    return status;
}

int import_crop_depth(const void *z16, uint32_t stride_bytes, const t3r_crop *crop, uint32_t width, uint32_t height,
                      uint16_t *depth)
{
    static const uint8_t colour[2 * 2];
    const t3r_frame frame = {.format = T3R_PIXEL_GREY,
                             .width = 2,
                             .height = 2,
                             .planes = {colour},
                             .stride_bytes = {2},
                             .depth = (const uint8_t *)z16 + (size_t)crop->y * stride_bytes + (size_t)crop->x * 2,
                             .depth_width = crop->width,
                             .depth_height = crop->height,
                             .depth_stride_bytes = stride_bytes,
                             .depth_unit_q40 = 1};
    if (t3r_image_check(&frame) != T3R_OK) {
        return -1;
    }
    t3r_image_depth(&frame, width, height, 0, height, depth);
    return 0;
}
