/* SPDX-License-Identifier: Apache-2.0 */
/* V4L2 capture with a fake driver in this process: negotiation, delivery, and every kind of failure. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "capture/capture_adapter.h"
#include "capture/v4l2.h"
#include "fake_v4l2.h"
#include "test.h"

enum { MOST_EVENTS = 512 };

typedef struct heard {
    uint32_t count;
    t3r_capture_event_kind kind[MOST_EVENTS];
    char text[MOST_EVENTS][T3R_CAPTURE_EVENT_BYTES];
} heard;

static heard events;

static void hear(void *user, const t3r_capture_event *event)
{
    heard *h = user;
    assert_true(h->count < MOST_EVENTS);
    h->kind[h->count] = event->kind;
    t3r_capture_event_text(event, h->text[h->count]);
    h->count++;
}

static t3r_capture_settings small(void)
{
    t3r_capture_settings wish = {.width = 32, .height = 16}, filled;
    assert_null(t3r_capture_settings_fill(&wish, &filled));
    return filled;
}

static t3r_capture *open_with(fake_v4l2 *fake, const t3r_capture_settings *settings)
{
    char error[256] = "";
    t3r_v4l2_system system = fake_system(fake);
    t3r_capture *capture = t3r_v4l2_open_on(&system, "/dev/video0", settings, error, sizeof error);
    if (capture == NULL) {
        fail_msg("%s", error);
        abort();
    }
    events.count = 0;
    t3r_capture_listen(capture, hear, &events);
    return capture;
}

static t3r_capture *open_small(fake_v4l2 *fake)
{
    t3r_capture_settings settings = small();
    settings.depth = fake->nodes > 1 ? "/dev/video2" : NULL;
    return open_with(fake, &settings);
}

static void refused(fake_v4l2 *fake, const t3r_capture_settings *settings, const char *words)
{
    char error[256] = "";
    t3r_v4l2_system system = fake_system(fake);
    t3r_capture *capture = t3r_v4l2_open_on(&system, "/dev/video0", settings, error, sizeof error);
    assert_null(capture);
    if (strstr(error, words) == NULL) {
        fail_msg("'%s' does not say '%s'", error, words);
    }
    assert_true(fake_clean(fake));
}

static void finish(fake_v4l2 *fake, t3r_capture *capture)
{
    t3r_capture_close(capture);
    assert_true(fake_clean(fake));
}

static t3r_capture_frame take(t3r_capture *capture)
{
    t3r_capture_frame frame = {0};
    for (int tries = 0; tries < 100; tries++) {
        int got = t3r_capture_next(capture, &frame);
        if (got == T3R_CAPTURE_FRAME) {
            return frame;
        }
        if (got != T3R_CAPTURE_NOTHING) {
            fail_msg("%d: %s", got, t3r_capture_error(capture));
        }
    }
    fail_msg("no frame");
    return frame;
}

static void check_image(const fake_v4l2 *fake, const t3r_capture_frame *frame, uint32_t number)
{
    const fake_node *node = &fake->node[0];
    const t3r_frame *f = &frame->frame;
    assert_int_equal(frame->sequence, node->first_sequence + number);
    uint32_t rows = f->height + (f->format == T3R_PIXEL_NV12 ? f->height / 2 : 0);
    for (uint32_t i = 0; i < node->format.bytesperline * rows; i += 7) {
        uint32_t row = i / node->format.bytesperline, column = i % node->format.bytesperline;
        const uint8_t *p = row < f->height ? f->planes[0] + (size_t)row * f->stride_bytes[0] + column
                                           : f->planes[1] + (size_t)(row - f->height) * f->stride_bytes[1] + column;
        assert_int_equal(*p, fake_byte(number, i));
    }
}

/* Takes the next frame, which must be image `number`. */
static void take_number(const fake_v4l2 *fake, t3r_capture *capture, uint32_t number)
{
    t3r_capture_frame frame = take(capture);
    check_image(fake, &frame, number);
}

/* ---- formats ---- */

