/* Frames as a driver leaves them in memory: a file with a head, a plane of R G B and one of depth a frame. It takes
 * next to no flash, so what is linked is the runtime. tools/boards writes such files (tools/study/boards/planes.c). */
#include "frames.h"

#include "planes.h"
#include "report.h"
#include "semihost.h"

const size_t frames_head_bytes = 0;

static struct {
    int32_t file;
    uint32_t at, width, height;
    frames_room room;
} source;

static void take(void *bytes, size_t count)
{
    if (semihost_read(source.file, source.at, bytes, count) != 0) {
        report_failure("frames: there is no byte", source.at);
    }
    source.at += (uint32_t)count;
}

void frames_open(const char *path, uint32_t width, uint32_t height, const frames_room *room)
{
    source.file = semihost_open(path, SEMIHOST_READ);
    source.width = width;
    source.height = height;
    source.room = *room;
}

void frames_next(t3r_frame *frame, t3r_camera *camera)
{
    const size_t pixels = (size_t)source.width * source.height;
    planes_head head;
    take(&head, sizeof head);
    take(source.room.colour, pixels * 3);
    take(source.room.depth, pixels * 2);
    *frame = (t3r_frame){
        .format = T3R_PIXEL_RGB24,
        .width = source.width,
        .height = source.height,
        .planes = {source.room.colour},
        .stride_bytes = {source.width * 3},
        .depth = source.room.depth,
        .depth_width = source.width,
        .depth_height = source.height,
        .depth_stride_bytes = source.width * 2,
        .depth_unit_q40 = head.depth_unit_q40,
    };
    *camera = head.camera;
}
