/* SPDX-License-Identifier: Apache-2.0 */
#include "import/bags/bag_size.h"

#include <stdlib.h>

#include "core/camera.h"
#include "core/little_endian.h"
#include "host/reason.h"
#include "image/image.h"
#include "import/frames/crop.h"
#include "messages/pixel_layout.h"

#define TILE T3R_MAX_SIDE /* even, so that pixels which share a colour stay together */

void bag_size_crop(const t3r_crop *part, t3r_frame *frame)
{
    frame->width = part->width;
    frame->height = part->height;
    frame->planes[0] += (size_t)part->y * frame->stride_bytes[0] + t3r_pixel_row_bytes(frame->format, part->x);
    if (frame->format == T3R_PIXEL_NV12) {
        frame->planes[1] += (size_t)part->y / 2 * frame->stride_bytes[1] + part->x;
    }
}

void bag_size_crop_camera(const t3r_crop *part, t3r_camera *camera)
{
    camera->cx_q16 -= (int32_t)(part->x << 16);
    camera->cy_q16 -= (int32_t)(part->y << 16);
    camera->width = camera->width != 0 ? part->width : 0;
    camera->height = camera->height != 0 ? part->height : 0;
}

/* Returns the part of a frame that begins at (x, y), both even, with at most TILE pixels along each side. */
static t3r_frame tile_of(const t3r_frame *frame, uint32_t x, uint32_t y)
{
    const t3r_crop part = {x, y, frame->width - x < TILE ? frame->width - x : TILE,
                           frame->height - y < TILE ? frame->height - y : TILE};
    t3r_frame tile = *frame;
    tile.depth = NULL;
    bag_size_crop(&part, &tile);
    return tile;
}

/* Copies a tile's planes of colour to its place in the picture. */
static void join_planes(const uint8_t *planes, const t3r_frame *tile, uint32_t x, uint32_t y, picture *out)
{
    const size_t pixels = (size_t)tile->width * tile->height;
    for (uint32_t row = 0; row < tile->height; row++) {
        const uint8_t *from = planes + (size_t)row * tile->width;
        uint8_t *to = (uint8_t *)out->samples + ((size_t)(y + row) * out->width + x) * 3;
        for (uint32_t column = 0; column < tile->width; column++, from++, to += 3) {
            to[0] = from[0];
            to[1] = from[pixels];
            to[2] = from[2 * pixels];
        }
    }
}

const char *bag_size_colour(const t3r_frame *frame, picture *out)
{
    uint8_t *rgb = malloc((size_t)frame->width * frame->height * 3), *planes = malloc((size_t)TILE * TILE * 3);
    *out = (picture){.width = frame->width, .height = frame->height, .channels = 3, .bits = 8, .samples = rgb};
    const char *wrong = rgb == NULL || planes == NULL                   ? "out of memory"
                        : frame->stride_bytes[0] > T3R_MAX_STRIDE_BYTES ? "step is too large"
                                                                        : NULL;
    for (uint32_t y = 0; wrong == NULL && y < frame->height; y += TILE) {
        for (uint32_t x = 0; x < frame->width; x += TILE) {
            const t3r_frame tile = tile_of(frame, x, y);
            const size_t pixels = (size_t)tile.width * tile.height;
            uint8_t *const rows[3] = {planes, planes + pixels, planes + 2 * pixels};
            t3r_image_colour(&t3r_kernels_c, &tile, tile.width, tile.height, 0, tile.height, rows, NULL);
            join_planes(planes, &tile, x, y, out);
        }
    }
    free(planes);
    return wrong;
}

/* Allocates the samples of a picture of the wanted size. Returns NULL without memory. */
static void *begin(const bag_size *size, picture *out, uint32_t channels, uint32_t bits)
{
    picture_free(out);
    *out = (picture){.width = size->width, .height = size->height, .channels = channels, .bits = bits};
    out->samples = malloc((size_t)size->width * size->height * channels * bits / 8);
    return out->samples;
}

static int resize_depth(bag_size *size, const t3r_crop *part, t3r_frame *f)
{
    uint16_t *samples = begin(size, &size->depth, 1, 16);
    if (samples == NULL ||
        import_crop_depth(f->depth, f->depth_stride_bytes, part, size->width, size->height, samples) != 0) {
        return -1;
    }
    for (size_t i = 0; i < (size_t)size->width * size->height; i++) {
        const uint16_t sample = samples[i];
        t3r_store_le16((uint8_t *)&samples[i], sample);
    }
    f->depth = size->depth.samples;
    f->depth_width = size->width;
    f->depth_height = size->height;
    f->depth_stride_bytes = size->width * 2;
    return 0;
}

/* Adapts intrinsics to the part that is shown, and then to the size. Returns false if they leave their range. */
static bool resize_camera(const bag_size *size, const t3r_crop *crop, t3r_capture_frame *frame)
{
    t3r_camera part = frame->camera;
    bag_size_crop_camera(crop, &part);
    frame->camera = t3r_camera_resized(&part, crop->width, crop->height, size->width, size->height);
    t3r_camera posed = frame->camera;
    if (!frame->has_pose) {
        posed.rotation_q30[0] = 1 << 30;
    }
    return t3r_camera_check(&posed, size->width, size->height) == T3R_OK;
}

/* Makes the frame's new colour, depth and camera of its colour as RGB. */
static int resize(bag_size *size, const picture *whole, t3r_capture_frame *frame, char *error, size_t error_bytes)
{
    t3r_frame *f = &frame->frame;
    const t3r_crop crop = import_largest_crop(whole->width, whole->height, size->width, size->height);
    const t3r_crop part = f->depth == NULL ? crop
                                           : import_crop_in_proportion(&crop, whole->width, whole->height,
                                                                       f->depth_width, f->depth_height);
    if (crop.width < IMPORT_LEAST_SIDE || crop.height < IMPORT_LEAST_SIDE || part.width < IMPORT_LEAST_SIDE ||
        part.height < IMPORT_LEAST_SIDE) {
        return t3r_reason(error, error_bytes, "too narrow to crop to the aspect of --size");
    }
    uint8_t *rgb = begin(size, &size->colour, 3, 8);
    if (rgb == NULL || import_crop_colour(whole, &crop, size->width, size->height, rgb) != 0 ||
        (f->depth != NULL && resize_depth(size, &part, f) != 0)) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    f->format = T3R_PIXEL_RGB24;
    f->width = size->width;
    f->height = size->height;
    f->planes[0] = rgb;
    f->planes[1] = NULL;
    f->stride_bytes[0] = size->width * 3;
    return !frame->has_intrinsics || resize_camera(size, &crop, frame)
               ? 0
               : t3r_reason(error, error_bytes, "at that --size its intrinsics are out of range");
}

int bag_size_apply(bag_size *size, t3r_capture_frame *frame, char *error, size_t error_bytes)
{
    if (size->width == 0) {
        return 0;
    }
    picture whole;
    const char *wrong = bag_size_colour(&frame->frame, &whole);
    const int status =
        wrong == NULL ? resize(size, &whole, frame, error, error_bytes) : t3r_reason(error, error_bytes, "%s", wrong);
    picture_free(&whole);
    return status;
}

void bag_size_free(bag_size *size)
{
    picture_free(&size->colour);
    picture_free(&size->depth);
}
