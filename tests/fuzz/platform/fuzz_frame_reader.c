/* SPDX-License-Identifier: Apache-2.0 */
/* libFuzzer: recordings in memory, read by the reader for firmware, every byte of a frame, in strips of rows. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "messages/pixel_layout.h"
#include "recording/frame_reader.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { ROOM = 4096, STRIP_ROWS = 8 };

/* written, so that the reads are not optimised away */
extern volatile uint32_t fuzz_frame_reader_sum;
volatile uint32_t fuzz_frame_reader_sum;

typedef struct input {
    const uint8_t *bytes;
    size_t count;
} input;

static int read_bytes(void *user, uint64_t offset, void *bytes, size_t count)
{
    const input *from = user;
    if (offset > from->count || count > from->count - offset) {
        abort(); /* may request only bytes that exist */
    }
    memcpy(bytes, from->bytes + offset, count);
    return 0;
}

static void touch(const uint8_t *rows, uint32_t stride, uint32_t row_bytes, uint32_t count)
{
    for (uint32_t y = 0; y < count; y++) {
        for (uint32_t x = 0; x < row_bytes; x++) {
            fuzz_frame_reader_sum += rows[(size_t)y * stride + x];
        }
    }
}

static uint32_t rows_from(uint32_t row, uint32_t height)
{
    return row >= height ? 0 : height - row < STRIP_ROWS ? height - row : STRIP_ROWS;
}

static void touch_frame(t3r_frame_reader *reader, t3r_frame *f)
{
    for (uint32_t row = 0; row < f->height || row < f->depth_height; row += STRIP_ROWS) {
        const uint32_t rows = rows_from(row, f->height), depth_rows = rows_from(row, f->depth_height);
        const uint32_t first = rows > 0 ? row : f->height, depth_first = depth_rows > 0 ? row : f->depth_height;
        if (t3r_frame_reader_rows(reader, f, first, rows, depth_first, depth_rows) != 0) {
            return;
        }
        for (uint32_t p = 0; p < 2; p++) {
            touch(f->planes[p], f->stride_bytes[p], t3r_pixel_row_bytes(f->format, f->width),
                  t3r_pixel_rows(f->format, p, rows));
        }
        if (f->depth != NULL) {
            touch(f->depth, f->depth_stride_bytes, f->depth_width * 2, depth_rows);
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    /* on the heap, so that the sanitizer sees accesses beyond */
    uint8_t *colour = malloc(ROOM), *depth = malloc(ROOM);
    t3r_frame_reader reader;
    input from = {data, size};
    const t3r_byte_source source = {read_bytes, &from, size};
    t3r_capture_frame frame;
    if (colour != NULL && depth != NULL && t3r_frame_reader_open(&reader, &source, colour, ROOM, depth, ROOM) == 0) {
        while (t3r_frame_reader_find(&reader, &frame) == T3R_CAPTURE_FRAME) {
            touch_frame(&reader, &frame.frame);
        }
    }
    free(colour);
    free(depth);
    return 0;
}
