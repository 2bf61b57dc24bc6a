/* SPDX-License-Identifier: Apache-2.0 */
/* Capture by libcamera with a fake library in this process: negotiation, frames without a copy, gaps, failures,
 * unplugging, stalls. */
#include <stdio.h>
#include <string.h>

#include "capture/capture_adapter.h"
#include "capture/libcamera.h"
#include "test.h"

enum { WIDTH = 16, HEIGHT = 8, STRIDE = 24, BUFFERS = 3, NEVER = 1000000 };

/* The fake library: buffers are finished in the order in which they were queued. */
static struct {
    const char *refuses; /* NULL = opening succeeds */
    const char *format;
    uint32_t stride, short_bytes;
    uint32_t failed_at, skip_at, gone_at, still_at, refuse_queue_at, cancel_at;
    uint32_t opened, number, queued, lent, line[BUFFERS];
    uint8_t memory[BUFFERS][STRIDE * HEIGHT * 2];
} library;

static void start(void)
{
    memset(&library, 0, sizeof library);
    library.format = "YUYV";
    library.stride = STRIDE * 2;
    library.failed_at = library.skip_at = library.gone_at = library.still_at = library.refuse_queue_at =
        library.cancel_at = NEVER;
}

static t3r_libcamera_stream *open_stream(const t3r_libcamera_request *request, t3r_libcamera_agreed *agreed,
                                         char *error, size_t error_bytes)
{
    if (library.refuses != NULL) {
        snprintf(error, error_bytes, "libcamera:%s: %s", request->camera, library.refuses);
        return NULL;
    }
    *agreed = (t3r_libcamera_agreed){
        .id = "fake", .width = WIDTH, .height = HEIGHT, .stride = library.stride, .buffers = BUFFERS};
    snprintf(agreed->format, sizeof agreed->format, "%s", library.format);
    for (uint32_t i = 0; i < BUFFERS; i++) {
        agreed->buffer[i].plane[0] = library.memory[i];
        agreed->buffer[i].bytes[0] = sizeof library.memory[i] - library.short_bytes;
        library.line[i] = i;
    }
    library.queued = BUFFERS;
    library.opened++;
    return (t3r_libcamera_stream *)&library;
}

static int wait_for(t3r_libcamera_stream *stream, uint32_t timeout_ms, t3r_libcamera_done *done)
{
    (void)stream;
    (void)timeout_ms;
    if (library.number >= library.gone_at) {
        return -1;
    }
    if (library.number >= library.cancel_at) {
        return -2;
    }
    if (library.number >= library.still_at || library.queued == 0) {
        return 0;
    }
    library.number += library.number == library.skip_at ? 2 : 0;
    uint32_t index = library.line[0];
    memmove(library.line, library.line + 1, --library.queued * sizeof library.line[0]);
    memset(library.memory[index], (int)library.number, sizeof library.memory[index]);
    *done = (t3r_libcamera_done){.index = index,
                                 .sequence = library.number,
                                 .stamp_ns = UINT64_C(1000000000) + library.number * UINT64_C(40000000),
                                 .bytes = STRIDE,
                                 .whole = library.number != library.failed_at};
    library.number++;
    return 1;
}

static int queue(t3r_libcamera_stream *stream, uint32_t index)
{
    (void)stream;
    if (library.number >= library.refuse_queue_at) {
        return -1;
    }
    assert_true(library.queued < BUFFERS);
    library.line[library.queued++] = index;
    return 0;
}

static void close_stream(t3r_libcamera_stream *stream)
{
    (void)stream;
    library.opened--;
}

static void list(void (*say)(void *user, const char *line), void *user)
{
    say(user, "libcamera:0  fake");
}

static const t3r_libcamera_shim fake = {"fake", open_stream, wait_for, queue, close_stream, list};

static t3r_capture *open_fake(uint32_t stall_ms, char *error)
{
    t3r_capture_settings wish = {.deadline_ms = 5, .stall_ms = stall_ms}, filled;
    assert_null(t3r_capture_settings_fill(&wish, &filled));
    return t3r_libcamera_open_on(&fake, "0", &filled, error, 256);
}

