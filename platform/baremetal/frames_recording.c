/* Frames of a recording. */
#include "frames.h"

#include "frame_reader.h"
#include "report.h"
#include "semihost.h"

const size_t frames_head_bytes = T3R_FRAME_READER_HEAD_BYTES;

static t3r_frame_reader reader;
static int32_t file;

static int read_file(void *user, uint64_t offset, void *bytes, size_t count)
{
    (void)user;
    return semihost_read(file, (uint32_t)offset, bytes, count);
}

static _Noreturn void refuse(const char *what, const char *why)
{
    report_text("error: ", what, ": ", why);
    semihost_exit(1);
}

void frames_open(const char *path, uint32_t width, uint32_t height, const frames_room *room)
{
    (void)width, (void)height; /* a recording says them itself */
    file = semihost_open(path, SEMIHOST_READ);
    if (file <= 0) {
        refuse(path, "it cannot be read");
    }
    const t3r_byte_source source = {read_file, NULL, (uint64_t)semihost_length(file)};
    if (t3r_frame_reader_open(&reader, &source, room->colour, room->colour_bytes, room->depth, room->depth_bytes) !=
        0) {
        refuse(path, reader.error);
    }
}

void frames_next(t3r_frame *frame, t3r_camera *camera)
{
    t3r_capture_frame next;
    if (t3r_frame_reader_next(&reader, &next) != T3R_CAPTURE_FRAME) {
        refuse("frames", reader.error != NULL ? reader.error : "there are too few");
    }
    if (!next.has_pose || !next.has_intrinsics) {
        report_failure("frame without a pose or intrinsics", next.index);
    }
    *frame = next.frame;
    *camera = next.camera;
}
