/* SPDX-License-Identifier: Apache-2.0 */
/* The reader for firmware gives the same frames as the reader with a heap, and ends where a file is cut. */
#include <stdlib.h>
#include <string.h>

#include "bag.h"
#include "messages/pixel_layout.h"
#include "recording/frame_reader.h"
#include "sample.h"
#include "test.h"

enum { ROOM = 512 }; /* an image of the sample */

typedef struct reading {
    t3r_frame_reader reader;
    uint8_t colour[ROOM], depth[ROOM];
} reading;

/* Refuses what the source does not have, so that no test reads it unnoticed. */
static int read_bytes(void *user, uint64_t offset, void *bytes, size_t count)
{
    const bag_bytes *from = user;
    assert_true(offset <= from->count && count <= from->count - offset);
    memcpy(bytes, from->data + offset, count);
    return 0;
}

static int no_bytes(void *user, uint64_t offset, void *bytes, size_t count)
{
    (void)user, (void)offset, (void)bytes, (void)count;
    return -1;
}

static int open_reader(reading *r, bag_bytes *bytes, size_t count)
{
    const t3r_byte_source source = {read_bytes, bytes, count};
    return t3r_frame_reader_open(&r->reader, &source, r->colour, sizeof r->colour, r->depth, sizeof r->depth);
}

static bag_bytes sample(t3r_pixel_format format, uint32_t storage)
{
    bag_bytes bytes;
    bag_bytes_start(&bytes);
    assert_int_equal(sample_write(bag_sink(&bytes), format, storage), 0);
    return bytes;
}

static void check_rows(const uint8_t *a, uint32_t stride_a, const uint8_t *b, uint32_t stride_b, uint32_t row_bytes,
                       uint32_t rows)
{
    for (uint32_t y = 0; y < rows; y++) {
        assert_memory_equal(a + (size_t)y * stride_a, b + (size_t)y * stride_b, row_bytes);
    }
}

static void check_same(const t3r_capture_frame *a, const t3r_capture_frame *b)
{
    assert_int_equal(a->index, b->index);
    assert_int_equal(a->stamp_ns, b->stamp_ns);
    assert_int_equal(a->has_pose, b->has_pose);
    assert_int_equal(a->has_intrinsics, b->has_intrinsics);
    assert_memory_equal(&a->camera, &b->camera, sizeof a->camera);
    assert_int_equal(a->frame.format, b->frame.format);
    assert_int_equal(a->frame.width, b->frame.width);
    assert_int_equal(a->frame.height, b->frame.height);
    for (uint32_t p = 0; p < 2; p++) {
        check_rows(a->frame.planes[p], a->frame.stride_bytes[p], b->frame.planes[p], b->frame.stride_bytes[p],
                   t3r_pixel_row_bytes(a->frame.format, a->frame.width),
                   t3r_pixel_rows(a->frame.format, p, a->frame.height));
    }
    assert_int_equal(a->frame.depth == NULL, b->frame.depth == NULL);
    if (a->frame.depth != NULL) {
        assert_int_equal(a->frame.depth_width, b->frame.depth_width);
        assert_int_equal(a->frame.depth_height, b->frame.depth_height);
        assert_int_equal(a->frame.depth_unit_q40, b->frame.depth_unit_q40);
        check_rows(a->frame.depth, a->frame.depth_stride_bytes, b->frame.depth, b->frame.depth_stride_bytes,
                   a->frame.depth_width * 2, a->frame.depth_height);
    }
}

