/* SPDX-License-Identifier: Apache-2.0 */
#include "fake_v4l2.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_FD = 100, CALLERS = 0, QUEUED = 1, DONE = 2 };

uint8_t fake_byte(uint32_t number, uint32_t i)
{
    return (uint8_t)(number * 37 + i * 11 + i / 251);
}

uint32_t fake_image_bytes(const fake_node *node)
{
    bool planes = node->format.pixelformat == V4L2_PIX_FMT_NV12;
    return node->format.bytesperline * node->format.height * (planes ? 3 : 2) / 2;
}

static uint32_t fill_plainly(void *user, const fake_node *node, uint32_t number, uint8_t *memory)
{
    (void)user;
    uint32_t bytes = fake_image_bytes(node);
    for (uint32_t i = 0; i < bytes; i++) {
        memory[i] = fake_byte(number, i);
    }
    return bytes;
}

static void start_node(fake_node *node, const char *path, uint32_t format)
{
    *node = (fake_node){
        .path = path,
        .formats = {format},
        .sizes = {{32, 16, 30}},
        .first_ns = 5000000000,
        .interval_ns = 33333333,
        .fill = fill_plainly,
        .flag_error_at = UINT32_MAX,
        .short_at = UINT32_MAX,
        .empty_at = UINT32_MAX,
        .wrong_index_at = UINT32_MAX,
        .drop_from = UINT32_MAX,
        .stall_at = UINT32_MAX,
        .unplug_at = UINT32_MAX,
        .fatal_at = UINT32_MAX,
        .change_at = UINT32_MAX,
    };
}

void fake_start(fake_v4l2 *fake)
{
    *fake = (fake_v4l2){.nodes = 1, .now_ns = 4900000000};
    start_node(&fake->node[0], "/dev/video0", V4L2_PIX_FMT_YUYV);
}

void fake_add_depth(fake_v4l2 *fake)
{
    fake->nodes = 2;
    start_node(&fake->node[1], "/dev/video2", V4L2_PIX_FMT_Z16);
}

bool fake_clean(const fake_v4l2 *fake)
{
    for (uint32_t i = 0; i < fake->nodes; i++) {
        if (fake->node[i].opened != 0 || fake->node[i].mapped != 0) {
            return false;
        }
    }
    return fake->misused == 0;
}

/* ---- the sensor ---- */

static void finish(fake_node *node)
{
    uint32_t number = node->number, index = node->queue[0];
    memmove(node->queue, node->queue + 1, --node->queued * sizeof node->queue[0]);
    node->state[index] = DONE;
    node->done[node->finished++] = index;
    struct v4l2_buffer *b = &node->filled[index];
    int64_t stamp = node->next_ns + node->jitter_ns[number % 8];
    *b = (struct v4l2_buffer){.index = index, .sequence = node->first_sequence + number};
    b->flags = node->timestamp_flags != 0 ? node->timestamp_flags : V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
    b->timestamp.tv_sec = stamp / 1000000000;
    b->timestamp.tv_usec = stamp % 1000000000 / 1000;
    b->bytesused = node->fill(node->user, node, number, node->memory[index]);
    b->bytesused = number == node->empty_at ? 0 : number == node->short_at ? b->bytesused / 2 : b->bytesused;
    b->flags |= number == node->flag_error_at ? V4L2_BUF_FLAG_ERROR : 0u;
    if (number == node->wrong_index_at) {
        b->index = node->buffer_count + 3;
    }
}

/* Makes all images whose time has come. */
static void run_node(fake_node *node, int64_t now_ns)
{
    while (node->streaming && node->next_ns <= now_ns) {
        uint32_t number = node->number;
        bool lost = number >= node->drop_from && number - node->drop_from < node->drop_count;
        if (number >= node->unplug_at) {
            node->gone = true;
        }
        if (number >= node->stall_at || node->gone || number >= node->fatal_at) {
            break;
        }
        node->changed = node->changed || number == node->change_at;
        if (!lost && node->queued > 0) {
            finish(node);
        }
        node->number++;
        node->next_ns += node->interval_ns;
    }
}

static void run(fake_v4l2 *fake)
{
    for (uint32_t i = 0; i < fake->nodes; i++) {
        run_node(&fake->node[i], fake->now_ns);
    }
}

