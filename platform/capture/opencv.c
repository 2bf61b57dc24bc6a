/* SPDX-License-Identifier: Apache-2.0 */
/* The adapter `opencv`: films, pictures and devices by OpenCV's VideoCapture. Colour is BGR or grey; depth comes from a
 * second VideoCapture with 16 bits a pixel, picture by picture. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "capture_adapter.h"
#include "host/module.h"
#include "host/reason.h"
#include "opencv_shim.h"
#include "source_name.h"

#define DEFAULT_RATE 30.0

typedef struct opencv_capture {
    t3r_capture capture; /* first: a t3r_capture * is an opencv_capture * */
    const t3r_opencv_shim *shim;
    t3r_capture_settings settings;
    char *url, *depth_url;            /* depth_url NULL = colour alone */
    char name[T3R_SOURCE_NAME_BYTES]; /* the URL's name in messages */
    t3r_opencv_film *film, *depth;
    double rate; /* frames a second of films */
    uint32_t index;
} opencv_capture;

static void close_films(opencv_capture *self)
{
    if (self->film != NULL) {
        self->shim->close(self->film);
    }
    if (self->depth != NULL) {
        self->shim->close(self->depth);
    }
    self->film = self->depth = NULL;
}

static int open_films(opencv_capture *self, char *error, size_t error_bytes)
{
    const t3r_capture_settings *s = &self->settings;
    t3r_opencv_request request = {
        .url = self->url,
        .name = self->name,
        .backend = s->backend,
        .width = s->width,
        .height = s->height,
        .rate_millihertz = s->rate_millihertz,
        .fourcc = s->format,
        .timeout_ms = s->stall_ms,
    };
    self->capture.note[0] = '\0';
    self->film = self->shim->open(&request, error, error_bytes);
    if (self->film == NULL) {
        return -1;
    }
    if (self->depth_url != NULL) {
        char depth_name[T3R_SOURCE_NAME_BYTES];
        t3r_source_name(self->depth_url, depth_name, sizeof depth_name);
        request.url = self->depth_url;
        request.name = depth_name;
        request.unchanged = true;
        request.fourcc = NULL;
        request.width = s->depth_width;
        request.height = s->depth_height;
        self->depth = self->shim->open(&request, error, error_bytes);
        if (self->depth == NULL) {
            close_films(self);
            return -1;
        }
        t3r_capture_remark(&self->capture, "%s: depth by the back end %s", depth_name,
                           self->shim->backend(self->depth));
    }
    /* numbered pictures have no rate */
    bool pictures = strcmp(self->shim->backend(self->film), "CV_IMAGES") == 0;
    double rate = s->rate_millihertz != 0 ? s->rate_millihertz / 1000.0 : pictures ? 0 : self->shim->rate(self->film);
    self->rate = isfinite(rate) && rate >= 0.001 && rate <= 10000 ? rate : DEFAULT_RATE;
    t3r_capture_remark(&self->capture, "%s: OpenCV %s, back end %s", self->name, self->shim->version,
                       self->shim->backend(self->film));
    if (pictures) {
        t3r_capture_remark(&self->capture, "%s: pictures as they are stored; trim3r import turns them as EXIF states",
                           self->name);
    }
    self->capture.clock = self->shim->live(self->film) ? "unknown" : pictures ? "synthetic" : "stream";
    return 0;
}

/* Returns NULL, or why the picture is no colour image. */
static const char *fill_colour(const t3r_opencv_picture *p, t3r_frame *frame)
{
    if (p->channels == 4) {
        return "has transparency, which trim3r import of its folder obeys";
    }
    if (p->bytes != 1 || (p->channels != 3 && p->channels != 1)) {
        return "is neither BGR nor grey of 8 bits";
    }
    if (p->width < 2 || p->height < 2 || p->width > T3R_MAX_SIDE || p->height > T3R_MAX_SIDE) {
        return "width or height is outside 2..4096";
    }
    frame->format = p->channels == 3 ? T3R_PIXEL_BGR24 : T3R_PIXEL_GREY;
    frame->width = p->width;
    frame->height = p->height;
    frame->planes[0] = p->data;
    frame->stride_bytes[0] = p->stride;
    return NULL;
}

static const char *fill_depth(const t3r_opencv_picture *p, uint64_t unit_q40, t3r_frame *frame)
{
    if (p->bytes != 2 || p->channels != 1) {
        return "depth is not of 16 bits a pixel";
    }
    if (p->width < 2 || p->height < 2 || p->width > T3R_MAX_SIDE || p->height > T3R_MAX_SIDE) {
        return "depth's width or height is outside 2..4096";
    }
    frame->depth = p->data; /* host order, which is little-endian wherever OpenCV is packaged */
    frame->depth_width = p->width;
    frame->depth_height = p->height;
    frame->depth_stride_bytes = p->stride;
    frame->depth_unit_q40 = unit_q40;
    return NULL;
}

