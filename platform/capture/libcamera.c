/* SPDX-License-Identifier: Apache-2.0 */
/* The adapter `libcamera`: one stream of a camera. Frames stay where the library put them. */
#include "libcamera.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "capture_adapter.h"
#include "host/module.h"
#include "host/reason.h"
#include "messages/pixel_layout.h"

#define FAR_AHEAD 0x80000000u /* a sequence "ahead" by more has gone backwards */
#define NO_BUFFER UINT32_MAX
#define MOST_STAMP_NS ((uint64_t)1000000000 << 31)

typedef struct libcamera_capture {
    t3r_capture capture; /* first: a t3r_capture * is a libcamera_capture * */
    const t3r_libcamera_shim *shim;
    t3r_capture_settings settings;
    char *camera;
    t3r_libcamera_stream *stream; /* NULL: closed */
    t3r_libcamera_agreed agreed;
    t3r_pixel_format format;
    uint32_t lent; /* the buffer of the frame delivered last */
    uint32_t index;
    bool has_sequence;
    uint32_t next_sequence, slow;
    int64_t interval_ns, last_stamp_ns, left_ns, alive_ns;
} libcamera_capture;

static int64_t now_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static void close_stream(libcamera_capture *self)
{
    if (self->stream != NULL) {
        self->shim->close(self->stream);
    }
    self->stream = NULL;
    self->lent = NO_BUFFER;
}

static bool format_of(const char *name, t3r_pixel_format *format)
{
    static const struct {
        const char *name;
        t3r_pixel_format format;
    } known[] = {{"YUYV", T3R_PIXEL_YUYV},  {"UYVY", T3R_PIXEL_UYVY},  {"NV12", T3R_PIXEL_NV12},
                 {"RGB3", T3R_PIXEL_RGB24}, {"BGR3", T3R_PIXEL_BGR24}, {"GREY", T3R_PIXEL_GREY}};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        if (strcmp(known[i].name, name) == 0) {
            *format = known[i].format;
            return true;
        }
    }
    return false;
}

/* Returns NULL, or what is wrong with the negotiated format: every row of every plane must lie in its buffer. */
static const char *check_agreed(libcamera_capture *self)
{
    const t3r_libcamera_agreed *a = &self->agreed;
    if (!format_of(a->format, &self->format)) {
        return "a format that is not read";
    }
    const char *wrong = t3r_pixel_size_error(self->format, a->width, a->height);
    if (wrong != NULL) {
        return wrong;
    }
    uint32_t row_bytes = t3r_pixel_row_bytes(self->format, a->width);
    if (a->stride < row_bytes || a->stride >= 1u << 19 || a->buffers < 2) {
        return "strides or buffers do not fit";
    }
    for (uint32_t i = 0; i < a->buffers; i++) {
        for (uint32_t p = 0; p < 2; p++) {
            uint32_t rows = t3r_pixel_rows(self->format, p, a->height);
            if (rows > 0 &&
                (a->buffer[i].plane[p] == NULL || (size_t)a->stride * (rows - 1) + row_bytes > a->buffer[i].bytes[p])) {
                return "a buffer is shorter than an image";
            }
        }
    }
    return NULL;
}

static int open_stream(libcamera_capture *self, char *error, size_t error_bytes)
{
    const t3r_libcamera_request request = {
        .camera = self->camera,
        .width = self->settings.width,
        .height = self->settings.height,
        .format = self->settings.format,
        .rate_millihertz = self->settings.rate_millihertz,
        .buffers = self->settings.buffers,
    };
    self->stream = self->shim->open(&request, &self->agreed, error, error_bytes);
    if (self->stream == NULL) {
        return -1;
    }
    const char *wrong = check_agreed(self);
    if (wrong != NULL) {
        close_stream(self);
        return t3r_reason(error, error_bytes, "libcamera:%s: %s", self->camera, wrong);
    }
    self->capture.note[0] = '\0';
    t3r_capture_remark(&self->capture, "%s: colour %" PRIu32 "x%" PRIu32 ", %s, %" PRIu32 " buffers", self->agreed.id,
                       self->agreed.width, self->agreed.height, self->agreed.format, self->agreed.buffers);
    self->has_sequence = false;
    self->left_ns = self->alive_ns = now_ns();
    return 0;
}

