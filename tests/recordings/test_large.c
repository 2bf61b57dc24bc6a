/* SPDX-License-Identifier: Apache-2.0 */
/* Recordings that unpack to more than memory should hold can be read, and returned bytes keep their address. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mcap/chunk_packer.h"
#include "mcap/spill.h"
#include "recording/recording.h"
#include "scratch.h"
#include "test.h"

/* 166 MB of pictures in a file a quarter as large: more than T3R_LIMIT_UNPACKED_HEAP. */
enum { FRAMES = 20, WIDTH = 1920, HEIGHT = 1440, ROW_BYTES = WIDTH * 3, NOISE_BYTES = ROW_BYTES / 4 };

static void fill(uint8_t *rgb, uint32_t frame)
{
    uint32_t noise = frame + 1;
    memset(rgb, (int)frame, (size_t)ROW_BYTES * HEIGHT);
    for (uint32_t y = 0; y < HEIGHT; y++) {
        for (uint32_t x = 0; x < NOISE_BYTES; x++) {
            noise = noise * 1664525u + 1013904223u;
            rgb[(size_t)y * ROW_BYTES + x] = (uint8_t)(noise >> 24);
        }
    }
}

static int make_recording(void **state)
{
    if (scratch_setup(state) != 0) {
        return -1;
    }
    const char *path = scratch_path(*state, "large.mcap");
    uint64_t memory[T3R_RECORDER_BYTES / 8];
    t3r_recorder *recorder = (t3r_recorder *)memory;
    FILE *file = fopen(path, "w+b");
    uint8_t *rgb = malloc((size_t)ROW_BYTES * HEIGHT);
    const t3r_chunk_packer *packer = t3r_chunk_packer_open(T3R_COMPRESSION_LZ4);
    assert_true(file != NULL && rgb != NULL && packer != NULL);
    const t3r_recording_header header = {
        .camera = "camera", .source = "", .clock = "synthetic", .depth_unit = 0.001, .packer = packer};
    assert_int_equal(t3r_recorder_begin(recorder, t3r_file_sink(file), &header), 0);
    for (uint32_t i = 0; i < FRAMES; i++) {
        fill(rgb, i);
        const t3r_recorded_frame frame = {.stamp_ns = INT64_C(33333333) * i,
                                          .format = T3R_PIXEL_RGB24,
                                          .width = WIDTH,
                                          .height = HEIGHT,
                                          .planes = {rgb},
                                          .stride_bytes = {ROW_BYTES},
                                          .camera = {.width = WIDTH,
                                                     .height = HEIGHT,
                                                     .fx = 1000,
                                                     .fy = 1000,
                                                     .cx = WIDTH / 2.0,
                                                     .cy = HEIGHT / 2.0,
                                                     .rotation = {1, 0, 0, 0}}};
        assert_int_equal(t3r_recorder_frame(recorder, &frame), 0);
    }
    assert_int_equal(t3r_recorder_end(recorder), 0);
    assert_int_equal(fclose(file), 0);
    t3r_chunk_packer_close(packer);
    free(rgb);
    return 0;
}

TEST(reads_what_exceeds_memory)
{
    const uint8_t *places[FRAMES];
    char error[256] = "";
    uint8_t *rgb = malloc((size_t)ROW_BYTES * HEIGHT);
    t3r_recording *recording = t3r_recording_open(scratch_path(*state, "large.mcap"), error, sizeof error);
    if (recording == NULL || rgb == NULL) {
        fail_msg("%s", error);
        return;
    }
    assert_int_equal(t3r_recording_frame_count(recording), FRAMES);
    for (uint32_t i = 0; i < FRAMES; i++) {
        t3r_capture_frame frame;
        assert_int_equal(t3r_recording_frame(recording, i, &frame, error, sizeof error), T3R_CAPTURE_FRAME);
        places[i] = frame.frame.planes[0];
    }
    for (uint32_t i = 0; i < FRAMES; i++) {
        fill(rgb, i);
        assert_memory_equal(places[i], rgb, (size_t)ROW_BYTES * HEIGHT);
    }
    free(rgb);
    t3r_recording_close(recording);
}

/* Without room for it, the reason says so. */
TEST(says_that_there_is_no_room)
{
    char error[256] = "";
    char *kept = getenv("TMPDIR") == NULL ? NULL : strdup(getenv("TMPDIR"));
    const char *path = scratch_path(*state, "large.mcap");
    setenv("TMPDIR", "/dev/null", 1);
    assert_null(t3r_recording_open(path, error, sizeof error));
    assert_non_null(strstr(error, "no room on the disk"));
    if (kept != NULL) {
        setenv("TMPDIR", kept, 1);
    } else {
        unsetenv("TMPDIR");
    }
    free(kept);
}

TEST(spills)
{
    t3r_spill spill = {0};
    uint8_t *a = t3r_spill_take(&spill, 100);
    uint8_t *b = t3r_spill_take(&spill, (size_t)100 << 20); /* too large to share a part */
    assert_true(a != NULL && b != NULL);
    memset(a, 7, 100);
    memset(b, 8, 4096);
    b[((size_t)100 << 20) - 1] = 9;
    t3r_spill_rest(&spill);
    assert_true(a[0] == 7 && a[99] == 7 && b[4095] == 8 && b[((size_t)100 << 20) - 1] == 9);
    uint8_t *c = t3r_spill_take(&spill, 1);
    t3r_spill_return(&spill, 1);
    assert_ptr_equal(t3r_spill_take(&spill, 50), c);
    assert_null(t3r_spill_take(&spill, SIZE_MAX));
    t3r_spill_free(&spill);
    assert_true(spill.parts == NULL && spill.file == 0);
}

ALL_TESTS_WITH(make_recording, scratch_teardown)