/* Compares the frame read in strips with the whole frame; planes begin with the strip. */
static void check_strips(bag_bytes *bytes, const t3r_capture_frame *whole, uint32_t strip)
{
    static reading r;
    t3r_capture_frame found;
    const t3r_frame *w = &whole->frame;
    assert_int_equal(open_reader(&r, bytes, bytes->count), 0);
    for (uint32_t i = 0; i <= whole->index; i++) {
        assert_int_equal(t3r_frame_reader_find(&r.reader, &found), T3R_CAPTURE_FRAME);
    }
    t3r_frame *f = &found.frame;
    assert_true(f->planes[0] == NULL && f->planes[1] == NULL && f->depth == NULL);
    assert_int_equal(f->depth_height, w->depth == NULL ? 0 : w->depth_height);
    for (uint32_t row = 0, depth_row = 0; row < f->height || depth_row < f->depth_height;) {
        const uint32_t rows = row + strip > f->height ? f->height - row : strip;
        const uint32_t depth_rows = depth_row + strip > f->depth_height ? f->depth_height - depth_row : strip;
        assert_int_equal(t3r_frame_reader_rows(&r.reader, f, row, rows, depth_row, depth_rows), 0);
        for (uint32_t p = 0; p < 2 && t3r_pixel_rows(f->format, p, rows) > 0; p++) {
            const uint32_t above = t3r_pixel_rows(f->format, p, row);
            check_rows(f->planes[p], f->stride_bytes[p], w->planes[p] + (size_t)above * w->stride_bytes[p],
                       w->stride_bytes[p], t3r_pixel_row_bytes(f->format, f->width),
                       t3r_pixel_rows(f->format, p, rows));
        }
        if (depth_rows > 0) {
            check_rows(f->depth, f->depth_stride_bytes, w->depth + (size_t)depth_row * w->depth_stride_bytes,
                       w->depth_stride_bytes, w->depth_width * 2, depth_rows);
        }
        row += rows;
        depth_row += depth_rows;
    }
    assert_int_equal(t3r_frame_reader_rows(&r.reader, f, f->height, 2, 0, 0), -1);
    assert_string_equal(r.reader.error, "these rows are not in the image");
}

/* Reads the bytes with both readers; returns the number of frames. */
static uint32_t check_both(bag_bytes *bytes)
{
    char error[256] = "";
    t3r_recording *recording = t3r_recording_parse(bytes->data, bytes->count, error, sizeof error);
    if (recording == NULL) {
        fail_msg("%s", error);
    }
    reading r;
    t3r_capture_frame expected, frame;
    assert_int_equal(open_reader(&r, bytes, bytes->count), 0);
    const uint32_t count = t3r_recording_frame_count(recording);
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(t3r_recording_frame(recording, i, &expected, error, sizeof error), T3R_CAPTURE_FRAME);
        if (t3r_frame_reader_next(&r.reader, &frame) != T3R_CAPTURE_FRAME) {
            fail_msg("frame %u: %s", i, r.reader.error != NULL ? r.reader.error : "the end");
        }
        check_same(&frame, &expected);
        check_strips(bytes, &expected, 2);
        check_strips(bytes, &expected, 1u << 10);
    }
    assert_int_equal(t3r_frame_reader_next(&r.reader, &frame), T3R_CAPTURE_END);
    t3r_recording_close(recording);
    return count;
}

TEST(frames_are_those_of_the_other_reader)
{
    for (uint32_t format = 0; format < T3R_PIXEL_FORMAT_COUNT; format++) {
        bag_bytes chunked = sample((t3r_pixel_format)format, SAMPLE_NONE);
        bag_bytes unchunked = sample((t3r_pixel_format)format, SAMPLE_UNCHUNKED);
        assert_int_equal(check_both(&chunked), SAMPLE_FRAMES);
        assert_int_equal(check_both(&unchunked), SAMPLE_FRAMES);
        bag_bytes_free(&chunked);
        bag_bytes_free(&unchunked);
    }
}

TEST(cut_anywhere_reads_whole_frames)
{
    bag_bytes bytes = sample(T3R_PIXEL_RGB24, SAMPLE_UNCHUNKED);
    uint32_t before = 0;
    for (size_t count = 8; count <= bytes.count; count++) {
        reading r;
        t3r_capture_frame frame;
        assert_int_equal(open_reader(&r, &bytes, count), 0);
        uint32_t frames = 0;
        while (t3r_frame_reader_next(&r.reader, &frame) == T3R_CAPTURE_FRAME) {
            frames++;
        }
        assert_null(r.reader.error);
        assert_in_range(frames, before, before + 1);
        before = frames;
    }
    assert_int_equal(before, SAMPLE_FRAMES);
    bag_bytes_free(&bytes);
}

