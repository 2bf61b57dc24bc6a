/* SPDX-License-Identifier: Apache-2.0 */
/* The adapter `v4l2`: a colour node, and a depth node if one is named. Frames stay in the driver's buffers; a buffer
 * goes back to the driver with the call for the next frame. */
#include "v4l2.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "capture_adapter.h"
#include "host/reason.h"
#include "messages/pixel_layout.h"
#include "mjpeg.h"
#include "recording/frame_pairing.h"
#include "v4l2_node.h"

#define NS_PER_MS INT64_C(1000000)
#define PATIENCE_NS (100 * NS_PER_MS)             /* on top of the pairing distance */
#define MOST_STAMP_NS ((int64_t)1000000000 << 31) /* recordings keep seconds in 31 bits */
#define MOST_IDLE_ROUNDS 64u /* consecutive "ready" reports without an image before the driver counts as faulty */

enum { COLOUR, DEPTH, NODES };

typedef struct v4l2_capture {
    t3r_capture capture; /* first: a t3r_capture * is a v4l2_capture * */
    t3r_v4l2_system system;
    t3r_capture_settings settings;
    char *path[NODES]; /* NULL = no such node */
    t3r_v4l2_node node[NODES];
    uint32_t nodes;
    t3r_pairing pairing;                        /* pairs two nodes; with one node, only the colour queue is used */
    uint32_t bytes_used[T3R_V4L2_MOST_BUFFERS]; /* JPEG bytes in a colour buffer */
    t3r_mjpeg *mjpeg;
    uint8_t *rgb; /* decoded MJPG */
    size_t rgb_bytes;
    uint32_t index;
    uint64_t taken;            /* images dequeued, with broken ones */
    int64_t left_ns, alive_ns; /* end of the last call; arrival of the last colour image */
} v4l2_capture;

static int64_t now_ns(const v4l2_capture *self)
{
    return self->system.now_ns(self->system.user);
}

/* ---- opening ---- */

static void remark_node(v4l2_capture *self, uint32_t which, bool rate_kept)
{
    const t3r_v4l2_node *node = &self->node[which];
    t3r_capture_remark(&self->capture, "%s: %s %" PRIu32 "x%" PRIu32 ", %.4s, %" PRIu32 " buffers, stamps %s%s",
                       node->path, which == COLOUR ? "colour" : "depth", node->width, node->height, node->format->name,
                       node->buffer_count, !node->monotonic ? "on arrival" : "by the driver",
                       node->monotonic ? (node->end_of_frame ? " at the end of a frame" : " at the start of exposure")
                                       : "");
    if (!rate_kept) {
        t3r_capture_remark(&self->capture, "%s: the driver does not keep the rate that was asked for", node->path);
    }
}

/* Allocates room for decoded pictures; nothing else allocates. */
static int prepare_mjpeg(v4l2_capture *self, char *error, size_t error_bytes)
{
    size_t bytes = (size_t)self->node[COLOUR].width * self->node[COLOUR].height * 3;
    if (!self->node[COLOUR].format->jpeg) {
        return 0;
    }
    if (bytes > self->rgb_bytes) {
        free(self->rgb);
        self->rgb = malloc(bytes);
        self->rgb_bytes = self->rgb != NULL ? bytes : 0;
    }
#ifdef T3R_MJPEG
    self->mjpeg = self->mjpeg != NULL ? self->mjpeg : t3r_mjpeg_open();
#endif
    return self->rgb != NULL && self->mjpeg != NULL ? 0 : t3r_reason(error, error_bytes, "out of memory");
}

static void close_nodes(v4l2_capture *self)
{
    for (uint32_t i = 0; i < self->nodes; i++) {
        t3r_v4l2_node_close(&self->node[i]);
    }
    self->pairing.colour.count = self->pairing.depth.count = 0;
}