TEST(every_format_comes_as_it_is_and_without_a_copy)
{
    static const struct {
        uint32_t fourcc;
        t3r_pixel_format format;
    } cases[] = {{V4L2_PIX_FMT_YUYV, T3R_PIXEL_YUYV},   {V4L2_PIX_FMT_UYVY, T3R_PIXEL_UYVY},
                 {V4L2_PIX_FMT_NV12, T3R_PIXEL_NV12},   {V4L2_PIX_FMT_RGB24, T3R_PIXEL_RGB24},
                 {V4L2_PIX_FMT_BGR24, T3R_PIXEL_BGR24}, {V4L2_PIX_FMT_GREY, T3R_PIXEL_GREY}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        fake_v4l2 fake;
        fake_start(&fake);
        fake.node[0].formats[0] = V4L2_PIX_FMT_SBGGR8; /* no supported format */
        fake.node[0].formats[1] = cases[i].fourcc;
        fake.node[0].padding = i % 2 == 0 ? 0 : 24;
        t3r_capture *capture = open_small(&fake);
        assert_string_equal(t3r_capture_clock(capture), "monotonic");
        for (uint32_t number = 0; number < 40; number++) {
            t3r_capture_frame frame = take(capture);
            assert_int_equal(frame.frame.format, cases[i].format);
            assert_int_equal(frame.index, number);
            assert_int_equal(frame.stamp_ns / 1000, (5000000000 + (int64_t)number * 33333333) / 1000);
            assert_null(frame.frame.depth);
            check_image(&fake, &frame, number);
            bool lent = false;
            for (uint32_t b = 0; b < fake.node[0].buffer_count; b++) {
                lent = lent || frame.frame.planes[0] == fake.node[0].memory[b];
            }
            assert_true(lent);
        }
        assert_int_equal(events.count, 0);
        assert_int_equal(t3r_capture_counts_of(capture).frames, 40);
        finish(&fake, capture);
    }
}

TEST(sizes_rates_and_wishes_choose_the_format)
{
    fake_v4l2 fake;
    fake_start(&fake);
    fake_node *node = &fake.node[0];
    node->formats[0] = V4L2_PIX_FMT_GREY;
    node->formats[1] = V4L2_PIX_FMT_BGR24;
    node->formats[2] = V4L2_PIX_FMT_NV12;
    node->sizes[0] = (fake_size){16, 8, 60};
    node->sizes[1] = (fake_size){64, 48, 30};
    node->sizes[2] = (fake_size){32, 24, 0};
    t3r_capture_settings settings = small();
    settings.width = 60;
    settings.height = 50;
    t3r_capture *capture = open_with(&fake, &settings);
    t3r_capture_frame frame = take(capture);
    assert_int_equal(frame.frame.format, T3R_PIXEL_NV12); /* the first in order of preference */
    assert_int_equal(frame.frame.width, 64);
    assert_int_equal(frame.frame.height, 48);
    assert_non_null(strstr(t3r_capture_note(capture), "64x48, NV12"));
    finish(&fake, capture);
    settings.format = "GREY";
    settings.rate_millihertz = 90000;
    capture = open_with(&fake, &settings);
    assert_int_equal(take(capture).frame.format, T3R_PIXEL_GREY);
    assert_non_null(strstr(t3r_capture_note(capture), "does not keep the rate"));
    finish(&fake, capture);

    settings.format = "UYVY";
    refused(&fake, &settings, "does not offer");
    settings.format = "H264";
    refused(&fake, &settings, "not one that is read");
    settings.format = NULL;
    node->formats[0] = V4L2_PIX_FMT_SBGGR8;
    node->formats[1] = node->formats[2] = 0;
    refused(&fake, &settings, "no format that is read");
    node->formats[0] = V4L2_PIX_FMT_YUYV;
    node->field = V4L2_FIELD_INTERLACED;
    refused(&fake, &settings, "interlaced");
    node->field = 0;
    node->sizes[0] = (fake_size){5000, 16, 0};
    node->sizes[1] = node->sizes[2] = (fake_size){0};
    refused(&fake, &settings, "outside 2..4096");
    node->sizes[0] = (fake_size){33, 16, 0};
    refused(&fake, &settings, "odd");
    node->sizes[0] = (fake_size){32, 16, 0};
    node->most_buffers = 1;
    refused(&fake, &settings, "buffers, not 2");
    node->most_buffers = 0;
    node->capabilities = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_STREAMING;
    refused(&fake, &settings, "does not capture");
    node->capabilities = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING;
    refused(&fake, &settings, "separate planes");
    node->capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_READWRITE;
    refused(&fake, &settings, "no streaming");
}

