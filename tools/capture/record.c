/* SPDX-License-Identifier: Apache-2.0 */
#include "capture/record.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "capture/capture_camera.h"
#include "cli/options/file_guard.h"
#include "host/reason.h"

#define MESSAGE_OVERHEAD 1024u /* bound for a message without its data, a camera_info, a pose or a chunk */
#define EVENT_BYTES 2048u
#define MOST_STAMP_NS ((int64_t)1000000000 << 31)

static t3r_recorder *recorder_of(capture_record *record)
{
    return (t3r_recorder *)record->recorder;
}

void capture_record_name(const char *path, uint32_t number, char *name, size_t bytes)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    size_t stem =
        dot == NULL || dot == path || (slash != NULL && dot < slash + 2) ? strlen(path) : (size_t)(dot - path);
    if (number == 0) {
        snprintf(name, bytes, "%s", path);
    } else {
        snprintf(name, bytes, "%.*s-%" PRIu32 "%s", (int)stem, path, number, path + stem);
    }
}

static int failed(capture_record *record)
{
    char name[400];
    capture_record_name(record->path, record->files > 0 ? record->files - 1 : 0, name, sizeof name);
    return t3r_reason(record->error, sizeof record->error, "%s: %s", name,
                      errno == EBUSY ? "another process records to it" : "cannot be written");
}

static int open_next(capture_record *record)
{
    char name[400];
    capture_record_name(record->path, record->files, name, sizeof name);
    if (file_guard_write(name, record->error, sizeof record->error) != 0 ||
        t3r_recording_file_open(&record->file, name, record->sync, record->error, sizeof record->error) != 0) {
        return -1;
    }
    record->files++;
    record->frames = 0;
    if (t3r_recorder_begin(recorder_of(record), t3r_recording_file_sink(&record->file), &record->header) != 0) {
        return failed(record);
    }
    return 0;
}

int capture_record_begin(capture_record *record, const char *path, uint64_t max_bytes, bool sync, const char *source,
                         const char *clock, uint64_t depth_unit_q40, const recording_options *how)
{
    record->path = path;
    record->max_bytes = max_bytes;
    record->sync = sync;
    record->files = 0;
    record->bytes = record->frames = 0;
    record->error[0] = '\0';
    record->file.fd = -1;
    record->header = (t3r_recording_header){
        .camera = "camera",
        .source = source,
        .clock = clock,
        .depth_unit = (double)depth_unit_q40 * 0x1p-40, /* below 2^47: exact */
        .events = true,
        .message_end = t3r_recording_file_message_end,
    };
    if (strlen(path) > 380) {
        return t3r_reason(record->error, sizeof record->error, "the recording's name has more than 380 bytes");
    }
    if (recording_options_apply(how, &record->header) != 0) {
        return t3r_reason(record->error, sizeof record->error, "out of memory");
    }
    return open_next(record);
}

static int end_file(capture_record *record)
{
    int wrong = t3r_recorder_end(recorder_of(record));
    record->bytes += t3r_recorder_offset(recorder_of(record));
    int closed = t3r_recording_file_close(&record->file);
    return wrong != 0 || closed != 0 ? failed(record) : 0;
}

/* Begins another file when this one has no room for `bytes` and its end. */
static int make_room(capture_record *record, uint64_t bytes)
{
    if (record->max_bytes == 0 ||
        t3r_recorder_offset(recorder_of(record)) + bytes + t3r_recorder_end_bytes(recorder_of(record)) <=
            record->max_bytes) {
        return 0;
    }
    if (record->frames == 0) {
        return t3r_reason(record->error, sizeof record->error,
                          "--max-bytes %" PRIu64 " does not hold one frame (%" PRIu64 " bytes and the file's frame)",
                          record->max_bytes, bytes);
    }
    return end_file(record) != 0 || open_next(record) != 0 ? -1 : make_room(record, bytes);
}

static uint64_t frame_bytes(const t3r_frame *f)
{
    uint64_t rows = f->height + (f->format == T3R_PIXEL_NV12 ? f->height / 2 : 0);
    uint64_t depth = f->depth != NULL ? (uint64_t)f->depth_width * f->depth_height * 2 : 0;
    /* a row without padding is no longer than its stride */
    return (uint64_t)f->stride_bytes[0] * rows + depth + 6 * MESSAGE_OVERHEAD;
}

int capture_record_frame(capture_record *record, const t3r_capture_frame *frame)
{
    const t3r_frame *f = &frame->frame;
    if (make_room(record, frame_bytes(f)) != 0) {
        return -1;
    }
    const t3r_recorded_frame recorded = {
        .stamp_ns = frame->stamp_ns,
        .format = f->format,
        .width = f->width,
        .height = f->height,
        .planes = {f->planes[0], f->planes[1]},
        .stride_bytes = {f->stride_bytes[0], f->stride_bytes[1]},
        .depth_z16 = f->depth,
        .depth_width = f->depth_width,
        .depth_height = f->depth_height,
        .depth_stride_bytes = f->depth_stride_bytes,
        .unposed = !frame->has_pose,
        .uncalibrated = !frame->has_intrinsics,
        .camera = capture_camera_recorded(frame),
    };
    if (t3r_recorder_frame(recorder_of(record), &recorded) != 0) {
        return failed(record);
    }
    if (t3r_recording_file_place(&record->file) != 0) {
        return failed(record);
    }
    record->frames++;
    return 0;
}

int capture_record_event(capture_record *record, const t3r_capture_event *event)
{
    char text[T3R_CAPTURE_EVENT_BYTES];
    t3r_recorder_level level = event->kind == T3R_EVENT_PAIRED || event->kind == T3R_EVENT_REOPENED ? T3R_RECORDER_INFO
                               : event->kind == T3R_EVENT_LOST                                      ? T3R_RECORDER_ERROR
                                                               : T3R_RECORDER_WARNING;
    int64_t stamp_ns = event->stamp_ns >= 0 && event->stamp_ns < MOST_STAMP_NS ? event->stamp_ns : 0;
    if (record->frames > 0 && make_room(record, EVENT_BYTES) != 0) {
        return -1;
    }
    t3r_capture_event_text(event, text);
    return t3r_recorder_event(recorder_of(record), stamp_ns, level, text) != 0 ? failed(record) : 0;
}

int capture_record_end(capture_record *record)
{
    int status = record->file.fd < 0 ? 0 : end_file(record);
    t3r_chunk_packer_close(record->header.packer);
    record->header.packer = NULL;
    return status;
}
