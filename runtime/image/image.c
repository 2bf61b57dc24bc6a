/* SPDX-License-Identifier: Apache-2.0 */
/* Converts frames to planes of the working size. Widths and heights: source W x H, destination w x h. */
#include "image.h"

#include <stdbool.h>

#include "core/fixed.h"
#include "core/memory.h"
#include "frame_checks.h"

/* Source pixels converted at a time when the size changes; even, so that a YUYV pair is never split. */
#define CHUNK 256u

t3r_status t3r_image_check(const t3r_frame *frame)
{
    return frame == NULL ? T3R_ERR_ARGUMENT : t3r_frame_checks(frame, NULL);
}

size_t t3r_image_work_bytes(uint32_t width)
{
    return (size_t)width * 6 * sizeof(uint32_t);
}

/* Converts `count` pixels of row y from column x on (even for the YUV formats) to r, g, b. */
static void convert(const t3r_kernels *kernels, const t3r_frame *frame, uint32_t y, uint32_t x, uint32_t count,
                    uint8_t *r, uint8_t *g, uint8_t *b)
{
    const uint8_t *row =
        frame->planes[0] + (size_t)y * frame->stride_bytes[0] + (size_t)x * t3r_bytes_per_pixel(frame->format);

    switch (frame->format) {
    case T3R_PIXEL_RGB24:
        kernels->triple_row(row, count, r, g, b);
        break;
    case T3R_PIXEL_BGR24:
        kernels->triple_row(row, count, b, g, r);
        break;
    case T3R_PIXEL_YUYV:
        kernels->packed_row(row, count, 0, 1, r, g, b);
        break;
    case T3R_PIXEL_UYVY:
        kernels->packed_row(row, count, 1, 0, r, g, b);
        break;
    case T3R_PIXEL_NV12:
        kernels->nv12_row(row, frame->planes[1] + (size_t)(y / 2) * frame->stride_bytes[1] + x, count, r, g, b);
        break;
    default:
        memcpy(r, row, count);
        memcpy(g, row, count);
        memcpy(b, row, count);
        break;
    }
}

/* Sums the three channels of source row y over the boxes of the destination's columns. */
static void sum_row(const t3r_kernels *kernels, const t3r_frame *frame, uint32_t y, uint32_t width,
                    uint32_t *const sums[3])
{
    uint8_t run[3][CHUNK];
    t3r_box_walk at = {0, frame->width}; /* a source pixel is w units long, a box W units */

    for (uint32_t c = 0; c < 3; c++) {
        memset(sums[c], 0, width * sizeof(uint32_t));
    }
    for (uint32_t x = 0; x < frame->width; x += CHUNK) {
        uint32_t count = T3R_MIN(CHUNK, frame->width - x);
        convert(kernels, frame, y, x, count, run[0], run[1], run[2]);
        (void)kernels->box_sums(at, run[0], count, width, frame->width, sums[0]);
        (void)kernels->box_sums(at, run[1], count, width, frame->width, sums[1]);
        at = kernels->box_sums(at, run[2], count, width, frame->width, sums[2]);
    }
}

/* Averages source rows into destination rows. Totals are at most 255 W H, with W H at most 2^24. In units in which a
 * source row is h high and a destination row H, destination row r begins at r H: at most 2^24. */
typedef struct averaging {
    const t3r_kernels *kernels;
    uint32_t width, height, area;
    uint32_t *sums[3], *totals[3];
    uint32_t row, left; /* destination row being summed, and the units still missing */
} averaging;

static averaging averaging_of(const t3r_kernels *kernels, const t3r_frame *frame, uint32_t width, uint32_t height,
                              void *work)
{
    averaging a = {
        .kernels = kernels, .width = width, .height = height, .area = frame->width * frame->height, .row = 0};
    for (uint32_t c = 0; c < 3; c++) {
        a.sums[c] = (uint32_t *)work + (size_t)c * width;
        a.totals[c] = (uint32_t *)work + (size_t)(3 + c) * width;
    }
    return a;
}

static void forget_totals(const averaging *a)
{
    for (uint32_t c = 0; c < 3; c++) {
        memset(a->totals[c], 0, a->width * sizeof(uint32_t));
    }
}