TEST(a_call_that_fails_while_opening_is_told_and_leaves_nothing)
{
    static const struct {
        unsigned long call;
        int error;
        const char *words;
    } cases[] = {
        {FAKE_OPEN, EACCES, "Permission denied"},
        {FAKE_OPEN, ENOENT, "No such file"},
        {VIDIOC_QUERYCAP, ENOTTY, "is not a video device"},
        {VIDIOC_S_FMT, EBUSY, "another program"},
        {VIDIOC_S_FMT, EIO, "Input/output"},
        {VIDIOC_REQBUFS, EINVAL, "no buffers"},
        {VIDIOC_REQBUFS, ENOMEM, "no buffers"},
        {VIDIOC_QUERYBUF, EINVAL, "buffer 0"},
        {FAKE_MAP, ENOMEM, "cannot be mapped"},
        {VIDIOC_QBUF, EINVAL, "cannot be queued"},
        {VIDIOC_STREAMON, EINVAL, "does not start"},
        {VIDIOC_STREAMON, EPIPE, "does not start"},
    };
    t3r_capture_settings settings = small();
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        fake_v4l2 fake;
        fake_start(&fake);
        fake.faults[0] = (fake_fault){cases[i].call, 0, 1, cases[i].error};
        refused(&fake, &settings, cases[i].words);
    }
    /* optional calls */
    static const unsigned long optional[] = {VIDIOC_ENUM_FRAMESIZES, VIDIOC_ENUM_FRAMEINTERVALS, VIDIOC_G_PARM,
                                             VIDIOC_SUBSCRIBE_EVENT};
    for (size_t i = 0; i < sizeof optional / sizeof optional[0]; i++) {
        fake_v4l2 fake;
        fake_start(&fake);
        fake.faults[0] = (fake_fault){optional[i], 0, 1000, ENOTTY};
        t3r_capture *capture = open_small(&fake);
        take(capture);
        finish(&fake, capture);
    }
    /* signals while it opens */
    fake_v4l2 fake;
    fake_start(&fake);
    fake.faults[0] = (fake_fault){VIDIOC_S_FMT, 0, 3, EINTR};
    t3r_capture *capture = open_small(&fake);
    take(capture);
    finish(&fake, capture);
}

/* ---- failures while streaming ---- */

TEST(damaged_images_are_left_out_counted_and_named)
{
    fake_v4l2 fake;
    fake_start(&fake);
    fake.node[0].flag_error_at = 3;
    fake.node[0].short_at = 5;
    fake.node[0].empty_at = 6;
    t3r_capture *capture = open_small(&fake);
    static const uint32_t expected[] = {0, 1, 2, 4, 7, 8};
    for (size_t i = 0; i < sizeof expected / sizeof expected[0]; i++) {
        t3r_capture_frame frame = take(capture);
        assert_int_equal(frame.index, i);
        check_image(&fake, &frame, expected[i]);
    }
    assert_int_equal(t3r_capture_counts_of(capture).corrupted, 3);
    assert_int_equal(t3r_capture_counts_of(capture).dropped_driver, 0);
    assert_int_equal(events.count, 3);
    assert_string_equal(events.text[0], "frame 3 left out: the driver calls it corrupted");
    assert_string_equal(events.text[1], "frame 5 left out: it is shorter than an image");
    finish(&fake, capture);
}