void fake_sleep(fake_v4l2 *fake, int64_t ns)
{
    fake->now_ns += ns;
    run(fake);
}

/* ---- requested faults ---- */

static int fault(fake_v4l2 *fake, unsigned long call)
{
    fake->calls++;
    for (int i = 0; i < FAKE_FAULTS; i++) {
        fake_fault *f = &fake->faults[i];
        if (f->times == 0 || (f->call != call && f->call != FAKE_ANY)) {
            continue;
        }
        if (f->skip > 0) {
            f->skip--;
            continue;
        }
        f->times--;
        return f->error;
    }
    return 0;
}

static int fail(int error)
{
    errno = error;
    return -1;
}

/* ---- ioctls ---- */

static int set_format(fake_node *node, struct v4l2_format *f)
{
    struct v4l2_pix_format *pix = &f->fmt.pix;
    bool known = false;
    for (int i = 0; i < FAKE_FORMATS; i++) {
        known = known || node->formats[i] == pix->pixelformat;
    }
    pix->pixelformat = known ? pix->pixelformat : node->formats[0];
    uint32_t best = UINT32_MAX, width = pix->width, height = pix->height;
    for (int i = 0; i < FAKE_SIZES && node->sizes[i].width != 0; i++) {
        uint32_t w = node->sizes[i].width, h = node->sizes[i].height;
        uint32_t away = (w > width ? w - width : width - w) + (h > height ? h - height : height - h);
        if (away < best) {
            best = away;
            pix->width = w;
            pix->height = h;
        }
    }
    bool one = pix->pixelformat == V4L2_PIX_FMT_GREY || pix->pixelformat == V4L2_PIX_FMT_NV12;
    bool three = pix->pixelformat == V4L2_PIX_FMT_RGB24 || pix->pixelformat == V4L2_PIX_FMT_BGR24;
    pix->bytesperline = pix->width * (one ? 1 : three ? 3 : 2) + node->padding;
    pix->field = node->field != 0 ? node->field : V4L2_FIELD_NONE;
    pix->sizeimage = pix->bytesperline * pix->height * (pix->pixelformat == V4L2_PIX_FMT_NV12 ? 3 : 2) / 2;
    node->format = *pix;
    return 0;
}

static int request_buffers(fake_node *node, struct v4l2_requestbuffers *r)
{
    uint32_t count = node->most_buffers != 0 && r->count > node->most_buffers ? node->most_buffers : r->count;
    r->count = count < FAKE_BUFFERS ? count : FAKE_BUFFERS;
    node->bytes = fake_image_bytes(node) + 64;
    for (uint32_t i = 0; i < r->count; i++) {
        free(node->memory[i]);
        node->memory[i] = calloc(node->bytes, 1);
        node->state[i] = CALLERS;
    }
    node->buffer_count = r->count;
    return 0;
}

static int query_buffer(fake_node *node, struct v4l2_buffer *b)
{
    if (b->index >= node->buffer_count) {
        return fail(EINVAL);
    }
    b->length = node->bytes;
    b->m.offset = b->index * 4096;
    b->flags = node->timestamp_flags != 0 ? node->timestamp_flags : V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
    return 0;
}

static int queue_buffer(fake_v4l2 *fake, fake_node *node, const struct v4l2_buffer *b)
{
    if (b->index >= node->buffer_count || node->state[b->index] != CALLERS) {
        fake->misused++;
        return fail(EINVAL);
    }
    node->state[b->index] = QUEUED;
    node->queue[node->queued++] = b->index;
    return 0;
}

static int dequeue_buffer(fake_node *node, struct v4l2_buffer *b)
{
    if (node->number >= node->fatal_at) {
        return fail(EIO);
    }
    if (!node->streaming) {
        return fail(EINVAL);
    }
    if (node->finished == 0) {
        return fail(EAGAIN);
    }
    uint32_t index = node->done[0];
    memmove(node->done, node->done + 1, --node->finished * sizeof node->done[0]);
    node->state[index] = CALLERS;
    *b = node->filled[index];
    b->length = node->bytes;
    return 0;
}

static int stream(fake_v4l2 *fake, fake_node *node, bool on)
{
    node->streaming = on;
    node->queued = on ? node->queued : 0;
    node->finished = 0;
    for (uint32_t i = 0; i < FAKE_BUFFERS && !on; i++) {
        node->state[i] = CALLERS;
    }
    node->next_ns = fake->now_ns > node->first_ns ? fake->now_ns : node->first_ns;
    return 0;
}

