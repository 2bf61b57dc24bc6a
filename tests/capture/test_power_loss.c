/* SPDX-License-Identifier: Apache-2.0 */
/* A recording whose process is killed, 200 times at random moments, with every way of storing messages: every complete
 * frame can be read, and equals the written one. Files that roll over stay within their size limit. */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "capture/record.h"
#include "rgbd_frame.h"
#include "scratch.h"
#include "test.h"

enum { WIDTH = 48, HEIGHT = 32, KILLS = 200, MOST_FRAMES = 4000 };

static uint8_t pixels[HEIGHT][WIDTH][3], depth[HEIGHT][WIDTH][2];

static const recording_options stored; /* chunks, not compressed */

static uint8_t value_of(uint32_t frame, size_t i)
{
    return (uint8_t)(frame * 13 + i * 7);
}

static t3r_capture_frame make_frame(uint32_t number)
{
    uint8_t *p = &pixels[0][0][0], *d = &depth[0][0][0];
    for (size_t i = 0; i < sizeof pixels; i++) {
        p[i] = value_of(number, i);
    }
    for (size_t i = 0; i < sizeof depth; i++) {
        d[i] = value_of(number + 1, i);
    }
    return (t3r_capture_frame){
        .index = number,
        .stamp_ns = 1000000000 + (int64_t)number * 33333333,
        .has_pose = true,
        .has_intrinsics = true,
        .frame = rgbd_frame(p, number % 3 == 2 ? NULL : d, WIDTH, HEIGHT, MILLIMETRE_Q40),
        .camera = {.width = WIDTH,
                   .height = HEIGHT,
                   .fx_q16 = 40 << 16,
                   .fy_q16 = 40 << 16,
                   .cx_q16 = 24 << 16,
                   .cy_q16 = 16 << 16,
                   .position_q32 = {(int64_t)number << 20, 0, 0},
                   .rotation_q30 = {1 << 30, 0, 0, 0}},
    };
}

/* Records endlessly in the child, and reports the number of complete frames. */
static void record_for_ever(const char *path, const recording_options *how, volatile uint32_t *whole)
{
    static capture_record record;
    if (capture_record_begin(&record, path, 0, false, "test", "monotonic", 1099511628, how) != 0) {
        _exit(1);
    }
    for (uint32_t number = 0; number < MOST_FRAMES; number++) {
        t3r_capture_frame frame = make_frame(number);
        t3r_capture_event event = {
            .kind = T3R_EVENT_PAIRED, .stamp_ns = frame.stamp_ns, .sequence = number, .depth_sequence = number};
        if (capture_record_event(&record, &event) != 0 || capture_record_frame(&record, &frame) != 0) {
            _exit(1);
        }
        *whole = number + 1;
    }
    for (;;) {
        pause();
    }
}

static void check_frame(const t3r_recording *recording, uint32_t number)
{
    t3r_capture_frame got, expected = make_frame(number);
    char error[256] = "";
    if (t3r_recording_frame(recording, number, &got, error, sizeof error) != T3R_CAPTURE_FRAME) {
        fail_msg("frame %u: %s", number, error);
    }
    assert_int_equal(got.stamp_ns, expected.stamp_ns);
    assert_memory_equal(got.frame.planes[0], expected.frame.planes[0], sizeof pixels);
    assert_true(got.has_pose && got.has_intrinsics);
    assert_int_equal(got.frame.depth != NULL, expected.frame.depth != NULL);
    if (got.frame.depth != NULL) {
        assert_memory_equal(got.frame.depth, expected.frame.depth, sizeof depth);
    }
    assert_memory_equal(&got.camera, &expected.camera, sizeof got.camera);
}