TEST(gaps_are_the_drivers_or_the_callers)
{
    fake_v4l2 fake;
    fake_start(&fake);
    fake.node[0].first_sequence = UINT32_MAX - 5; /* the counter overflows */
    fake.node[0].drop_from = 4;
    fake.node[0].drop_count = 3;
    t3r_capture *capture = open_small(&fake);
    uint32_t number = 0;
    for (; number < 4; number++) {
        take_number(&fake, capture, number);
    }
    t3r_capture_frame frame = take(capture);
    check_image(&fake, &frame, 7);
    assert_int_equal(t3r_capture_counts_of(capture).dropped_driver, 3);
    assert_string_equal(events.text[0], "3 dropped by the driver before colour 1");
    take(capture);
    /* four buffers, one of them held by the test: three more images fit */
    fake_sleep(&fake, 33333333 * INT64_C(10));
    take(capture);
    take(capture);
    take(capture);
    take(capture);
    t3r_capture_counts counts = t3r_capture_counts_of(capture);
    assert_int_equal(counts.dropped_driver, 3);
    assert_int_equal(counts.dropped_slow, 7);
    assert_int_equal(counts.frames + counts.dropped_driver + counts.dropped_slow, fake.node[0].number);
    assert_non_null(strstr(events.text[events.count - 1], "too slowly"));
    finish(&fake, capture);
}

TEST(every_wait_ends)
{
    fake_v4l2 fake;
    fake_start(&fake);
    fake.node[0].stall_at = 2;
    t3r_capture_settings settings = small();
    settings.deadline_ms = 250;
    settings.stall_ms = 1000;
    t3r_capture *capture = open_with(&fake, &settings);
    take(capture);
    take(capture);
    t3r_capture_frame frame;
    int64_t start = fake.now_ns;
    for (int i = 0; i < 4; i++) {
        int64_t before = fake.now_ns;
        int got = t3r_capture_next(capture, &frame);
        assert_true(fake.now_ns - before <= 251000000);
        assert_int_equal(got, i < 3 ? T3R_CAPTURE_NOTHING : T3R_CAPTURE_LOST);
    }
    assert_true(fake.now_ns - start <= 1010000000);
    assert_non_null(strstr(t3r_capture_error(capture), "no image for 1000 ms"));
    assert_int_equal(t3r_capture_next(capture, &frame), T3R_CAPTURE_LOST); /* and again, immediately */
    /* the camera comes back */
    assert_int_equal(t3r_capture_reopen(capture), T3R_CAPTURE_FRAME);
    take_number(&fake, capture, 2);
    assert_int_equal(t3r_capture_counts_of(capture).reopened, 1);
    finish(&fake, capture);

    /* a signal ends the wait at once */
    fake_start(&fake);
    capture = open_with(&fake, &settings);
    fake.faults[0] = (fake_fault){FAKE_POLL, 0, 1, EINTR};
    start = fake.now_ns;
    assert_int_equal(t3r_capture_next(capture, &frame), T3R_CAPTURE_NOTHING);
    assert_int_equal(fake.now_ns, start);
    fake.faults[0] = (fake_fault){FAKE_POLL, 0, 1, ENOMEM};
    assert_int_equal(t3r_capture_next(capture, &frame), T3R_CAPTURE_LOST);
    finish(&fake, capture);

    /* a driver that reports ready without an image does not cause a busy loop */
    fake_start(&fake);
    capture = open_with(&fake, &settings);
    fake.node[0].ready_lies = true;
    fake.node[0].stall_at = 0;
    uint64_t calls = fake.calls;
    assert_int_equal(t3r_capture_next(capture, &frame), T3R_CAPTURE_LOST);
    assert_true(fake.calls - calls < 200);
    finish(&fake, capture);
}