static int open_nodes(v4l2_capture *self, char *error, size_t error_bytes)
{
    self->capture.note[0] = '\0';
    for (uint32_t i = 0; i < self->nodes; i++) {
        bool rate_kept = true;
        if (t3r_v4l2_node_open(&self->node[i], &self->system, self->path[i], i == DEPTH, &self->settings, &rate_kept,
                               error, error_bytes) != 0) {
            close_nodes(self);
            return -1;
        }
        remark_node(self, i, rate_kept);
    }
    if (prepare_mjpeg(self, error, error_bytes) != 0) {
        close_nodes(self);
        return -1;
    }
    bool monotonic = true;
    uint32_t buffers = T3R_V4L2_MOST_BUFFERS;
    for (uint32_t i = 0; i < self->nodes; i++) {
        monotonic = monotonic && self->node[i].monotonic;
        buffers = self->node[i].buffer_count < buffers ? self->node[i].buffer_count : buffers;
    }
    for (uint32_t i = 0; i < self->nodes; i++) {
        self->node[i].monotonic = monotonic; /* two nodes share one clock */
    }
    self->capture.clock = monotonic ? "monotonic" : "arrival";
    self->pairing = (t3r_pairing){
        .most = buffers > 2 ? buffers - 2 : 1,
        .near_ns = self->settings.pair_ms * NS_PER_MS,
        .patience_ns = self->settings.pair_ms * NS_PER_MS + PATIENCE_NS,
    };
    self->left_ns = self->alive_ns = now_ns(self);
    return 0;
}

/* ---- frames ---- */

static t3r_v4l2_node *colour_node(v4l2_capture *self)
{
    return &self->node[COLOUR];
}

static bool waits(const t3r_pairing_queue *queue, uint32_t buffer)
{
    for (uint32_t i = 0; i < queue->count; i++) {
        if (queue->items[i].buffer == buffer) {
            return true;
        }
    }
    return false;
}

/* Gives back to the driver every buffer that it does not hold and that waits for no companion; a refused buffer stays
 * for the next call. Returns -1 if a node has no buffers left or is gone. */
static int give_back(v4l2_capture *self)
{
    for (uint32_t n = 0; n < self->nodes; n++) {
        t3r_v4l2_node *node = &self->node[n];
        const t3r_pairing_queue *queue = n == COLOUR ? &self->pairing.colour : &self->pairing.depth;
        int refused = 0;
        for (uint32_t i = 0; i < node->buffer_count; i++) {
            if (node->buffers[i].in_driver || waits(queue, i)) {
                continue;
            }
            int error = t3r_v4l2_node_requeue(node, i);
            if (error == 0) {
                continue;
            }
            refused = error;
            char what[160];
            t3r_reason(what, sizeof what, "%s: buffer %" PRIu32 " was not taken back: %s", node->path, i,
                       strerror(error));
            t3r_capture_tell(&self->capture, (t3r_capture_event){.kind = T3R_EVENT_FAULT, .detail = what});
        }
        if (refused == ENODEV || (refused != 0 && t3r_v4l2_node_queued(node) == 0)) {
            return t3r_capture_lose(&self->capture, "%s: takes no buffers: %s", node->path, strerror(refused));
        }
    }
    return 0;
}

static void tell_missed(v4l2_capture *self, uint32_t which, const t3r_v4l2_image *image)
{
    if (image->missed == 0) {
        return;
    }
    t3r_capture_event event = {.stamp_ns = image->stamp_ns, .count = image->missed};
    if (which == COLOUR) {
        event.kind = image->slow ? T3R_EVENT_DROPPED_SLOW : T3R_EVENT_DROPPED_DRIVER;
        event.sequence = image->sequence;
    } else {
        event.kind = T3R_EVENT_DEPTH_DROPPED;
        event.depth_sequence = image->sequence;
    }
    t3r_capture_tell(&self->capture, event);
}

static void tell_corrupted(v4l2_capture *self, const t3r_v4l2_image *image, const char *what)
{
    t3r_capture_tell(&self->capture, (t3r_capture_event){.kind = T3R_EVENT_CORRUPTED,
                                                         .stamp_ns = image->stamp_ns,
                                                         .sequence = image->sequence,
                                                         .detail = what});
}