/* Adds row y of the frame's memory, of which `units` count. Over the whole image at most H + h turns. */
static void take_row(averaging *a, const t3r_frame *frame, uint32_t y, uint32_t units, uint32_t end,
                     uint8_t *const planes[3])
{
    sum_row(a->kernels, frame, y, a->width, a->sums);
    while (units > 0 && a->row < end) {
        const uint32_t part = T3R_MIN(units, a->left);
        for (uint32_t c = 0; c < 3; c++) {
            a->kernels->weigh_row(a->totals[c], a->sums[c], part, a->width);
        }
        units -= part;
        a->left -= part;
        if (a->left == 0) {
            for (uint32_t c = 0; c < 3; c++) {
                a->kernels->divide_row(a->totals[c], a->area, a->width, planes[c] + (size_t)a->row * a->width);
            }
            a->row++;
            a->left = frame->height;
        }
    }
}

static void average(const t3r_kernels *kernels, const t3r_frame *frame, uint32_t width, uint32_t height, uint32_t begin,
                    uint32_t end, uint8_t *const planes[3], void *work)
{
    averaging a = averaging_of(kernels, frame, width, height, work);
    forget_totals(&a);
    a.row = begin;
    a.left = frame->height;
    uint32_t units = height - begin * frame->height % height; /* part of the first source row that lies in the first
                                                               * destination row */
    for (uint32_t y = begin * frame->height / height; a.row < end; y++, units = height) {
        take_row(&a, frame, y, units, end, planes);
    }
}

void t3r_image_colour_strip(const t3r_kernels *kernels, const t3r_frame *frame, uint32_t width, uint32_t height,
                            uint32_t first, uint32_t count, uint8_t *const planes[3], void *work)
{
    if (frame->width == width && frame->height == height) {
        for (uint32_t i = 0; i < count; i++) {
            const size_t at = (size_t)(first + i) * width;
            convert(kernels, frame, i, 0, width, planes[0] + at, planes[1] + at, planes[2] + at);
        }
        return;
    }
    averaging a = averaging_of(kernels, frame, width, height, work);
    if (first == 0) {
        forget_totals(&a);
    }
    a.row = first * height / frame->height;
    a.left = frame->height - first * height % frame->height;
    for (uint32_t i = 0; i < count; i++) {
        take_row(&a, frame, i, height, height, planes);
    }
}

void t3r_image_colour(const t3r_kernels *kernels, const t3r_frame *frame, uint32_t width, uint32_t height,
                      uint32_t begin, uint32_t end, uint8_t *const planes[3], void *work)
{
    if (frame->width != width || frame->height != height) {
        average(kernels, frame, width, height, begin, end, planes, work);
        return;
    }
    for (uint32_t y = begin; y < end; y++) {
        size_t at = (size_t)y * width;
        convert(kernels, frame, y, 0, width, planes[0] + at, planes[1] + at, planes[2] + at);
    }
}

/* Picks a destination row from one row of the depth image. (2 j + 1) W <= 2^13 x 2^12: no overflow; the quotient is at
 * most W - 1. */
static void pick_row(const t3r_frame *frame, const uint8_t *row, uint32_t width, uint16_t *out)
{
    if (frame->depth_width == width) { /* the usual case needs no divisions */
        for (uint32_t x = 0; x < width; x++) {
            out[x] = (uint16_t)(row[2 * x] | row[2 * x + 1] << 8);
        }
        return;
    }
    for (uint32_t x = 0; x < width; x++) {
        const uint8_t *z = row + (size_t)2 * ((2 * x + 1) * frame->depth_width / (2 * width));
        out[x] = (uint16_t)(z[0] | z[1] << 8);
    }
}

void t3r_image_depth_strip(const t3r_frame *frame, uint32_t width, uint32_t height, uint32_t first, uint32_t count,
                           uint16_t *depth)
{
    for (uint32_t y = 0; y < height; y++) {
        const uint32_t from_y = (2 * y + 1) * frame->depth_height / (2 * height);
        if (from_y - first < count) { /* unsigned: a row before the strip wraps to a large number */
            pick_row(frame, frame->depth + (size_t)(from_y - first) * frame->depth_stride_bytes, width,
                     depth + (size_t)y * width);
        }
    }
}

void t3r_image_depth(const t3r_frame *frame, uint32_t width, uint32_t height, uint32_t begin, uint32_t end,
                     uint16_t *depth)
{
    if (frame->depth == NULL) {
        memset(depth + (size_t)begin * width, 0, (size_t)width * (end - begin) * sizeof(uint16_t));
        return;
    }
    for (uint32_t y = begin; y < end; y++) {
        const uint32_t from_y = (2 * y + 1) * frame->depth_height / (2 * height);
        pick_row(frame, frame->depth + (size_t)from_y * frame->depth_stride_bytes, width, depth + (size_t)y * width);
    }
}