TEST(lost_devices_are_told_and_come_back)
{
    static const char *const words[] = {"No such device", "Input/output", "its format changed", "did not hold"};
    for (int i = 0; i < 4; i++) {
        fake_v4l2 fake;
        fake_start(&fake);
        fake_node *node = &fake.node[0];
        *(i == 0 ? &node->unplug_at : i == 1 ? &node->fatal_at : i == 2 ? &node->change_at : &node->wrong_index_at) = 3;
        t3r_capture *capture = open_small(&fake);
        t3r_capture_frame frame;
        int got = T3R_CAPTURE_FRAME;
        uint32_t frames = 0;
        for (; got == T3R_CAPTURE_FRAME || got == T3R_CAPTURE_NOTHING; frames += got == T3R_CAPTURE_FRAME) {
            got = t3r_capture_next(capture, &frame);
        }
        assert_int_equal(got, T3R_CAPTURE_LOST);
        assert_int_equal(frames, i == 1 ? 2 : 3); /* a queue in error keeps its finished buffers */
        if (strstr(t3r_capture_error(capture), words[i]) == NULL) {
            fail_msg("'%s' does not say '%s'", t3r_capture_error(capture), words[i]);
        }
        assert_int_equal(events.kind[events.count - 1], T3R_EVENT_LOST);
        assert_int_equal(node->opened, 0); /* a device can be unplugged only after it is closed */
        assert_int_equal(node->mapped, 0);
        fake.faults[0] = (fake_fault){FAKE_OPEN, 0, 2, ENOENT};
        assert_int_equal(t3r_capture_reopen(capture), T3R_CAPTURE_LOST);
        assert_int_equal(t3r_capture_reopen(capture), T3R_CAPTURE_LOST);
        assert_non_null(strstr(t3r_capture_error(capture), "No such file"));
        assert_int_equal(t3r_capture_reopen(capture), T3R_CAPTURE_FRAME);
        frame = take(capture);
        assert_int_equal(frame.index, frames);
        take(capture);
        finish(&fake, capture);
    }
}

TEST(passing_errors_cost_no_frame_but_are_told)
{
    fake_v4l2 fake;
    fake_start(&fake);
    t3r_capture *capture = open_small(&fake);
    take(capture);
    fake.faults[0] = (fake_fault){VIDIOC_DQBUF, 0, 2, EIO};
    fake.faults[1] = (fake_fault){VIDIOC_QBUF, 2, 1, EINVAL};
    fake.faults[2] = (fake_fault){VIDIOC_DQBUF, 4, 2, EINTR};
    for (uint32_t number = 1; number < 20; number++) {
        take_number(&fake, capture, number);
    }
    assert_int_equal(t3r_capture_counts_of(capture).faults, 3);
    assert_int_equal(t3r_capture_counts_of(capture).frames, 20);
    /* endless EIO is not a passing error */
    fake.faults[0] = (fake_fault){VIDIOC_DQBUF, 0, 1000, EIO};
    t3r_capture_frame frame;
    int got = T3R_CAPTURE_NOTHING;
    for (int i = 0; i < 20 && got != T3R_CAPTURE_LOST; i++) {
        got = t3r_capture_next(capture, &frame);
    }
    assert_int_equal(got, T3R_CAPTURE_LOST);
    finish(&fake, capture);

    /* if buffers are never requeued, the capture ends after the last one */
    fake_start(&fake);
    capture = open_small(&fake);
    fake.faults[0] = (fake_fault){VIDIOC_QBUF, 0, 100000, EINVAL};
    uint32_t frames = 0;
    for (got = T3R_CAPTURE_FRAME; got == T3R_CAPTURE_FRAME; frames++) {
        got = t3r_capture_next(capture, &frame);
    }
    assert_int_equal(got, T3R_CAPTURE_LOST);
    assert_int_equal(frames, 5); /* four buffers, and the call that found none */
    finish(&fake, capture);
}

TEST(stamps_without_a_clock_are_taken_on_arrival)
{
    fake_v4l2 fake;
    fake_start(&fake);
    fake.node[0].timestamp_flags = V4L2_BUF_FLAG_TIMESTAMP_COPY;
    t3r_capture *capture = open_small(&fake);
    assert_string_equal(t3r_capture_clock(capture), "arrival");
    fake.node[0].jitter_ns[0] = 777777777777;
    assert_int_equal(take(capture).stamp_ns, 5000000000);
    finish(&fake, capture);
    /* a stamp beyond the range of recordings */
    fake_start(&fake);
    fake.node[0].jitter_ns[1] = INT64_C(3000000000000000000);
    capture = open_small(&fake);
    take(capture);
    take_number(&fake, capture, 2);
    assert_non_null(strstr(events.text[0], "time stamp"));
    finish(&fake, capture);
}