/* Takes one image of a node into the queue of its kind. Returns 1: there may be more; 0: there is none; or LOST. */
static int take_image(v4l2_capture *self, uint32_t which, bool error_polled)
{
    t3r_v4l2_node *node = &self->node[which];
    char what[200] = "";
    t3r_v4l2_image image;
    t3r_v4l2_fetched got = t3r_v4l2_node_fetch(node, error_polled, &image, what, sizeof what);
    if (got == T3R_V4L2_IMAGE || got == T3R_V4L2_BROKEN) {
        self->alive_ns = which == COLOUR ? image.arrived_ns : self->alive_ns;
        self->taken++;
        tell_missed(self, which, &image);
    }
    bool stamped = image.stamp_ns >= 0 && image.stamp_ns < MOST_STAMP_NS;
    switch (got) {
    case T3R_V4L2_IMAGE:
        if (!stamped) {
            tell_corrupted(self, &image, "its time stamp is outside 0..2^31 s");
            (void)t3r_v4l2_node_requeue(node, image.buffer);
            return 1;
        }
        if (which == COLOUR) {
            self->bytes_used[image.buffer] = image.bytes;
        }
        (which == COLOUR ? t3r_pairing_add_colour : t3r_pairing_add_depth)(
            &self->pairing, (t3r_pairing_item){image.stamp_ns, image.arrived_ns, image.sequence, image.buffer});
        return 1;
    case T3R_V4L2_BROKEN:
        tell_corrupted(self, &image, what);
        return 1;
    case T3R_V4L2_FAULT:
        t3r_capture_tell(&self->capture, (t3r_capture_event){.kind = T3R_EVENT_FAULT, .detail = what});
        return 0;
    case T3R_V4L2_GONE:
        return t3r_capture_lose(&self->capture, "%s", what);
    case T3R_V4L2_NONE:
    default:
        return 0;
    }
}

static void fill_colour(const v4l2_capture *self, const t3r_pairing_item *item, t3r_frame *frame)
{
    const t3r_v4l2_node *node = &self->node[COLOUR];
    const uint8_t *memory = node->format->jpeg ? self->rgb : node->buffers[item->buffer].memory;
    frame->format = node->format->pixels;
    frame->width = node->width;
    frame->height = node->height;
    frame->planes[0] = memory;
    frame->stride_bytes[0] = node->format->jpeg ? node->width * 3 : node->stride;
    if (frame->format == T3R_PIXEL_NV12) {
        frame->planes[1] = memory + (size_t)node->stride * node->height;
        frame->stride_bytes[1] = node->stride;
    }
}

static void fill_depth(const v4l2_capture *self, const t3r_pairing_item *item, t3r_frame *frame)
{
    const t3r_v4l2_node *node = &self->node[DEPTH];
    frame->depth = node->buffers[item->buffer].memory;
    frame->depth_width = node->width;
    frame->depth_height = node->height;
    frame->depth_stride_bytes = node->stride;
    frame->depth_unit_q40 = self->capture.depth_unit_q40;
}

/* Returns NULL, or why the item's buffer holds no JPEG. */
static const char *decode(v4l2_capture *self, const t3r_pairing_item *item)
{
#ifdef T3R_MJPEG
    const t3r_v4l2_node *node = &self->node[COLOUR];
    if (node->format->jpeg) {
        return t3r_mjpeg_decode(self->mjpeg, node->buffers[item->buffer].memory, self->bytes_used[item->buffer],
                                node->width, node->height, self->rgb);
    }
#else
    (void)self;
    (void)item;
#endif
    return NULL;
}

/* Delivers the oldest colour image, with the oldest depth image if they belong together; NOTHING if it is damaged. */
static int deliver(v4l2_capture *self, bool with_depth, int64_t gap_ns, t3r_capture_frame *frame)
{
    t3r_pairing_item colour = t3r_pairing_take(&self->pairing.colour), depth = {0};
    if (with_depth) {
        depth = t3r_pairing_take(&self->pairing.depth);
    }
    const char *wrong = decode(self, &colour);
    if (wrong != NULL) {
        t3r_capture_tell(&self->capture, (t3r_capture_event){.kind = T3R_EVENT_CORRUPTED,
                                                             .stamp_ns = colour.stamp_ns,
                                                             .sequence = colour.sequence,
                                                             .detail = wrong});
        if (with_depth) {
            t3r_capture_tell(&self->capture, (t3r_capture_event){.kind = T3R_EVENT_DEPTH_ALONE,
                                                                 .stamp_ns = depth.stamp_ns,
                                                                 .depth_sequence = depth.sequence});
        }
        return give_back(self) != 0 ? T3R_CAPTURE_LOST : T3R_CAPTURE_NOTHING;
    }
    *frame = (t3r_capture_frame){
        .index = self->index++,
        .sequence = colour.sequence,
        .stamp_ns = colour.stamp_ns,
        .depth_stamp_ns = with_depth ? depth.stamp_ns : colour.stamp_ns,
    };
    fill_colour(self, &colour, &frame->frame);
    if (with_depth) {
        fill_depth(self, &depth, &frame->frame);
    }
    if (self->nodes > 1) {
        t3r_capture_tell(&self->capture, (t3r_capture_event){.kind = with_depth ? T3R_EVENT_PAIRED : T3R_EVENT_ALONE,
                                                             .stamp_ns = colour.stamp_ns,
                                                             .sequence = colour.sequence,
                                                             .depth_sequence = depth.sequence,
                                                             .gap_ns = gap_ns});
    }
    return t3r_capture_deliver(&self->capture, frame);
}

