/* Reads frames from a recording. */
#include "frames.h"

#include "recording/frame_reader.h"
#include "report.h"
#include "semihost.h"

static t3r_frame_reader reader;
static int32_t file;
static uint32_t frame_width, frame_height;

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

void frames_open(const char *path, uint32_t width, uint32_t height, const frames_strip *strip)
{
    frame_width = width;
    frame_height = height;
    file = semihost_open(path, SEMIHOST_READ);
    if (file <= 0) {
        refuse(path, "it cannot be read");
    }
    const t3r_byte_source source = {read_file, NULL, (uint64_t)semihost_length(file)};
    const size_t samples = (size_t)strip->rows * width;
    if (t3r_frame_reader_open(&reader, &source, strip->colour, samples * 3, strip->depth, samples * 2) != 0) {
        refuse(path, reader.error);
    }
}

void frames_next(t3r_frame *frame, t3r_camera *camera)
{
    t3r_capture_frame next;
    if (t3r_frame_reader_find(&reader, &next) != T3R_CAPTURE_FRAME) {
        refuse("frames", reader.error != NULL ? reader.error : "there are too few");
    }
    if (!next.has_pose || !next.has_intrinsics) {
        report_failure("frame without a pose or intrinsics", next.index);
    }
    *frame = next.frame;
    *camera = next.camera;
    if (frame->width != frame_width || frame->height != frame_height || frame->depth_width != frame_width ||
        frame->depth_height != frame_height) {
        report_failure("colour or depth of another size in frame", next.index);
    }
}

void frames_rows(t3r_frame *frame, uint32_t row, uint32_t rows)
{
    if (t3r_frame_reader_rows(&reader, frame, row, rows, row, rows) != 0) {
        refuse("frames", reader.error);
    }
}