/* ---- colour and depth ---- */

static void check_pair(const t3r_capture_frame *frame, uint32_t colour, uint32_t depth)
{
    assert_int_equal(frame->sequence, colour);
    assert_non_null(frame->frame.depth);
    assert_int_equal(frame->frame.depth_stride_bytes, 64);
    assert_int_equal(frame->frame.depth[5], fake_byte(depth, 5));
    assert_int_equal(frame->frame.depth_unit_q40, T3R_DEFAULT_DEPTH_UNIT_Q40);
}

TEST(images_of_one_instant_are_paired)
{
    static const int64_t offsets_ms[] = {0, 4, -4, 12, -12};
    for (size_t k = 0; k < sizeof offsets_ms / sizeof offsets_ms[0]; k++) {
        fake_v4l2 fake;
        fake_start(&fake);
        fake_add_depth(&fake);
        fake.node[1].first_ns += offsets_ms[k] * 1000000;
        t3r_capture *capture = open_small(&fake);
        for (uint32_t number = 0; number < 100; number++) {
            t3r_capture_frame frame = take(capture);
            check_pair(&frame, number, number);
            check_image(&fake, &frame, number);
            int64_t gap = frame.depth_stamp_ns - frame.stamp_ns - offsets_ms[k] * 1000000;
            assert_true(gap > -2000 && gap < 2000);
        }
        assert_int_equal(t3r_capture_counts_of(capture).paired, 100);
        assert_int_equal(events.count, 100); /* every decision is reported */
        assert_int_equal(events.kind[99], T3R_EVENT_PAIRED);
        finish(&fake, capture);
    }
}

TEST(images_without_companions_are_told)
{
    fake_v4l2 fake;
    fake_start(&fake);
    fake_add_depth(&fake);
    fake.node[0].drop_from = 10;
    fake.node[0].drop_count = 2;
    fake.node[1].drop_from = 20;
    fake.node[1].drop_count = 1;
    fake.node[1].flag_error_at = 30;
    t3r_capture *capture = open_small(&fake);
    uint32_t paired = 0, alone = 0;
    for (uint32_t i = 0; i < 60; i++) {
        t3r_capture_frame frame = take(capture);
        assert_true(frame.sequence != 10 && frame.sequence != 11);
        if (frame.sequence == 20 || frame.sequence == 30) {
            assert_null(frame.frame.depth);
            alone++;
        } else {
            check_pair(&frame, frame.sequence, frame.sequence);
            paired++;
        }
    }
    t3r_capture_counts counts = t3r_capture_counts_of(capture);
    assert_int_equal(alone, 2);
    assert_int_equal(counts.alone, 2);
    assert_int_equal(counts.paired, paired);
    assert_int_equal(counts.dropped_driver, 2);
    assert_int_equal(counts.depth_dropped, 1 + 2); /* the lost one, and two whose colour was lost */
    assert_int_equal(counts.corrupted, 1);
    uint32_t told = 0;
    for (uint32_t i = 0; i < events.count; i++) {
        told += events.kind[i] == T3R_EVENT_PAIRED || events.kind[i] == T3R_EVENT_ALONE;
    }
    assert_int_equal(told, 60);
    finish(&fake, capture);
}