static void refuse(bag_bytes *bytes, size_t colour_room, const char *expected)
{
    reading r;
    t3r_capture_frame frame;
    const t3r_byte_source source = {read_bytes, bytes, bytes->count};
    int status = t3r_frame_reader_open(&r.reader, &source, r.colour, colour_room, r.depth, sizeof r.depth);
    for (int i = 0; i < 2 * SAMPLE_FRAMES && status >= 0; i++) {
        status = t3r_frame_reader_next(&r.reader, &frame);
    }
    assert_int_equal(status, -1);
    assert_string_equal(r.reader.error, expected);
    assert_int_equal(t3r_frame_reader_next(&r.reader, &frame), T3R_CAPTURE_FAILED); /* the failure is final */
}

TEST(what_it_cannot_read_is_named)
{
    bag_bytes zstd = sample(T3R_PIXEL_RGB24, SAMPLE_ZSTD), plain = sample(T3R_PIXEL_RGB24, SAMPLE_NONE);
    refuse(&zstd, ROOM, "its chunks are compressed; trim3r import --compression none unpacks them");
    refuse(&plain, 64, "an image is larger than its buffer");
    plain.data[1] = 'X';
    refuse(&plain, ROOM, "this is no MCAP file");
    reading r;
    const t3r_byte_source silent = {no_bytes, NULL, 1000};
    assert_int_equal(t3r_frame_reader_open(&r.reader, &silent, r.colour, ROOM, NULL, 0), -1);
    assert_string_equal(r.reader.error, "the source does not give its bytes");
    bag_bytes_free(&zstd);
    bag_bytes_free(&plain);
}

TEST(depth_is_passed_over_without_a_buffer)
{
    bag_bytes bytes = sample(T3R_PIXEL_GREY, SAMPLE_NONE);
    reading r;
    t3r_capture_frame frame;
    const t3r_byte_source source = {read_bytes, &bytes, bytes.count};
    assert_int_equal(t3r_frame_reader_open(&r.reader, &source, r.colour, ROOM, NULL, 0), 0);
    assert_int_equal(t3r_frame_reader_next(&r.reader, &frame), T3R_CAPTURE_FRAME);
    assert_null(frame.frame.depth);
    bag_bytes_free(&bytes);
}

/* Depth in metres and big-endian depth, each after its colour image. */
TEST(foreign_depth_becomes_steps_in_its_place)
{
    static const uint8_t colour[4 * 4];
    const float metres[6] = {0.5f, 1.25f, -1, 70, 0.0015f, 2};
    const uint8_t swapped[12] = {0x01, 0xf4, 0x04, 0xe2, 0, 0, 0xff, 0xff, 0, 1, 0x07, 0xd0};
    for (uint32_t big = 0; big < 2; big++) {
        bag b;
        bag_start(&b);
        const uint16_t image = bag_channel(&b, "/camera/image", "sensor_msgs/msg/Image");
        const uint16_t depth = bag_channel(&b, "/camera/depth", "sensor_msgs/msg/Image");
        for (int64_t stamp = 1; stamp < 3; stamp++) {
            const bag_image grey = {stamp, 4, 4, 4, "mono8", false, colour, sizeof colour};
            const bag_image float_depth = {stamp, 3, 2, 12, "32FC1", false, metres, sizeof metres};
            const bag_image big_depth = {stamp, 3, 2, 6, "16UC1", true, swapped, sizeof swapped};
            bag_put_image(&b, image, &grey);
            bag_put_image(&b, depth, big != 0 ? &big_depth : &float_depth);
        }
        bag_finish(&b);
        assert_int_equal(check_both(&b.bytes), 2);
        bag_free(&b);
    }
}