/* Returns a frame of the images that have arrived, or NOTHING. Each round takes an image off a queue, so there are at
 * most 2 x most + 1 rounds. */
static int decide(v4l2_capture *self, t3r_capture_frame *frame)
{
    if (self->nodes == 1) {
        return self->pairing.colour.count > 0 ? deliver(self, false, 0, frame) : T3R_CAPTURE_NOTHING;
    }
    for (;;) {
        int64_t gap_ns;
        switch (t3r_pairing_decide(&self->pairing, now_ns(self), &gap_ns)) {
        case T3R_PAIRING_BOTH:
            return deliver(self, true, gap_ns, frame);
        case T3R_PAIRING_COLOUR:
            return deliver(self, false, gap_ns, frame);
        case T3R_PAIRING_NOT_DEPTH: {
            t3r_pairing_item depth = t3r_pairing_take(&self->pairing.depth);
            t3r_capture_tell(&self->capture, (t3r_capture_event){.kind = T3R_EVENT_DEPTH_ALONE,
                                                                 .stamp_ns = depth.stamp_ns,
                                                                 .depth_sequence = depth.sequence});
            if (give_back(self) != 0) {
                return T3R_CAPTURE_LOST;
            }
            break;
        }
        case T3R_PAIRING_WAIT:
        default:
            return T3R_CAPTURE_NOTHING;
        }
    }
}

/* Waits until `until_ns`, at most, for an image of any node. Returns 1: take images; 0: the time is over or a signal
 * came. */
static int await(v4l2_capture *self, int64_t until_ns, bool error_polled[NODES])
{
    struct pollfd fds[NODES];
    int64_t now = now_ns(self);
    int64_t left_ms = until_ns <= now ? 0 : (until_ns - now + NS_PER_MS - 1) / NS_PER_MS;
    for (uint32_t i = 0; i < self->nodes; i++) {
        fds[i] = (struct pollfd){.fd = self->node[i].fd, .events = POLLIN | POLLPRI};
    }
    int ready = self->system.poll(self->system.user, fds, self->nodes, (int)left_ms);
    if (ready < 0) {
        return errno == EINTR ? 0 : t3r_capture_lose(&self->capture, "%s: poll: %s", self->path[0], strerror(errno));
    }
    if (ready == 0) {
        return 0;
    }
    for (uint32_t i = 0; i < self->nodes; i++) {
        error_polled[i] = (fds[i].revents & (POLLERR | POLLHUP | POLLNVAL)) != 0;
        if ((fds[i].revents & POLLPRI) != 0 && t3r_v4l2_node_changed(&self->node[i])) {
            return t3r_capture_lose(&self->capture, "%s: its format changed", self->path[i]);
        }
    }
    return 1;
}

/* Takes all images that are ready while there is room. */
static int take_images(v4l2_capture *self, const bool error_polled[NODES])
{
    for (uint32_t i = 0; i < self->nodes; i++) {
        const t3r_pairing_queue *queue = i == COLOUR ? &self->pairing.colour : &self->pairing.depth;
        uint32_t room = self->nodes == 1 ? 1 : self->pairing.most;
        int got = 1;
        /* broken images take no room, and at most all buffers are ready at once */
        for (uint32_t k = 0; k < T3R_V4L2_MOST_BUFFERS && got == 1 && queue->count < room; k++) {
            got = take_image(self, i, error_polled[i]);
        }
        if (got < 0) {
            return got;
        }
    }
    return 0;
}