/* Returns a frame's stamp. For devices it is the back end's position (V4L2's stamp, for example). Films run at their
 * own rate or the requested one, because back ends disagree on positions. */
static int64_t stamp_of(const opencv_capture *self, const t3r_opencv_picture *picture)
{
    double ms = picture->position_ms;
    if (self->shim->live(self->film) && isfinite(ms) && ms > 0 && ms < 2e12) {
        return (int64_t)llrint(ms * 1e6);
    }
    return (int64_t)llrint(self->index * 1e9 / self->rate);
}

static int end_of(opencv_capture *self)
{
    if (!self->shim->live(self->film)) {
        return T3R_CAPTURE_END;
    }
    int result = t3r_capture_lose(&self->capture, "%s: no image from the device", self->name);
    close_films(self);
    return result;
}

static int failed(opencv_capture *self, const char *what)
{
    t3r_capture_event event = {.kind = T3R_EVENT_CORRUPTED, .sequence = self->index++, .detail = what};
    t3r_reason(self->capture.error, sizeof self->capture.error, "%s: picture %u %s", self->name, event.sequence, what);
    t3r_capture_tell(&self->capture, event);
    return T3R_CAPTURE_FAILED;
}

static int next(t3r_capture *capture, t3r_capture_frame *frame)
{
    opencv_capture *self = (opencv_capture *)capture;
    if (self->film == NULL) {
        return T3R_CAPTURE_LOST;
    }
    t3r_opencv_picture picture, depth;
    char what[200] = "";
    int got = self->shim->read(self->film, &picture, what, sizeof what);
    int got_depth = self->depth != NULL && got > 0 ? self->shim->read(self->depth, &depth, what, sizeof what) : 0;
    if (got == 0) {
        return end_of(self);
    }
    t3r_capture_frame result = {0};
    const char *wrong = got < 0 || got_depth < 0 ? what : fill_colour(&picture, &result.frame);
    if (wrong == NULL && got_depth > 0) {
        wrong = fill_depth(&depth, capture->depth_unit_q40, &result.frame);
    }
    if (wrong != NULL) {
        return failed(self, wrong);
    }
    result.stamp_ns = result.depth_stamp_ns = stamp_of(self, &picture);
    result.index = result.sequence = self->index++;
    if (self->depth != NULL) {
        t3r_capture_tell(capture, (t3r_capture_event){.kind = got_depth > 0 ? T3R_EVENT_PAIRED : T3R_EVENT_ALONE,
                                                      .stamp_ns = result.stamp_ns,
                                                      .sequence = result.sequence,
                                                      .depth_sequence = result.sequence,
                                                      .gap_ns = got_depth > 0 ? 0 : INT64_MAX});
    }
    *frame = result;
    return t3r_capture_deliver(capture, frame);
}

static int reopen(t3r_capture *capture)
{
    opencv_capture *self = (opencv_capture *)capture;
    if (self->film != NULL && !self->shim->live(self->film)) {
        return T3R_CAPTURE_END;
    }
    close_films(self);
    return open_films(self, capture->error, sizeof capture->error) == 0 ? T3R_CAPTURE_FRAME : T3R_CAPTURE_LOST;
}

static void close_capture(t3r_capture *capture)
{
    opencv_capture *self = (opencv_capture *)capture;
    close_films(self);
    free(self->url);
    free(self->depth_url);
    free(self);
}

static t3r_capture *open_source(const char *url, const t3r_capture_settings *settings, char *error, size_t error_bytes)
{
    static const t3r_capture_operations operations = {next, reopen, close_capture};
    const t3r_opencv_shim *shim = t3r_module_table("opencv", error, error_bytes);
    if (shim == NULL) {
        return NULL;
    }
    opencv_capture *self = calloc(1, sizeof *self);
    if (self == NULL) {
        t3r_reason(error, error_bytes, "out of memory");
        return NULL;
    }
    self->capture.operations = &operations;
    self->capture.depth_unit_q40 = settings->depth_unit_q40;
    self->shim = shim;
    self->settings = *settings;
    t3r_source_name(url, self->name, sizeof self->name);
    self->url = strdup(url);
    self->depth_url = settings->depth != NULL ? strdup(settings->depth) : NULL;
    if (self->url == NULL || (settings->depth != NULL && self->depth_url == NULL)) {
        t3r_reason(error, error_bytes, "out of memory");
    } else if (open_films(self, error, error_bytes) == 0) {
        return &self->capture;
    }
    close_capture(&self->capture);
    return NULL;
}

const t3r_capture_source t3r_source_opencv = {
    .name = "opencv",
    .argument = "URL",
    .module = "opencv",
    .says = "VideoCapture of OpenCV: a film, pictures as p%03d.png, a stream's URL, a device's number",
    .open = open_source};