static void follow_sequence(libcamera_capture *self, const t3r_libcamera_done *done)
{
    uint32_t ahead = done->sequence - self->next_sequence;
    int64_t stamp_ns = (int64_t)done->stamp_ns;
    if (self->has_sequence && ahead > 0 && ahead < FAR_AHEAD) {
        t3r_capture_tell(&self->capture,
                         (t3r_capture_event){.kind = self->slow > 0 ? T3R_EVENT_DROPPED_SLOW : T3R_EVENT_DROPPED_DRIVER,
                                             .stamp_ns = stamp_ns,
                                             .sequence = done->sequence,
                                             .count = ahead});
    }
    if (self->has_sequence && ahead == 0 && stamp_ns > self->last_stamp_ns) {
        self->interval_ns = stamp_ns - self->last_stamp_ns;
    }
    self->slow -= self->slow > 0;
    self->has_sequence = true;
    self->next_sequence = done->sequence + 1;
    self->last_stamp_ns = stamp_ns;
}

static void fill(const libcamera_capture *self, uint32_t buffer, t3r_frame *frame)
{
    frame->format = self->format;
    frame->width = self->agreed.width;
    frame->height = self->agreed.height;
    for (uint32_t p = 0; p < 2 && t3r_pixel_rows(self->format, p, frame->height) > 0; p++) {
        frame->planes[p] = self->agreed.buffer[buffer].plane[p];
        frame->stride_bytes[p] = self->agreed.stride;
    }
}

static int give_back(libcamera_capture *self, uint32_t buffer)
{
    if (self->shim->queue(self->stream, buffer) == 0) {
        return 0;
    }
    return t3r_capture_lose(&self->capture, "libcamera:%s: takes no buffers", self->camera);
}

/* Turns a finished buffer into a frame; NOTHING if the buffer was damaged. */
static int deliver(libcamera_capture *self, const t3r_libcamera_done *done, t3r_capture_frame *frame)
{
    self->alive_ns = now_ns();
    if (done->index >= self->agreed.buffers) {
        return t3r_capture_lose(&self->capture, "libcamera:%s: finished a buffer that it did not hold", self->camera);
    }
    follow_sequence(self, done);
    if (!done->whole || done->bytes == 0 || done->stamp_ns >= MOST_STAMP_NS) {
        t3r_capture_tell(&self->capture,
                         (t3r_capture_event){.kind = T3R_EVENT_CORRUPTED,
                                             .stamp_ns = (int64_t)(done->stamp_ns % MOST_STAMP_NS),
                                             .sequence = done->sequence,
                                             .detail = !done->whole       ? "the library calls it failed"
                                                       : done->bytes == 0 ? "it is empty"
                                                                          : "its time stamp is outside 0..2^31 s"});
        return give_back(self, done->index) != 0 ? T3R_CAPTURE_LOST : T3R_CAPTURE_NOTHING;
    }
    *frame = (t3r_capture_frame){
        .index = self->index++,
        .sequence = done->sequence,
        .stamp_ns = (int64_t)done->stamp_ns,
        .depth_stamp_ns = (int64_t)done->stamp_ns,
    };
    fill(self, done->index, &frame->frame);
    self->lent = done->index;
    return t3r_capture_deliver(&self->capture, frame);
}

/* Waits for frames until the deadline; damaged ones do not end the wait. */
static int await(libcamera_capture *self, t3r_capture_frame *frame)
{
    int64_t until = now_ns() + (int64_t)self->settings.deadline_ms * 1000000;
    for (;;) {
        int64_t left_ms = (until - now_ns() + 999999) / 1000000;
        t3r_libcamera_done done;
        int got = self->shim->wait(self->stream, left_ms > 0 ? (uint32_t)left_ms : 0, &done);
        if (got < 0) {
            return t3r_capture_lose(&self->capture, "libcamera:%s: %s", self->camera,
                                    got == -1 ? "was unplugged" : "takes no buffers");
        }
        if (got == 0) {
            int64_t still_ms = (now_ns() - self->alive_ns) / 1000000;
            return still_ms < self->settings.stall_ms
                       ? T3R_CAPTURE_NOTHING
                       : t3r_capture_lose(&self->capture, "libcamera:%s: no image for %" PRId64 " ms", self->camera,
                                          still_ms);
        }
        int result = deliver(self, &done, frame);
        if (result != T3R_CAPTURE_NOTHING || now_ns() >= until) {
            return result;
        }
    }
}