TEST_WITH(a_killed_process_loses_at_most_the_message_it_was_writing, scratch_setup, scratch_teardown)
{
    scratch *s = *state;
    volatile uint32_t *whole = mmap(NULL, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true((const void *)whole != MAP_FAILED);
    uint32_t random = 12345, cut = 0;
    uint64_t frames = 0;
    static const recording_options ways[] = {{.unchunked = true},
                                             {.unchunked = false},
                                             {.compression = T3R_COMPRESSION_ZSTD},
                                             {.compression = T3R_COMPRESSION_LZ4}};
    for (int kill_number = 0; kill_number < KILLS; kill_number++) {
        const char *path = scratch_path(s, "cut.mcap");
        *whole = 0;
        pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0) {
            record_for_ever(path, &ways[kill_number % 4], whole);
        }
        while (*whole == 0) { /* until the first frame is complete: the header also takes time */
            nanosleep(&(struct timespec){0, 50000}, NULL);
        }
        random = random * 1664525u + 1013904223u;
        nanosleep(&(struct timespec){0, (long)(random >> 12) % 3000000}, NULL);
        assert_int_equal(kill(child, SIGKILL), 0);
        int status;
        assert_int_equal(waitpid(child, &status, 0), child);
        assert_true(WIFSIGNALED(status));

        uint32_t told = *whole;
        char error[256] = "";
        t3r_recording *recording = t3r_recording_open(path, error, sizeof error);
        if (recording == NULL) {
            fail_msg("%s", error);
        }
        uint32_t count = t3r_recording_frame_count(recording);
        assert_in_range(count, told, told + 1); /* the frame after the last reported one may be complete */
        for (uint32_t i = count > 3 ? count - 3 : 0; i < count; i++) {
            check_frame(recording, i);
        }
        cut += strstr(t3r_recording_note(recording), "cut off") != NULL;
        frames += count;
        t3r_recording_close(recording);
    }
    assert_int_equal(cut, KILLS);
    assert_true(frames > KILLS * 3);
    munmap((void *)whole, 4096);
}

TEST_WITH(files_roll_over_within_their_bytes, scratch_setup, scratch_teardown)
{
    scratch *s = *state;
    static capture_record record;
    char first[600];
    snprintf(first, sizeof first, "%s", scratch_path(s, "roll.v1.mcap"));
    const uint64_t most = 100000;
    assert_int_equal(capture_record_begin(&record, first, most, true, "test", "monotonic", 1099511628, &stored), 0);
    for (uint32_t i = 0; i < 60; i++) {
        t3r_capture_frame frame = make_frame(i);
        assert_int_equal(capture_record_frame(&record, &frame), 0);
    }
    assert_int_equal(capture_record_end(&record), 0);
    uint32_t next = 0;
    uint64_t bytes = 0;
    assert_true(record.files > 3);
    for (uint32_t n = 0; n < record.files; n++) {
        char name[640], error[256] = "";
        struct stat about;
        capture_record_name(first, n, name, sizeof name);
        assert_int_equal(stat(name, &about), 0);
        assert_true((uint64_t)about.st_size <= most && about.st_size > 50000);
        bytes += (uint64_t)about.st_size;
        t3r_recording *recording = t3r_recording_open(name, error, sizeof error);
        assert_non_null(recording);
        assert_string_equal(t3r_recording_note(recording), "");
        for (uint32_t i = 0; i < t3r_recording_frame_count(recording); i++, next++) {
            t3r_capture_frame got;
            assert_int_equal(t3r_recording_frame(recording, i, &got, error, sizeof error), T3R_CAPTURE_FRAME);
            assert_int_equal(got.stamp_ns, 1000000000 + (int64_t)next * 33333333);
        }
        t3r_recording_close(recording);
    }
    assert_int_equal(next, 60);
    assert_int_equal(bytes, record.bytes);

    /* less than a frame */
    t3r_capture_frame frame = make_frame(0);
    assert_int_equal(capture_record_begin(&record, first, 20000, false, "test", "monotonic", 1099511628, &stored), 0);
    assert_int_equal(capture_record_frame(&record, &frame), -1);
    assert_non_null(strstr(record.error, "does not hold one frame"));
    assert_int_equal(capture_record_end(&record), 0);
}

TEST(names_are_numbered_before_their_ending)
{
    static const char *const cases[][2] = {{"a.mcap", "a-7.mcap"},
                                           {"d.x/a", "d.x/a-7"},
                                           {"d.x/a.b.mcap", "d.x/a.b-7.mcap"},
                                           {".hidden", ".hidden-7"},
                                           {"d/.hidden", "d/.hidden-7"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char name[64];
        capture_record_name(cases[i][0], 7, name, sizeof name);
        assert_string_equal(name, cases[i][1]);
        capture_record_name(cases[i][0], 0, name, sizeof name);
        assert_string_equal(name, cases[i][0]);
    }
}

TEST(a_full_disk_is_told)
{
    static capture_record record;
    int begun = capture_record_begin(&record, "/dev/full", 0, false, "test", "monotonic", 1099511628, &stored);
    assert_int_equal(begun, -1);
    assert_non_null(strstr(record.error, "/dev/full: cannot be written"));
    capture_record_end(&record);
    assert_int_equal(capture_record_begin(&record, "/nowhere/a.mcap", 0, false, "test", "m", 1099511628, &stored), -1);
    assert_non_null(strstr(record.error, "No such file"));
}