static int enumerate(const fake_node *node, unsigned long request, void *argument)
{
    if (request == VIDIOC_ENUM_FMT) {
        struct v4l2_fmtdesc *d = argument;
        if (d->index >= FAKE_FORMATS || node->formats[d->index] == 0) {
            return fail(EINVAL);
        }
        d->pixelformat = node->formats[d->index];
        return 0;
    }
    if (request == VIDIOC_ENUM_FRAMESIZES) {
        struct v4l2_frmsizeenum *s = argument;
        if (s->index >= FAKE_SIZES || node->sizes[s->index].width == 0) {
            return fail(EINVAL);
        }
        s->type = V4L2_FRMSIZE_TYPE_DISCRETE;
        s->discrete.width = node->sizes[s->index].width;
        s->discrete.height = node->sizes[s->index].height;
        return 0;
    }
    struct v4l2_frmivalenum *v = argument;
    for (int i = 0; i < FAKE_SIZES; i++) {
        if (v->index == 0 && node->sizes[i].rate != 0 && node->sizes[i].width == v->width &&
            node->sizes[i].height == v->height) {
            v->type = V4L2_FRMIVAL_TYPE_DISCRETE;
            v->discrete = (struct v4l2_fract){1, node->sizes[i].rate};
            return 0;
        }
    }
    return fail(EINVAL);
}

static int answer(fake_v4l2 *fake, fake_node *node, unsigned long request, void *argument)
{
    switch (request) {
    case VIDIOC_QUERYCAP: {
        struct v4l2_capability *c = argument;
        c->capabilities = V4L2_CAP_DEVICE_CAPS;
        c->device_caps = node->capabilities != 0 ? node->capabilities : V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
        return 0;
    }
    case VIDIOC_ENUM_FMT:
    case VIDIOC_ENUM_FRAMESIZES:
    case VIDIOC_ENUM_FRAMEINTERVALS:
        return enumerate(node, request, argument);
    case VIDIOC_S_FMT:
        return set_format(node, argument);
    case VIDIOC_S_PARM:
    case VIDIOC_G_PARM: {
        struct v4l2_streamparm *p = argument;
        p->parm.capture.timeperframe = (struct v4l2_fract){(uint32_t)node->interval_ns, 1000000000};
        return 0;
    }
    case VIDIOC_REQBUFS:
        return request_buffers(node, argument);
    case VIDIOC_QUERYBUF:
        return query_buffer(node, argument);
    case VIDIOC_QBUF:
        return queue_buffer(fake, node, argument);
    case VIDIOC_DQBUF:
        return dequeue_buffer(node, argument);
    case VIDIOC_STREAMON:
        return stream(fake, node, true);
    case VIDIOC_STREAMOFF:
        return stream(fake, node, false);
    case VIDIOC_SUBSCRIBE_EVENT:
        node->subscribed = true;
        return 0;
    case VIDIOC_DQEVENT: {
        struct v4l2_event *e = argument;
        if (!node->changed) {
            return fail(ENOENT);
        }
        node->changed = false;
        e->type = V4L2_EVENT_SOURCE_CHANGE;
        e->u.src_change.changes = V4L2_EVENT_SRC_CH_RESOLUTION;
        return 0;
    }
    default:
        fake->misused++;
        return fail(ENOTTY);
    }
}

/* ---- the table ---- */

static fake_node *node_of(fake_v4l2 *fake, int fd)
{
    if (fd < FIRST_FD || fd >= FIRST_FD + (int)fake->nodes || fake->node[fd - FIRST_FD].opened == 0) {
        fake->misused++;
        return NULL;
    }
    return &fake->node[fd - FIRST_FD];
}

static int fake_open(void *user, const char *path)
{
    fake_v4l2 *fake = user;
    int error = fault(fake, FAKE_OPEN);
    for (uint32_t i = 0; i < fake->nodes && error == 0; i++) {
        if (strcmp(fake->node[i].path, path) == 0) {
            fake->node[i].opened++;
            return FIRST_FD + (int)i;
        }
    }
    return fail(error != 0 ? error : ENOENT);
}

