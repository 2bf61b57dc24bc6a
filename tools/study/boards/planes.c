/* SPDX-License-Identifier: Apache-2.0 */
/* planes WIDTH HEIGHT IN.mcap OUT: writes the frames of a recording for platform/baremetal/frames_planes.c. */
#include <stdio.h>
#include <stdlib.h>

#include "planes.h"
#include "recording/frame_reader.h"

static int read_file(void *user, uint64_t offset, void *bytes, size_t count)
{
    return fseek(user, (long)offset, SEEK_SET) == 0 && fread(bytes, 1, count, user) == count ? 0 : -1;
}

static _Noreturn void fail(const char *what, const char *why)
{
    fprintf(stderr, "planes: %s: %s\n", what, why);
    exit(1);
}

static void write_frame(const t3r_capture_frame *frame, uint32_t width, uint32_t height, FILE *out)
{
    const t3r_frame *f = &frame->frame;
    const planes_head head = {frame->camera, f->depth_unit_q40};
    if (!frame->has_pose || !frame->has_intrinsics || f->format != T3R_PIXEL_RGB24 || f->depth == NULL ||
        f->width != width || f->height != height || f->depth_width != width || f->depth_height != height) {
        fail("frame", "it has not R G B and depth of this size, intrinsics and a pose");
    }
    fwrite(&head, sizeof head, 1, out);
    for (uint32_t y = 0; y < height; y++) {
        fwrite(f->planes[0] + (size_t)y * f->stride_bytes[0], 3, width, out);
    }
    for (uint32_t y = 0; y < height; y++) {
        fwrite(f->depth + (size_t)y * f->depth_stride_bytes, 2, width, out);
    }
}

int main(int argc, char **argv)
{
    if (argc != 5) {
        fail("usage", "planes WIDTH HEIGHT IN.mcap OUT");
    }
    const uint32_t width = (uint32_t)strtoul(argv[1], NULL, 10), height = (uint32_t)strtoul(argv[2], NULL, 10);
    const size_t pixels = (size_t)width * height;
    const size_t colour_room = pixels * 3, depth_room = pixels * 2;
    FILE *in = fopen(argv[3], "rb"), *out = fopen(argv[4], "wb");
    uint8_t *colour = malloc(colour_room), *depth = malloc(depth_room);
    if (in == NULL || out == NULL || colour == NULL || depth == NULL || fseek(in, 0, SEEK_END) != 0) {
        fail(argv[in == NULL ? 3 : 4], "it cannot be opened");
    }
    static t3r_frame_reader reader;
    const t3r_byte_source source = {read_file, in, (uint64_t)ftell(in)};
    t3r_capture_frame frame;
    int state = t3r_frame_reader_open(&reader, &source, colour, colour_room, depth, depth_room);
    if (state == 0) {
        while ((state = t3r_frame_reader_next(&reader, &frame)) == T3R_CAPTURE_FRAME) {
            write_frame(&frame, width, height, out);
        }
    }
    if (reader.error != NULL || fclose(out) != 0) {
        fail(argv[3], reader.error != NULL ? reader.error : "its planes cannot be written");
    }
    free(colour);
    free(depth);
    fclose(in);
    return 0;
}