static void check_next(t3r_capture *capture, uint32_t sequence)
{
    t3r_capture_frame frame;
    assert_int_equal(t3r_capture_next(capture, &frame), T3R_CAPTURE_FRAME);
    assert_int_equal(frame.sequence, sequence);
    assert_int_equal(frame.stamp_ns, 1000000000 + (int64_t)sequence * 40000000);
    assert_int_equal(frame.frame.planes[0][0], (uint8_t)sequence);
    assert_int_equal(frame.frame.stride_bytes[0], STRIDE * 2);
    assert_true(frame.frame.planes[0] >= library.memory[0] &&
                frame.frame.planes[0] < library.memory[0] + sizeof library.memory);
}

TEST(frames_come_without_a_copy)
{
    char error[256] = "";
    start();
    library.skip_at = 4;
    library.failed_at = 9;
    t3r_capture *capture = open_fake(1000, error);
    assert_non_null(capture);
    assert_string_equal(t3r_capture_clock(capture), "boottime");
    for (uint32_t i = 0; i < 12; i++) {
        if (i != 4 && i != 5 && i != 9) {
            check_next(capture, i);
        }
    }
    t3r_capture_counts counts = t3r_capture_counts_of(capture);
    assert_int_equal(counts.frames, 9);
    assert_int_equal(counts.dropped_driver + counts.dropped_slow, 2);
    assert_int_equal(counts.corrupted, 1);
    t3r_capture_close(capture);
    assert_int_equal(library.opened, 0);
}

TEST(what_cannot_be_read_is_refused)
{
    char error[256] = "";
    start();
    library.refuses = "another program captures from it";
    assert_null(open_fake(1000, error));
    assert_non_null(strstr(error, "another program"));
    start();
    library.format = "MJPG";
    assert_null(open_fake(1000, error));
    assert_non_null(strstr(error, "not read"));
    start();
    library.stride = WIDTH;
    assert_null(open_fake(1000, error));
    assert_non_null(strstr(error, "do not fit"));
    start();
    library.short_bytes = 30;
    assert_null(open_fake(1000, error));
    assert_non_null(strstr(error, "shorter"));
    assert_int_equal(library.opened, 0);
    t3r_capture_settings filled;
    assert_null(t3r_capture_settings_fill(&(t3r_capture_settings){.depth = "1"}, &filled));
    assert_null(t3r_libcamera_open_on(&fake, "0", &filled, error, sizeof error));
    assert_non_null(strstr(error, "no depth"));
}

TEST(lost_cameras_are_told_and_come_back)
{
    static const char *const words[] = {"unplugged", "takes no buffers", "takes no buffers", "no image for"};
    uint32_t *const at[] = {&library.gone_at, &library.refuse_queue_at, &library.cancel_at, &library.still_at};
    for (int i = 0; i < 4; i++) {
        char error[256] = "";
        start();
        *at[i] = 3;
        t3r_capture *capture = open_fake(1, error);
        assert_non_null(capture);
        t3r_capture_frame frame;
        uint32_t frames = 0;
        int got = T3R_CAPTURE_FRAME;
        for (uint32_t tries = 0; tries < 100000 && got != T3R_CAPTURE_LOST; tries++) {
            got = t3r_capture_next(capture, &frame);
            frames += got == T3R_CAPTURE_FRAME;
        }
        assert_int_equal(got, T3R_CAPTURE_LOST);
        assert_int_equal(frames, 3);
        assert_non_null(strstr(t3r_capture_error(capture), words[i]));
        assert_int_equal(library.opened, 0);
        assert_int_equal(t3r_capture_next(capture, &frame), T3R_CAPTURE_LOST);
        library.refuses = "there is no such camera";
        assert_int_equal(t3r_capture_reopen(capture), T3R_CAPTURE_LOST);
        library.refuses = NULL;
        *at[i] = NEVER;
        assert_int_equal(t3r_capture_reopen(capture), T3R_CAPTURE_FRAME);
        check_next(capture, 3);
        t3r_capture_close(capture);
        assert_int_equal(library.opened, 0);
    }
}
