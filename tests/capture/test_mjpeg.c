/* SPDX-License-Identifier: Apache-2.0 */
/* Motion JPEG: pictures that a camera compressed, with and without Huffman tables, and damaged ones. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>

#include "capture/capture_adapter.h"
#include "capture/mjpeg.h"
#include "capture/v4l2.h"
#include "fake_v4l2.h"
#include "mcap/reader_limits.h"
#include "test.h"

enum { WIDTH = 32, HEIGHT = 16 };

static uint8_t rgb_of(uint32_t number, uint32_t x, uint32_t y, uint32_t channel)
{
    return (uint8_t)(x * 3 + number * 4 + y * 2 + channel * 20);
}

/* Makes a JPEG of 4:2:2, as webcams do; returns its bytes. */
static uint32_t compress(uint32_t number, uint8_t *out, uint32_t room)
{
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char *memory = NULL;
    unsigned long bytes = 0;
    jpeg_mem_dest(&jpeg, &memory, &bytes);
    jpeg.image_width = WIDTH;
    jpeg.image_height = HEIGHT;
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 92, TRUE);
    jpeg.comp_info[0].h_samp_factor = 2;
    jpeg.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&jpeg, TRUE);
    for (uint32_t y = 0; y < HEIGHT; y++) {
        uint8_t row[WIDTH * 3];
        for (uint32_t i = 0; i < WIDTH * 3; i++) {
            row[i] = rgb_of(number, i / 3, y, i % 3);
        }
        JSAMPROW rows[1] = {row};
        jpeg_write_scanlines(&jpeg, rows, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    assert_true(bytes <= room);
    memcpy(out, memory, bytes);
    free(memory);
    return (uint32_t)bytes;
}

/* Removes the DHT segments: many cameras send none and rely on the tables of the standard. */
static uint32_t without_tables(uint8_t *jpeg, uint32_t bytes)
{
    uint32_t removed = 0;
    for (uint32_t at = 2; at + 4 < bytes && jpeg[at] == 0xff && jpeg[at + 1] != 0xda;) {
        uint32_t length = 2u + jpeg[at + 2] * 256u + jpeg[at + 3];
        if (jpeg[at + 1] == 0xc4) {
            memmove(jpeg + at, jpeg + at + length, bytes - at - length);
            bytes -= length;
            removed++;
        } else {
            at += length;
        }
    }
    assert_true(removed > 0);
    return bytes;
}

static void check(const uint8_t *rgb, uint32_t number)
{
    for (uint32_t i = 0; i < WIDTH * HEIGHT * 3; i++) {
        int expected = rgb_of(number, i / 3 % WIDTH, i / 3 / WIDTH, i % 3), off = rgb[i] - expected;
        assert_true(off >= -12 && off <= 12); /* chroma has half the columns */
    }
}

TEST(pictures_are_decoded_with_and_without_tables)
{
    uint8_t jpeg[4096], rgb[WIDTH * HEIGHT * 3], again[WIDTH * HEIGHT * 3];
    t3r_mjpeg *decoder = t3r_mjpeg_open();
    assert_non_null(decoder);
    uint32_t bytes = compress(0, jpeg, sizeof jpeg);
    assert_null(t3r_mjpeg_decode(decoder, jpeg, bytes, WIDTH, HEIGHT, rgb));
    check(rgb, 0);
    bytes = without_tables(jpeg, bytes);
    assert_null(t3r_mjpeg_decode(decoder, jpeg, bytes, WIDTH, HEIGHT, again));
    assert_memory_equal(rgb, again, sizeof rgb);
    assert_non_null(t3r_mjpeg_decode(decoder, jpeg, bytes, WIDTH, HEIGHT + 8, rgb));
    /* truncated anywhere: a reason, no crash, and the next picture is decoded */
    bytes = compress(1, jpeg, sizeof jpeg);
    for (uint32_t cut = 0; cut < bytes - 2; cut++) {
        assert_non_null(t3r_mjpeg_decode(decoder, jpeg, cut, WIDTH, HEIGHT, rgb));
    }
    assert_null(t3r_mjpeg_decode(decoder, jpeg, bytes, WIDTH, HEIGHT, rgb));
    t3r_mjpeg_close(decoder);
    t3r_mjpeg_close(NULL);
}

/* As files are (test_picture.c). */
TEST(stray_bytes_and_a_missing_end_are_borne)
{
    uint8_t jpeg[4096], rgb[WIDTH * HEIGHT * 3], again[WIDTH * HEIGHT * 3];
    t3r_mjpeg *decoder = t3r_mjpeg_open();
    assert_non_null(decoder);
    uint32_t bytes = compress(2, jpeg, sizeof jpeg);
    assert_null(t3r_mjpeg_decode(decoder, jpeg, bytes, WIDTH, HEIGHT, rgb));
    assert_null(t3r_mjpeg_decode(decoder, jpeg, bytes - 2, WIDTH, HEIGHT, again)); /* without the end marker */
    assert_memory_equal(rgb, again, sizeof rgb);
    static const uint8_t stray[3] = {0, 0x55, 0xaa};
    const uint32_t places[2] = {2, bytes - 2}; /* before the first segment, and before the end */
    for (uint32_t i = 0; i < 2; i++) {
        uint8_t with[4096 + sizeof stray];
        memcpy(with, jpeg, places[i]);
        memcpy(with + places[i], stray, sizeof stray);
        memcpy(with + places[i] + sizeof stray, jpeg + places[i], bytes - places[i]);
        memset(again, 0, sizeof again);
        assert_null(t3r_mjpeg_decode(decoder, with, bytes + sizeof stray, WIDTH, HEIGHT, again));
        assert_memory_equal(rgb, again, sizeof rgb);
    }
    t3r_mjpeg_close(decoder);
}

/* Progressive, with any number of scans: the means first, then one coefficient of one colour per scan, one bit more
 * each time. */
TEST(many_scans_are_refused_early)
{
    uint8_t rgb[WIDTH * HEIGHT * 3];
    t3r_mjpeg *decoder = t3r_mjpeg_open();
    assert_non_null(decoder);
    for (int scans = 30; scans <= 300; scans += 270) {
        jpeg_scan_info script[300] = {{.comps_in_scan = 3, .component_index = {0, 1, 2}}};
        for (int i = 1; i < scans; i++) {
            int k = (i - 1) / 3;
            script[i] = (jpeg_scan_info){.comps_in_scan = 1, .component_index = {(i - 1) % 3}};
            script[i].Ss = script[i].Se = 1 + k % 63;
            script[i].Ah = k < 63 ? 0 : 10 - k / 63;
            script[i].Al = 9 - k / 63;
        }
        struct jpeg_compress_struct jpeg;
        struct jpeg_error_mgr errors;
        unsigned char *memory = NULL;
        unsigned long bytes = 0;
        jpeg.err = jpeg_std_error(&errors);
        jpeg_create_compress(&jpeg);
        jpeg_mem_dest(&jpeg, &memory, &bytes);
        jpeg.image_width = WIDTH;
        jpeg.image_height = HEIGHT;
        jpeg.input_components = 3;
        jpeg.in_color_space = JCS_RGB;
        jpeg_set_defaults(&jpeg);
        jpeg.num_scans = scans;
        jpeg.scan_info = script;
        jpeg_start_compress(&jpeg, TRUE);
        for (uint32_t y = 0; y < HEIGHT; y++) {
            uint8_t row[WIDTH * 3] = {0};
            JSAMPROW rows[1] = {row};
            jpeg_write_scanlines(&jpeg, rows, 1);
        }
        jpeg_finish_compress(&jpeg);
        jpeg_destroy_compress(&jpeg);
        const char *wrong = t3r_mjpeg_decode(decoder, memory, bytes, WIDTH, HEIGHT, rgb);
        if (scans <= T3R_LIMIT_JPEG_SCANS) {
            assert_null(wrong);
        } else {
            assert_string_equal(wrong, "more than 32 scans");
        }
        free(memory);
    }
    t3r_mjpeg_close(decoder);
}

static uint32_t fill(void *user, const fake_node *node, uint32_t number, uint8_t *memory)
{
    (void)user;
    uint32_t bytes = compress(number, memory, node->bytes);
    if (number == 2) {
        memory[bytes - 20] = 0xff; /* the end, too early */
        memory[bytes - 19] = 0xd9;
    }
    return bytes;
}

TEST(a_camera_of_motion_jpeg_is_captured)
{
    fake_v4l2 fake;
    fake_start(&fake);
    fake.node[0].formats[0] = V4L2_PIX_FMT_MJPEG;
    fake.node[0].padding = 128; /* so that a buffer holds a JPEG */
    fake.node[0].fill = fill;
    fake.node[0].unplug_at = 6;
    t3r_capture_settings wish = {.width = WIDTH, .height = HEIGHT, .format = "MJPG"}, filled;
    assert_null(t3r_capture_settings_fill(&wish, &filled));
    char error[256] = "";
    t3r_v4l2_system system = fake_system(&fake);
    t3r_capture *capture = t3r_v4l2_open_on(&system, "/dev/video0", &filled, error, sizeof error);
    if (capture == NULL) {
        fail_msg("%s", error);
    }
    uint32_t frames = 0;
    for (int round = 0; round < 100 && frames < 9; round++) {
        t3r_capture_frame frame;
        int got = t3r_capture_next(capture, &frame);
        if (got == T3R_CAPTURE_LOST) {
            assert_int_equal(t3r_capture_reopen(capture), T3R_CAPTURE_FRAME);
        }
        if (got == T3R_CAPTURE_FRAME) {
            assert_int_equal(frame.frame.format, T3R_PIXEL_RGB24);
            assert_int_not_equal(frame.sequence, 2);
            check(frame.frame.planes[0], frame.sequence);
            frames++;
        }
    }
    assert_int_equal(frames, 9);
    assert_int_equal(t3r_capture_counts_of(capture).corrupted, 1);
    t3r_capture_close(capture);
    assert_true(fake_clean(&fake));
}
