/* SPDX-License-Identifier: Apache-2.0 */
/* Frames in the layout of a driver's memory: a file with a head, and per frame a plane of R G B and one of depth. The
 * source takes next to no flash, so flash sizes are the runtime's. tools/boards writes such files
 * (tools/study/boards/planes.c). */
#include "frames.h"

#include "planes.h"
#include "report.h"
#include "semihost.h"

static struct {
    int32_t file;
    uint32_t next; /* start of the next frame and end of the current one's planes */
    uint32_t width, height;
    frames_strip strip;
} source;

static void take(uint32_t at, void *bytes, size_t count)
{
    if (semihost_read(source.file, at, bytes, count) != 0) {
        report_failure("frames: there is no byte", at);
    }
}

void frames_open(const char *path, uint32_t width, uint32_t height, const frames_strip *strip)
{
    source.file = semihost_open(path, SEMIHOST_READ);
    source.width = width;
    source.height = height;
    source.strip = *strip;
}

void frames_next(t3r_frame *frame, t3r_camera *camera)
{
    planes_head head;
    take(source.next, &head, sizeof head);
    source.next += (uint32_t)sizeof head + source.width * source.height * 5;
    *frame = (t3r_frame){
        .format = T3R_PIXEL_RGB24,
        .width = source.width,
        .height = source.height,
        .planes = {source.strip.colour},
        .stride_bytes = {source.width * 3},
        .depth = source.strip.depth,
        .depth_width = source.width,
        .depth_height = source.height,
        .depth_stride_bytes = source.width * 2,
        .depth_unit_q40 = head.depth_unit_q40,
    };
    *camera = head.camera;
}

void frames_rows(t3r_frame *frame, uint32_t row, uint32_t rows)
{
    (void)frame; /* the planes begin with the strip */
    const uint32_t width = source.width, depth = source.next - width * source.height * 2;
    const uint32_t colour = depth - width * source.height * 3;
    take(colour + row * width * 3, source.strip.colour, (size_t)rows * width * 3);
    take(depth + row * width * 2, source.strip.depth, (size_t)rows * width * 2);
}