static int next(t3r_capture *capture, t3r_capture_frame *frame)
{
    libcamera_capture *self = (libcamera_capture *)capture;
    if (self->stream == NULL) {
        return T3R_CAPTURE_LOST; /* already reported */
    }
    /* time that the library can fill buffers for while the caller holds one */
    int64_t lasts_ns = self->interval_ns * (self->agreed.buffers - (self->lent != NO_BUFFER));
    if (self->interval_ns > 0 && now_ns() - self->left_ns > lasts_ns) {
        self->slow = self->agreed.buffers;
    }
    int result = T3R_CAPTURE_NOTHING;
    if (self->lent != NO_BUFFER) {
        uint32_t buffer = self->lent;
        self->lent = NO_BUFFER;
        result = give_back(self, buffer) != 0 ? T3R_CAPTURE_LOST : T3R_CAPTURE_NOTHING;
    }
    result = result == T3R_CAPTURE_NOTHING ? await(self, frame) : result;
    self->left_ns = now_ns();
    if (result == T3R_CAPTURE_LOST) {
        close_stream(self);
    }
    return result;
}

static int reopen(t3r_capture *capture)
{
    libcamera_capture *self = (libcamera_capture *)capture;
    close_stream(self);
    return open_stream(self, capture->error, sizeof capture->error) == 0 ? T3R_CAPTURE_FRAME : T3R_CAPTURE_LOST;
}

static void close_capture(t3r_capture *capture)
{
    libcamera_capture *self = (libcamera_capture *)capture;
    close_stream(self);
    free(self->camera);
    free(self);
}

t3r_capture *t3r_libcamera_open_on(const t3r_libcamera_shim *shim, const char *camera,
                                   const t3r_capture_settings *settings, char *error, size_t error_bytes)
{
    static const t3r_capture_operations operations = {next, reopen, close_capture};
    if (settings->depth != NULL) {
        t3r_reason(error, error_bytes, "libcamera gives no depth: take colour and depth by v4l2");
        return NULL;
    }
    libcamera_capture *self = calloc(1, sizeof *self);
    if (self == NULL) {
        t3r_reason(error, error_bytes, "libcamera: out of memory");
        return NULL;
    }
    self->capture.operations = &operations;
    self->capture.clock = "boottime";
    self->capture.depth_unit_q40 = settings->depth_unit_q40;
    self->shim = shim;
    self->settings = *settings;
    self->lent = NO_BUFFER;
    self->camera = strdup(camera);
    if (self->camera != NULL && open_stream(self, error, error_bytes) == 0) {
        return &self->capture;
    }
    close_capture(&self->capture);
    return NULL;
}

static t3r_capture *open_source(const char *camera, const t3r_capture_settings *settings, char *error,
                                size_t error_bytes)
{
    const t3r_libcamera_shim *shim = t3r_module_table("libcamera", error, error_bytes);
    return shim != NULL ? t3r_libcamera_open_on(shim, camera, settings, error, error_bytes) : NULL;
}

static void list_devices(void (*say)(void *user, const char *line), void *user)
{
    char why[256];
    const t3r_libcamera_shim *shim = t3r_module_table("libcamera", why, sizeof why);
    if (shim != NULL) {
        shim->list(say, user);
    }
}

const t3r_capture_source t3r_source_libcamera = {.name = "libcamera",
                                                 .argument = "CAMERA",
                                                 .module = "libcamera",
                                                 .says = "cameras of libcamera: a number of its list, or a camera's id",
                                                 .open = open_source,
                                                 .devices = list_devices};