static int fake_ioctl(void *user, int fd, unsigned long request, void *argument)
{
    fake_v4l2 *fake = user;
    fake_node *node = node_of(fake, fd);
    int error = fault(fake, request);
    if (node == NULL || node->gone || error != 0) {
        return fail(node == NULL ? EBADF : node->gone ? ENODEV : error);
    }
    run(fake);
    return answer(fake, node, request, argument);
}

static void *fake_map(void *user, int fd, size_t bytes, int64_t offset)
{
    fake_v4l2 *fake = user;
    fake_node *node = node_of(fake, fd);
    int error = fault(fake, FAKE_MAP);
    if (node == NULL || error != 0 || bytes != node->bytes || offset / 4096 >= node->buffer_count) {
        errno = error != 0 ? error : EINVAL;
        return NULL;
    }
    node->mapped++;
    return node->memory[offset / 4096];
}

static int fake_unmap(void *user, void *memory, size_t bytes)
{
    fake_v4l2 *fake = user;
    for (uint32_t i = 0; i < fake->nodes; i++) {
        fake_node *node = &fake->node[i];
        for (uint32_t k = 0; k < FAKE_BUFFERS; k++) {
            if (node->memory[k] == memory && memory != NULL && bytes == node->bytes) {
                node->mapped--;
                return 0;
            }
        }
    }
    fake->misused++;
    return fail(EINVAL);
}

static short events_of(const fake_node *node)
{
    if (node->gone) {
        return POLLERR | POLLHUP;
    }
    if (node->number >= node->fatal_at || !node->streaming || (node->queued == 0 && node->finished == 0)) {
        return POLLERR;
    }
    return (short)((node->finished > 0 || node->ready_lies ? POLLIN : 0) | (node->changed ? POLLPRI : 0));
}

static int64_t next_event_ns(const fake_v4l2 *fake)
{
    int64_t next = INT64_MAX;
    for (uint32_t i = 0; i < fake->nodes; i++) {
        const fake_node *node = &fake->node[i];
        if (node->streaming && node->number < node->stall_at && node->next_ns < next) {
            next = node->next_ns;
        }
    }
    return next;
}

static int fake_poll(void *user, struct pollfd *fds, uint32_t count, int timeout_ms)
{
    fake_v4l2 *fake = user;
    int64_t until = fake->now_ns + (int64_t)timeout_ms * 1000000;
    int error = fault(fake, FAKE_POLL);
    if (error != 0) {
        return fail(error);
    }
    for (;;) {
        int ready = 0;
        run(fake);
        for (uint32_t i = 0; i < count; i++) {
            fake_node *node = node_of(fake, fds[i].fd);
            fds[i].revents = node == NULL ? POLLNVAL : events_of(node);
            ready += fds[i].revents != 0;
        }
        int64_t next = next_event_ns(fake);
        if (ready > 0 || fake->now_ns >= until) {
            return ready;
        }
        fake->now_ns = next < until && next > fake->now_ns ? next : until;
    }
}

static int fake_close(void *user, int fd)
{
    fake_v4l2 *fake = user;
    fake_node *node = node_of(fake, fd);
    if (node == NULL) {
        return fail(EBADF);
    }
    node->opened--;
    /* plugged in again, or the driver has recovered */
    if (!node->stays) {
        node->unplug_at = node->gone ? UINT32_MAX : node->unplug_at;
        node->fatal_at = node->number >= node->fatal_at ? UINT32_MAX : node->fatal_at;
        node->stall_at = node->number >= node->stall_at ? UINT32_MAX : node->stall_at;
    }
    node->gone = node->streaming = false;
    node->queued = node->finished = 0;
    for (uint32_t i = 0; i < FAKE_BUFFERS; i++) {
        free(node->memory[i]);
        node->memory[i] = NULL;
    }
    return 0;
}

static int64_t fake_now(void *user)
{
    return ((fake_v4l2 *)user)->now_ns;
}

t3r_v4l2_system fake_system(fake_v4l2 *fake)
{
    return (t3r_v4l2_system){
        .user = fake,
        .open = fake_open,
        .ioctl = fake_ioctl,
        .map = fake_map,
        .unmap = fake_unmap,
        .poll = fake_poll,
        .close = fake_close,
        .now_ns = fake_now,
    };
}