static int next(t3r_capture *capture, t3r_capture_frame *frame)
{
    v4l2_capture *self = (v4l2_capture *)capture;
    if (colour_node(self)->fd < 0) {
        return T3R_CAPTURE_LOST; /* already reported */
    }
    int64_t start = now_ns(self), until = start + self->settings.deadline_ms * NS_PER_MS;
    for (uint32_t i = 0; i < self->nodes; i++) {
        t3r_v4l2_node_was_away(&self->node[i], start - self->left_ns);
    }
    int result = give_back(self) != 0 ? T3R_CAPTURE_LOST : decide(self, frame);
    uint32_t idle = 0;
    while (result == T3R_CAPTURE_NOTHING) {
        bool error_polled[NODES] = {false, false};
        uint64_t taken = self->taken;
        int ready = await(self, until, error_polled);
        if (ready <= 0) {
            result = ready == 0 ? decide(self, frame) : T3R_CAPTURE_LOST;
            break;
        }
        if (take_images(self, error_polled) != 0) {
            result = T3R_CAPTURE_LOST;
            break;
        }
        result = decide(self, frame);
        idle = self->taken == taken ? idle + 1 : 0;
        if (result == T3R_CAPTURE_NOTHING && idle > MOST_IDLE_ROUNDS) {
            result = t3r_capture_lose(&self->capture, "%s: reports images that it does not have", self->path[0]);
        }
        if (result == T3R_CAPTURE_NOTHING && now_ns(self) >= until) {
            break;
        }
    }
    self->left_ns = now_ns(self);
    int64_t still_ns = self->left_ns - self->alive_ns;
    if (result == T3R_CAPTURE_NOTHING && still_ns >= self->settings.stall_ms * NS_PER_MS) {
        result = t3r_capture_lose(&self->capture, "%s: no image for %" PRId64 " ms", self->path[COLOUR],
                                  still_ns / NS_PER_MS);
    }
    if (result == T3R_CAPTURE_LOST) {
        close_nodes(self);
    }
    return result;
}

static int reopen(t3r_capture *capture)
{
    v4l2_capture *self = (v4l2_capture *)capture;
    close_nodes(self);
    return open_nodes(self, capture->error, sizeof capture->error) == 0 ? T3R_CAPTURE_FRAME : T3R_CAPTURE_LOST;
}

static void close_capture(t3r_capture *capture)
{
    v4l2_capture *self = (v4l2_capture *)capture;
    close_nodes(self);
#ifdef T3R_MJPEG
    t3r_mjpeg_close(self->mjpeg);
#endif
    free(self->rgb);
    free(self->path[COLOUR]);
    free(self->path[DEPTH]);
    free(self);
}

t3r_capture *t3r_v4l2_open_on(const t3r_v4l2_system *system, const char *device, const t3r_capture_settings *settings,
                              char *error, size_t error_bytes)
{
    static const t3r_capture_operations operations = {next, reopen, close_capture};
    v4l2_capture *self = calloc(1, sizeof *self);
    if (self == NULL) {
        t3r_reason(error, error_bytes, "%s: out of memory", device);
        return NULL;
    }
    self->capture.operations = &operations;
    self->capture.depth_unit_q40 = settings->depth_unit_q40;
    self->system = *system;
    self->settings = *settings;
    self->nodes = settings->depth != NULL ? 2 : 1;
    self->node[COLOUR].fd = self->node[DEPTH].fd = -1;
    self->path[COLOUR] = strdup(device);
    self->path[DEPTH] = settings->depth != NULL ? strdup(settings->depth) : NULL;
    bool copied = self->path[COLOUR] != NULL && (settings->depth == NULL || self->path[DEPTH] != NULL);
    if (!copied || open_nodes(self, error, error_bytes) != 0) {
        if (!copied) {
            t3r_reason(error, error_bytes, "%s: out of memory", device);
        }
        close_capture(&self->capture);
        return NULL;
    }
    return &self->capture;
}

static t3r_capture *open_source(const char *device, const t3r_capture_settings *settings, char *error,
                                size_t error_bytes)
{
    return t3r_v4l2_open_on(&t3r_v4l2_kernel, device, settings, error, error_bytes);
}

const t3r_capture_source t3r_source_v4l2 = {.name = "v4l2",
                                            .argument = "DEVICE",
                                            .says = "cameras of Linux: a device such as /dev/video0",
                                            .open = open_source,
                                            .devices = t3r_v4l2_devices};
