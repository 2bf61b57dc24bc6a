/* SPDX-License-Identifier: Apache-2.0 */
#include "v4l2_node.h"

#include <errno.h>
#include <inttypes.h>
#include <string.h>

#include "host/reason.h"
#include "messages/pixel_layout.h"

#define MOST_REFUSED 8u       /* consecutive EIO that count as a failure */
#define FAR_AHEAD 0x80000000u /* a sequence "ahead" by more has gone backwards */

static int control(const t3r_v4l2_node *node, unsigned long request, void *argument)
{
    return t3r_v4l2_ioctl(node->system, node->fd, request, argument);
}

/* ---- opening ---- */

static int check_capabilities(t3r_v4l2_node *node, char *error, size_t error_bytes)
{
    struct v4l2_capability can = {0};
    if (control(node, VIDIOC_QUERYCAP, &can) != 0) {
        return t3r_reason(error, error_bytes, "%s: %s", node->path,
                          errno == ENOTTY || errno == EINVAL ? "is not a video device" : strerror(errno));
    }
    uint32_t caps = (can.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? can.device_caps : can.capabilities;
    if ((caps & V4L2_CAP_VIDEO_CAPTURE) == 0) {
        return t3r_reason(error, error_bytes, "%s: %s", node->path,
                          (caps & V4L2_CAP_VIDEO_CAPTURE_MPLANE) != 0
                              ? "captures in separate planes only, which is not supported"
                              : "does not capture images");
    }
    if ((caps & V4L2_CAP_STREAMING) == 0) {
        return t3r_reason(error, error_bytes, "%s: has no streaming, which is needed", node->path);
    }
    return 0;
}

/* Returns NULL, or what is wrong with the format that the driver set. */
static const char *check_format(const t3r_v4l2_node *node, const struct v4l2_pix_format *set)
{
    if (set->pixelformat != node->format->fourcc) {
        return "the driver set another pixel format than it offered";
    }
    if (set->field != V4L2_FIELD_NONE && set->field != V4L2_FIELD_ANY) {
        return "its images are interlaced, which is not supported";
    }
    if (node->format->depth || node->format->jpeg) {
        bool fits = set->width >= 2 && set->height >= 2 && set->width <= T3R_MAX_SIDE && set->height <= T3R_MAX_SIDE;
        return fits ? NULL : "width or height is outside 2..4096";
    }
    return t3r_pixel_size_error(node->format->pixels, set->width, set->height);
}

static int set_format(t3r_v4l2_node *node, const t3r_v4l2_choice *choice, char *error, size_t error_bytes)
{
    struct v4l2_format set = {.type = V4L2_BUF_TYPE_VIDEO_CAPTURE};
    set.fmt.pix.width = choice->width;
    set.fmt.pix.height = choice->height;
    set.fmt.pix.pixelformat = choice->format->fourcc;
    set.fmt.pix.field = V4L2_FIELD_NONE;
    node->format = choice->format;
    if (control(node, VIDIOC_S_FMT, &set) != 0) {
        return t3r_reason(error, error_bytes, "%s: %s", node->path,
                          errno == EBUSY ? "another program captures from it" : strerror(errno));
    }
    const struct v4l2_pix_format *pix = &set.fmt.pix;
    const char *wrong = check_format(node, pix);
    if (wrong != NULL) {
        return t3r_reason(error, error_bytes, "%s: %s (%.4s, %" PRIu32 "x%" PRIu32 ")", node->path, wrong,
                          node->format->name, pix->width, pix->height);
    }
    node->width = pix->width;
    node->height = pix->height;
    node->needed_bytes = 0;
    if (!node->format->jpeg) {
        node->row_bytes = node->format->depth ? pix->width * 2 : t3r_pixel_row_bytes(node->format->pixels, pix->width);
        node->stride = pix->bytesperline != 0 ? pix->bytesperline : node->row_bytes;
        uint32_t rows = pix->height;
        if (!node->format->depth) {
            rows += t3r_pixel_rows(node->format->pixels, 1, pix->height);
        }
        /* below 2^19 x 2^13 */
        uint64_t needed = (uint64_t)node->stride * (rows - 1) + node->row_bytes;
        if (node->stride < node->row_bytes || node->stride >= 1u << 19 || needed > pix->sizeimage) {
            return t3r_reason(error, error_bytes,
                              "%s: the driver's sizes do not fit: %" PRIu32 " bytes a row, %" PRIu32 " in all",
                              node->path, pix->bytesperline, pix->sizeimage);
        }
        node->needed_bytes = (uint32_t)needed;
    }
    return 0;
}

/* Requests a rate; false when the driver keeps its own. */
static bool set_rate(t3r_v4l2_node *node, uint32_t rate_millihertz)
{
    struct v4l2_streamparm rate = {.type = V4L2_BUF_TYPE_VIDEO_CAPTURE};
    struct v4l2_fract *interval = &rate.parm.capture.timeperframe;
    bool kept = rate_millihertz == 0;
    if (rate_millihertz != 0) {
        interval->numerator = 1000;
        interval->denominator = rate_millihertz;
        if (control(node, VIDIOC_S_PARM, &rate) == 0) {
            uint64_t wished = (uint64_t)interval->numerator * rate_millihertz;
            uint64_t got = (uint64_t)interval->denominator * 1000;
            kept = wished * 100 <= got * 101 && got * 100 <= wished * 101;
        }
    } else if (control(node, VIDIOC_G_PARM, &rate) != 0) {
        interval->denominator = 0;
    }
    node->interval_ns =
        interval->denominator == 0 ? 0 : (int64_t)interval->numerator * 1000000000 / interval->denominator;
    return kept;
}

static int map_buffers(t3r_v4l2_node *node, uint32_t wished, char *error, size_t error_bytes)
{
    struct v4l2_requestbuffers request = {
        .count = wished, .type = V4L2_BUF_TYPE_VIDEO_CAPTURE, .memory = V4L2_MEMORY_MMAP};
    if (control(node, VIDIOC_REQBUFS, &request) != 0) {
        return t3r_reason(error, error_bytes, "%s: no buffers: %s", node->path,
                          errno == EBUSY ? "another program captures from it" : strerror(errno));
    }
    if (request.count < 2 || request.count > T3R_V4L2_MOST_BUFFERS) {
        return t3r_reason(error, error_bytes, "%s: gives %" PRIu32 " buffers, not 2 to %u", node->path, request.count,
                          T3R_V4L2_MOST_BUFFERS);
    }
    for (uint32_t i = 0; i < request.count; i++) {
        struct v4l2_buffer buffer = {.index = i, .type = request.type, .memory = request.memory};
        if (control(node, VIDIOC_QUERYBUF, &buffer) != 0) {
            return t3r_reason(error, error_bytes, "%s: buffer %" PRIu32 ": %s", node->path, i, strerror(errno));
        }
        if (buffer.length < node->needed_bytes) {
            return t3r_reason(error, error_bytes, "%s: buffer %" PRIu32 " is shorter than an image", node->path, i);
        }
        void *memory = node->system->map(node->system->user, node->fd, buffer.length, buffer.m.offset);
        if (memory == NULL) {
            return t3r_reason(error, error_bytes, "%s: buffer %" PRIu32 " cannot be mapped: %s", node->path, i,
                              strerror(errno));
        }
        node->buffers[i] = (t3r_v4l2_buffer){memory, buffer.length, false};
        node->buffer_count = i + 1;
        node->monotonic = (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
        node->end_of_frame = (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_EOF;
    }
    return 0;
}

static int start(t3r_v4l2_node *node, char *error, size_t error_bytes)
{
    for (uint32_t i = 0; i < node->buffer_count; i++) {
        int refused = t3r_v4l2_node_requeue(node, i);
        if (refused != 0) {
            return t3r_reason(error, error_bytes, "%s: buffer %" PRIu32 " cannot be queued: %s", node->path, i,
                              strerror(refused));
        }
    }
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (control(node, VIDIOC_STREAMON, &type) != 0) {
        return t3r_reason(error, error_bytes, "%s: does not start: %s", node->path, strerror(errno));
    }
    node->streaming = true;
    /* drivers without the event return EINVAL; their format cannot change */
    struct v4l2_event_subscription event = {.type = V4L2_EVENT_SOURCE_CHANGE};
    (void)control(node, VIDIOC_SUBSCRIBE_EVENT, &event);
    return 0;
}

static int open_device(t3r_v4l2_node *node, bool depth, const t3r_capture_settings *settings, bool *rate_kept,
                       char *error, size_t error_bytes)
{
    node->fd = node->system->open(node->system->user, node->path);
    if (node->fd < 0) {
        return t3r_reason(error, error_bytes, "%s: %s", node->path, strerror(errno));
    }
    if (check_capabilities(node, error, error_bytes) != 0) {
        return -1;
    }
    const t3r_v4l2_wish wish = {
        .depth = depth,
        .format = depth ? NULL : settings->format,
        .width = depth ? settings->depth_width : settings->width,
        .height = depth ? settings->depth_height : settings->height,
        .rate_millihertz = settings->rate_millihertz,
    };
    t3r_v4l2_choice choice;
    const char *wrong = t3r_v4l2_choose(node->system, node->fd, &wish, &choice);
    if (wrong != NULL) {
        return t3r_reason(error, error_bytes, "%s: %s%s%s", node->path, wrong, wish.format != NULL ? " " : "",
                          wish.format != NULL ? wish.format : "");
    }
    if (set_format(node, &choice, error, error_bytes) != 0) {
        return -1;
    }
    *rate_kept = set_rate(node, settings->rate_millihertz);
    if (map_buffers(node, settings->buffers, error, error_bytes) != 0) {
        return -1;
    }
    return start(node, error, error_bytes);
}

int t3r_v4l2_node_open(t3r_v4l2_node *node, const t3r_v4l2_system *system, const char *path, bool depth,
                       const t3r_capture_settings *settings, bool *rate_kept, char *error, size_t error_bytes)
{
    *node = (t3r_v4l2_node){.system = system, .path = path, .fd = -1};
    if (open_device(node, depth, settings, rate_kept, error, error_bytes) != 0) {
        t3r_v4l2_node_close(node);
        return -1;
    }
    return 0;
}

void t3r_v4l2_node_close(t3r_v4l2_node *node)
{
    const t3r_v4l2_system *system = node->system;
    if (node->fd < 0) {
        return;
    }
    if (node->streaming) {
        int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
        (void)control(node, VIDIOC_STREAMOFF, &type);
    }
    for (uint32_t i = 0; i < node->buffer_count; i++) {
        (void)system->unmap(system->user, node->buffers[i].memory, node->buffers[i].bytes);
    }
    (void)system->close(system->user, node->fd);
    node->fd = -1;
    node->streaming = false;
    node->buffer_count = 0;
}

/* ---- streaming ---- */

int t3r_v4l2_node_requeue(t3r_v4l2_node *node, uint32_t index)
{
    struct v4l2_buffer buffer = {.index = index, .type = V4L2_BUF_TYPE_VIDEO_CAPTURE, .memory = V4L2_MEMORY_MMAP};
    if (control(node, VIDIOC_QBUF, &buffer) != 0) {
        return errno != 0 ? errno : EIO;
    }
    node->buffers[index].in_driver = true;
    return 0;
}

uint32_t t3r_v4l2_node_queued(const t3r_v4l2_node *node)
{
    uint32_t queued = 0;
    for (uint32_t i = 0; i < node->buffer_count; i++) {
        queued += node->buffers[i].in_driver;
    }
    return queued;
}

void t3r_v4l2_node_was_away(t3r_v4l2_node *node, int64_t away_ns)
{
    if (node->interval_ns > 0 && away_ns > node->interval_ns * t3r_v4l2_node_queued(node)) {
        node->slow = node->buffer_count; /* the gap follows frames that were finished before it */
    }
}

static t3r_v4l2_fetched dequeue_failed(t3r_v4l2_node *node, int error, bool error_polled, char *what, size_t what_bytes)
{
    if (error == EAGAIN && !error_polled) {
        return T3R_V4L2_NONE;
    }
    t3r_reason(what, what_bytes, "%s: %s", node->path, error == EAGAIN ? "its queue is in error" : strerror(error));
    if (error == EIO && !error_polled && ++node->refused < MOST_REFUSED) {
        return T3R_V4L2_FAULT; /* a lost signal may cause it */
    }
    return T3R_V4L2_GONE;
}

/* Counts the frames that the sequence skips, and measures the interval between neighbouring stamps. */
static void follow_sequence(t3r_v4l2_node *node, t3r_v4l2_image *image)
{
    uint32_t ahead = image->sequence - node->next_sequence; /* modulo 2^32, as the driver counts */
    if (node->has_sequence && ahead < FAR_AHEAD) {
        image->missed = ahead;
        image->slow = ahead > 0 && node->slow > 0;
    }
    if (node->has_sequence && ahead == 0 && image->stamp_ns > node->last_stamp_ns) {
        node->interval_ns = image->stamp_ns - node->last_stamp_ns;
    }
    node->slow -= node->slow > 0;
    node->has_sequence = true;
    node->next_sequence = image->sequence + 1;
    node->last_stamp_ns = image->stamp_ns;
}

static const char *image_fault(const t3r_v4l2_node *node, const struct v4l2_buffer *buffer)
{
    if ((buffer->flags & V4L2_BUF_FLAG_ERROR) != 0) {
        return "the driver calls it corrupted";
    }
    if (buffer->bytesused > node->buffers[buffer->index].bytes) {
        return "the driver reports more bytes than the buffer has";
    }
    if (buffer->bytesused == 0 || buffer->bytesused < node->needed_bytes) {
        return "it is shorter than an image";
    }
    return NULL;
}

t3r_v4l2_fetched t3r_v4l2_node_fetch(t3r_v4l2_node *node, bool error_polled, t3r_v4l2_image *image, char *what,
                                     size_t what_bytes)
{
    struct v4l2_buffer buffer = {.type = V4L2_BUF_TYPE_VIDEO_CAPTURE, .memory = V4L2_MEMORY_MMAP};
    *image = (t3r_v4l2_image){0};
    if (control(node, VIDIOC_DQBUF, &buffer) != 0) {
        return dequeue_failed(node, errno, error_polled, what, what_bytes);
    }
    if (buffer.index >= node->buffer_count || !node->buffers[buffer.index].in_driver) {
        t3r_reason(what, what_bytes, "%s: the driver returned buffer %" PRIu32 ", which it did not hold", node->path,
                   (uint32_t)buffer.index);
        return T3R_V4L2_GONE;
    }
    node->refused = 0;
    node->buffers[buffer.index].in_driver = false;
    image->buffer = buffer.index;
    image->bytes = buffer.bytesused;
    image->sequence = buffer.sequence;
    image->arrived_ns = node->system->now_ns(node->system->user);
    image->stamp_ns = (int64_t)buffer.timestamp.tv_sec * 1000000000 + (int64_t)buffer.timestamp.tv_usec * 1000;
    image->stamp_ns = node->monotonic ? image->stamp_ns : image->arrived_ns;
    follow_sequence(node, image);
    const char *fault = image_fault(node, &buffer);
    if (fault == NULL) {
        return T3R_V4L2_IMAGE;
    }
    t3r_reason(what, what_bytes, "%s", fault);
    (void)t3r_v4l2_node_requeue(node, buffer.index); /* if refused, retried with the others */
    return T3R_V4L2_BROKEN;
}

bool t3r_v4l2_node_changed(t3r_v4l2_node *node)
{
    bool changed = false;
    for (int i = 0; i < 16; i++) {
        struct v4l2_event event = {0};
        if (control(node, VIDIOC_DQEVENT, &event) != 0) {
            break;
        }
        changed = changed || (event.type == V4L2_EVENT_SOURCE_CHANGE &&
                              (event.u.src_change.changes & V4L2_EVENT_SRC_CH_RESOLUTION) != 0);
    }
    return changed;
}