TEST(a_still_depth_camera_does_not_hold_colour_up)
{
    fake_v4l2 fake;
    fake_start(&fake);
    fake_add_depth(&fake);
    fake.node[1].stall_at = 5;
    t3r_capture *capture = open_small(&fake);
    for (uint32_t number = 0; number < 50; number++) {
        int64_t before = fake.now_ns;
        t3r_capture_frame frame = take(capture);
        assert_int_equal(frame.frame.depth != NULL, number < 5);
        assert_true(fake.now_ns - before < 250000000);
    }
    finish(&fake, capture);

    /* likewise if the colour camera starts late: old depth is dropped */
    fake_start(&fake);
    fake_add_depth(&fake);
    fake.node[0].first_ns += 2000000000;
    capture = open_small(&fake);
    t3r_capture_frame frame = take(capture);
    assert_non_null(frame.frame.depth);
    assert_true(t3r_capture_counts_of(capture).depth_dropped > 50);
    finish(&fake, capture);

    /* and a colour camera that gives nothing counts as lost, however much depth comes */
    fake_start(&fake);
    fake_add_depth(&fake);
    fake.node[0].stall_at = 5;
    capture = open_small(&fake);
    for (uint32_t number = 0; number < 5; number++) {
        take(capture);
    }
    int64_t before = fake.now_ns;
    int got = T3R_CAPTURE_NOTHING;
    for (int i = 0; i < 1000 && got == T3R_CAPTURE_NOTHING; i++) {
        got = t3r_capture_next(capture, &frame);
    }
    assert_int_equal(got, T3R_CAPTURE_LOST);
    assert_true(fake.now_ns - before < 3300000000);
    finish(&fake, capture);

    /* if the depth node cannot be opened, no half-open pair is left */
    fake_start(&fake);
    fake_add_depth(&fake);
    fake.node[1].formats[0] = V4L2_PIX_FMT_YUYV;
    t3r_capture_settings settings = small();
    settings.depth = "/dev/video2";
    refused(&fake, &settings, "neither Z16 nor Y16");
}

/* ---- every call fails once ---- */

TEST(no_failed_call_hangs_leaks_or_loses_a_frame_untold)
{
    static const int errors[] = {EIO, ENODEV, EINVAL, EAGAIN, ENOMEM, EINTR};
    uint32_t opened = 0;
    for (size_t e = 0; e < sizeof errors / sizeof errors[0]; e++) {
        for (uint32_t skip = 0; skip < 220; skip++) {
            fake_v4l2 fake;
            fake_start(&fake);
            fake_add_depth(&fake);
            fake.faults[0] = (fake_fault){FAKE_ANY, skip, 1, errors[e]};
            t3r_v4l2_system system = fake_system(&fake);
            t3r_capture_settings settings = small();
            settings.depth = "/dev/video2";
            char error[256] = "";
            t3r_capture *capture = t3r_v4l2_open_on(&system, "/dev/video0", &settings, error, sizeof error);
            if (capture == NULL) {
                assert_true(error[0] != '\0');
                assert_true(fake_clean(&fake));
                continue;
            }
            opened++;
            uint32_t last = UINT32_MAX, unseen = 0;
            t3r_capture_frame frame;
            for (uint32_t round = 0, frames = 0; round < 200 && frames < 20; round++) {
                int64_t before = fake.now_ns;
                int got = t3r_capture_next(capture, &frame);
                assert_true(fake.now_ns - before < 200000000);
                if (got == T3R_CAPTURE_LOST) {
                    assert_true(t3r_capture_error(capture)[0] != '\0');
                    assert_int_equal(t3r_capture_reopen(capture), T3R_CAPTURE_FRAME);
                    last = UINT32_MAX; /* LOST reports the images that a closed device did not give */
                }
                if (got == T3R_CAPTURE_FRAME) {
                    unseen += last == UINT32_MAX ? 0 : frame.sequence - last - 1;
                    last = frame.sequence;
                    frames++;
                }
            }
            t3r_capture_counts counts = t3r_capture_counts_of(capture);
            assert_int_equal(counts.frames, 20);
            assert_int_equal(unseen, counts.dropped_driver + counts.dropped_slow + counts.corrupted);
            t3r_capture_close(capture);
            assert_int_equal(fake.node[0].opened + fake.node[1].opened, 0);
            assert_int_equal(fake.node[0].mapped + fake.node[1].mapped, 0);
        }
    }
    assert_true(opened > 600);
}
