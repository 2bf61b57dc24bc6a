/* SPDX-License-Identifier: Apache-2.0 */
/* Our own recordings: they read back as written, also when truncated anywhere; changed files are refused. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bag.h"
#include "mcap/chunk_packer.h"
#include "mcap/mcap_reader.h"
#include "messages/fixed_double.h"
#include "messages/pixel_layout.h"
#include "sample.h"
#include "test.h"
#include "trim3r_capture.h"

static bag_bytes sample(t3r_pixel_format format, uint32_t storage)
{
    bag_bytes bytes;
    bag_bytes_start(&bytes);
    assert_int_equal(sample_write(bag_sink(&bytes), format, storage), 0);
    return bytes;
}

static t3r_recording *parse(const uint8_t *bytes, size_t count)
{
    char error[256] = "";
    t3r_recording *recording = t3r_recording_parse(bytes, count, error, sizeof error);
    if (recording == NULL) {
        fail_msg("%s", error);
    }
    return recording;
}

static int64_t fixed(double value, uint32_t fraction_bits)
{
    int64_t result = 0;
    assert_int_equal(t3r_fixed_from_double(t3r_double_bits(value), fraction_bits, &result), 0);
    return result;
}

static void check_frame(const t3r_capture_frame *frame, uint32_t f, t3r_pixel_format format)
{
    assert_int_equal(frame->index, f);
    assert_int_equal(frame->stamp_ns, sample_stamp(f));
    assert_int_equal(frame->frame.format, format);
    assert_int_equal(frame->frame.width, SAMPLE_WIDTH);
    assert_int_equal(frame->frame.height, SAMPLE_HEIGHT);
    uint32_t row_bytes = t3r_pixel_row_bytes(format, SAMPLE_WIDTH);
    for (uint32_t p = 0; p < 2; p++) {
        for (uint32_t i = 0; i < row_bytes * t3r_pixel_rows(format, p, SAMPLE_HEIGHT); i++) {
            size_t at = (size_t)(i / row_bytes) * frame->frame.stride_bytes[p] + i % row_bytes;
            assert_int_equal(frame->frame.planes[p][at], sample_byte(f, p, i));
        }
    }
    if (f == 1) {
        assert_null(frame->frame.depth);
    } else {
        assert_int_equal(frame->frame.depth_width, SAMPLE_DEPTH_WIDTH);
        assert_int_equal(frame->frame.depth_height, SAMPLE_DEPTH_HEIGHT);
        assert_int_equal(frame->frame.depth_unit_q40, 219902326); /* 0.0002 */
        for (uint32_t i = 0; i < SAMPLE_DEPTH_WIDTH * SAMPLE_DEPTH_HEIGHT; i++) {
            const uint8_t *at = frame->frame.depth +
                                (size_t)(i / SAMPLE_DEPTH_WIDTH) * frame->frame.depth_stride_bytes +
                                (size_t)(i % SAMPLE_DEPTH_WIDTH) * 2;
            assert_int_equal(at[0] | at[1] << 8, sample_depth(f, i));
        }
    }
    const t3r_recorded_camera camera = sample_camera(f);
    assert_true(frame->has_intrinsics);
    assert_true(frame->has_pose);
    assert_int_equal(frame->camera.fx_q16, fixed(camera.fx, 16));
    assert_int_equal(frame->camera.fy_q16, fixed(camera.fy, 16));
    assert_int_equal(frame->camera.cx_q16, fixed(camera.cx, 16));
    assert_int_equal(frame->camera.cy_q16, fixed(camera.cy, 16));
    assert_int_equal(frame->camera.distortion, camera.distortion);
    for (uint32_t i = 0; i < 5; i++) {
        assert_int_equal(frame->camera.distortion_q24[i], fixed(camera.coefficients[i], 24));
    }
    for (uint32_t i = 0; i < 3; i++) {
        assert_int_equal(frame->camera.position_q32[i], fixed(camera.position[i], 32));
    }
    for (uint32_t i = 0; i < 4; i++) {
        assert_int_equal(frame->camera.rotation_q30[i], fixed(camera.rotation[i], 30));
    }
}

static void check_readable(const t3r_recording *recording, uint32_t frames, t3r_pixel_format format)
{
    assert_int_equal(t3r_recording_frame_count(recording), frames);
    for (uint32_t f = 0; f < frames; f++) {
        t3r_capture_frame frame;
        char error[256] = "";
        if (t3r_recording_frame(recording, f, &frame, error, sizeof error) != T3R_CAPTURE_FRAME) {
            fail_msg("%s", error);
        }
        check_frame(&frame, f, format);
    }
}

TEST(round_trip_of_every_format)
{
    for (uint32_t i = 0; i < T3R_PIXEL_FORMAT_COUNT * SAMPLE_STORAGES; i++) {
        uint32_t format = i / SAMPLE_STORAGES;
        bag_bytes bytes = sample((t3r_pixel_format)format, i % SAMPLE_STORAGES);
        t3r_recording *recording = parse(bytes.data, bytes.count);
        check_readable(recording, SAMPLE_FRAMES, (t3r_pixel_format)format);
        assert_string_equal(t3r_recording_note(recording), "");
        assert_string_equal(t3r_recording_clock(recording), "synthetic");
        assert_int_equal(t3r_recording_bits_epoch(recording), T3R_BITS_EPOCH);
        assert_int_equal(t3r_recording_triplet_count(recording), 2);
        for (uint32_t t = 0; t < 2; t++) {
            t3r_triplet expected = sample_triplet(t), found = t3r_recording_triplet(recording, t);
            assert_memory_equal(&found, &expected, sizeof found);
        }
        t3r_pairing_info pairing = t3r_recording_pairing(recording);
        assert_int_equal(pairing.frames, SAMPLE_FRAMES);
        assert_int_equal(pairing.with_depth, SAMPLE_FRAMES - 1);
        assert_int_equal(pairing.with_pose, SAMPLE_FRAMES);
        assert_int_equal(pairing.with_intrinsics, SAMPLE_FRAMES);
        assert_int_equal(pairing.worst_depth_gap_ns, 0);
        assert_int_equal(pairing.worst_pose_gap_ns, 0);
        static const char *const topics[] = {"/camera/image", "/camera/depth", "/camera/camera_info", "/camera/pose",
                                             "/tf"};
        static const uint64_t messages[] = {SAMPLE_FRAMES, SAMPLE_FRAMES - 1, SAMPLE_FRAMES, SAMPLE_FRAMES,
                                            SAMPLE_FRAMES};
        assert_int_equal(t3r_recording_stream_count(recording), 5);
        for (uint32_t t = 0; t < 5; t++) {
            t3r_stream_info stream = t3r_recording_stream(recording, t);
            assert_string_equal(stream.topic, topics[t]);
            assert_int_equal(stream.messages, messages[t]);
            assert_int_equal(stream.first_ns, sample_stamp(0));
            assert_int_equal(stream.last_ns, sample_stamp(SAMPLE_FRAMES - 1));
        }
        t3r_recording_close(recording);
        bag_bytes_free(&bytes);
    }
}

TEST(frame_out_of_range_is_refused)
{
    bag_bytes bytes = sample(T3R_PIXEL_RGB24, SAMPLE_NONE);
    t3r_recording *recording = parse(bytes.data, bytes.count);
    t3r_capture_frame frame;
    char error[256] = "";
    assert_int_equal(t3r_recording_frame(recording, SAMPLE_FRAMES, &frame, error, sizeof error), T3R_CAPTURE_FAILED);
    assert_non_null(strstr(error, "frame 3"));
    t3r_recording_close(recording);
    bag_bytes_free(&bytes);
}

/* ---- ends of messages, by the record reader ---- */

typedef struct ends {
    const uint8_t *base;
    uint32_t messages;
    size_t end[20];
    uint32_t images[20]; /* number of frames that are complete after each message */
} ends;

static int no_schema(void *user, const t3r_mcap_schema_record *schema, t3r_mcap_place place)
{
    (void)user, (void)schema, (void)place;
    return 0;
}

static int no_channel(void *user, const t3r_mcap_channel_record *channel, t3r_mcap_place place)
{
    (void)user, (void)channel, (void)place;
    return 0;
}

static int no_metadata(void *user, t3r_text name, t3r_text key, t3r_text value, t3r_mcap_place place)
{
    (void)user, (void)name, (void)key, (void)value, (void)place;
    return 0;
}

static int note_message(void *user, const t3r_mcap_message_record *message, t3r_mcap_place place)
{
    (void)place;
    ends *e = user;
    assert_true(e->messages < 20);
    e->end[e->messages] = (size_t)(message->data + message->bytes - e->base);
    e->images[e->messages] = (e->messages > 0 ? e->images[e->messages - 1] : 0) + (message->channel == 0);
    e->messages++;
    return 0;
}

static void check_cuts(uint32_t storage)
{
    bag_bytes bytes = sample(T3R_PIXEL_YUYV, storage);
    ends e = {.base = bytes.data};
    const t3r_mcap_visitor visitor = {&e, no_schema, no_channel, note_message, no_metadata};
    t3r_mcap_chunks chunks = {0};
    t3r_mcap_end end;
    assert_int_equal(t3r_mcap_read(bytes.data, bytes.count, &visitor, &chunks, &end, NULL, 0), 0);
    assert_int_equal(e.messages, 5 * SAMPLE_FRAMES - 1);
    t3r_mcap_chunks_free(&chunks);
    uint32_t whole = 0, cut_with_all_messages = 0;
    for (size_t count = 0; count < bytes.count; count++) {
        /* A copy of exactly this size, so that a sanitizer sees a read past it. */
        uint8_t *cut = malloc(count > 0 ? count : 1);
        memcpy(cut, bytes.data, count);
        char error[256] = "";
        t3r_recording *recording = t3r_recording_parse(cut, count, error, sizeof error);
        while (whole < e.messages && e.end[whole] <= count) {
            whole++;
        }
        if (count < 8) {
            assert_null(recording);
            assert_string_not_equal(error, "");
        } else {
            if (recording == NULL) {
                fail_msg("cut at %zu: %s", count, error);
            }
            char expected[64];
            snprintf(expected, sizeof expected, ", after %u of its messages", whole);
            assert_non_null(strstr(t3r_recording_note(recording), expected));
            check_readable(recording, whole > 0 ? e.images[whole - 1] : 0, T3R_PIXEL_YUYV);
            cut_with_all_messages += whole == e.messages;
            t3r_recording_close(recording);
        }
        free(cut);
    }
    assert_int_equal(whole, e.messages);
    assert_true(cut_with_all_messages > 100); /* cuts inside the summary lose no message */
    bag_bytes_free(&bytes);
}

TEST(cut_anywhere_reads_the_whole_messages)
{
    check_cuts(SAMPLE_UNCHUNKED);
    check_cuts(SAMPLE_NONE);
}

/* A cut chunk gives the part that could be unpacked. */
TEST(cut_anywhere_reads_what_can_be_unpacked)
{
    for (uint32_t storage = SAMPLE_ZSTD; storage <= SAMPLE_LZ4; storage++) {
        bag_bytes bytes = sample(T3R_PIXEL_YUYV, storage);
        uint32_t frames = 0;
        for (size_t count = 8; count < bytes.count; count++) {
            uint8_t *cut = malloc(count);
            memcpy(cut, bytes.data, count);
            t3r_recording *recording = parse(cut, count);
            uint32_t found = t3r_recording_frame_count(recording);
            assert_true(found >= frames);
            frames = found;
            assert_non_null(strstr(t3r_recording_note(recording), "cut off"));
            check_readable(recording, found, T3R_PIXEL_YUYV);
            t3r_recording_close(recording);
            free(cut);
        }
        assert_int_equal(frames, SAMPLE_FRAMES);
        bag_bytes_free(&bytes);
    }
}

TEST(zeros_behind_a_cut_are_no_records)
{
    bag_bytes bytes = sample(T3R_PIXEL_GREY, SAMPLE_NONE);
    size_t kept = bytes.count / 2;
    memset(bytes.data + kept, 0, bytes.count - kept);
    t3r_recording *recording = parse(bytes.data, bytes.count);
    assert_non_null(strstr(t3r_recording_note(recording), "cut off"));
    t3r_recording_close(recording);
    bag_bytes_free(&bytes);
}

static void check_changes(uint32_t storage)
{
    bag_bytes bytes = sample(T3R_PIXEL_RGB24, storage);
    for (size_t i = 0; i < bytes.count; i++) {
        for (uint32_t way = 0; way < (storage == SAMPLE_NONE ? 2 : 1); way++) {
            uint8_t change = (uint8_t)(way == 0 ? 1u << i % 8 : 0xff);
            bytes.data[i] = (uint8_t)(bytes.data[i] ^ change);
            char error[256] = "";
            t3r_recording *recording = t3r_recording_parse(bytes.data, bytes.count, error, sizeof error);
            if (recording != NULL) {
                fail_msg("byte %zu xor %u was not noticed", i, change);
            }
            assert_non_null(strstr(error, "byte"));
            bytes.data[i] = (uint8_t)(bytes.data[i] ^ change);
        }
    }
    bag_bytes_free(&bytes);
}

TEST(every_changed_byte_is_noticed)
{
    for (uint32_t storage = 0; storage < SAMPLE_STORAGES; storage++) {
        check_changes(storage);
    }
}

TEST(foreign_and_empty_files_are_refused)
{
    static const struct {
        const char *bytes;
        size_t count;
        const char *reason;
    } files[] = {
        {"", 0, "the file is empty"},
        {"\x89MCA", 4, "cut off inside the magic"},
        {"\x89PNG\r\n\x1a\n rest", 13, "a picture: name the folder"},
        {"\xff\xd8\xff\xe0 rest", 9, "a picture: name the folder"},
        {"ply\nformat ascii", 16, "a scene, not a recording"},
        {"glTF\2\0\0\0", 8, "a scene, not a recording"},
        {"NGSP\4\0\0\0", 8, "a scene, not a recording"},
        {"plain text", 10, "not an MCAP file"},
        {"#ROSBAG V2.0\n", 13, "a bag of ROS 1"},
        {"SQLite format 3", 16, "mcap convert"},
        {"\x89MCAP1\r\n\x01", 9, "an MCAP version other than 0"},
        {"\x89MCAP0\r\n\x05\x01\0\0\0\0\0\0\0?", 18, "the first record is not a Header"},
        {"\x89MCAP0\r\n\x89MCAP0\r\n", 16, "no Footer record"},
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char error[256] = "";
        assert_null(t3r_recording_parse((const uint8_t *)files[i].bytes, files[i].count, error, sizeof error));
        if (strstr(error, files[i].reason) == NULL) {
            fail_msg("'%s' says nothing of '%s'", error, files[i].reason);
        }
    }
}

TEST(a_failing_sink_fails_the_recorder)
{
    for (uint32_t storage = 0; storage < SAMPLE_STORAGES; storage++) {
        bag_bytes bytes = sample(T3R_PIXEL_NV12, storage);
        size_t count = bytes.count;
        bag_bytes_free(&bytes);
        for (size_t room = 0; room <= count; room++) {
            bag_bytes_start(&bytes);
            bytes.room_left = room;
            assert_int_equal(sample_write(bag_sink(&bytes), T3R_PIXEL_NV12, storage), room < count ? -1 : 0);
            assert_true(bytes.count <= room);
            bag_bytes_free(&bytes);
        }
    }
}

/* A sink that cannot be read back gets the output of --unchunked. */
TEST(without_reading_back_there_are_no_chunks)
{
    bag_bytes plain = sample(T3R_PIXEL_RGB24, SAMPLE_UNCHUNKED), written;
    bag_bytes_start(&written);
    t3r_sink sink = bag_sink(&written);
    sink.read = NULL;
    assert_int_equal(sample_write(sink, T3R_PIXEL_RGB24, SAMPLE_NONE), 0);
    assert_int_equal(written.count, plain.count);
    assert_memory_equal(written.data, plain.data, plain.count);
    bag_bytes_free(&plain);
    bag_bytes_free(&written);
}

/* A sink that fails to return written bytes makes the recorder fail. */
static int read_nothing(void *user, uint64_t offset, void *data, size_t count)
{
    (void)user, (void)offset;
    memset(data, 0, count);
    return 0;
}

TEST(a_sink_that_lies_fails_the_recorder)
{
    bag_bytes written;
    bag_bytes_start(&written);
    t3r_sink sink = bag_sink(&written);
    sink.read = read_nothing;
    assert_int_equal(sample_write(sink, T3R_PIXEL_RGB24, SAMPLE_NONE), -1);
    bag_bytes_free(&written);
}

TEST(the_same_frames_give_the_same_bytes)
{
    for (uint32_t storage = 0; storage < SAMPLE_STORAGES; storage++) {
        bag_bytes one = sample(T3R_PIXEL_NV12, storage), two = sample(T3R_PIXEL_NV12, storage);
        assert_int_equal(one.count, two.count);
        assert_memory_equal(one.data, two.data, one.count);
        bag_bytes_free(&one);
        bag_bytes_free(&two);
    }
}

/* Contents that would compress beyond a reader's limit for so small a file are stored uncompressed. */
TEST(a_flat_picture_stays_readable)
{
    enum { SIDE = 1024 };
    uint8_t *grey = calloc(SIDE, SIDE);
    bag_bytes bytes;
    bag_bytes_start(&bytes);
    uint64_t memory[T3R_RECORDER_BYTES / 8];
    t3r_recorder *recorder = (t3r_recorder *)memory;
    const t3r_chunk_packer *packer = t3r_chunk_packer_open(T3R_COMPRESSION_ZSTD);
    const t3r_recording_header header = {
        .camera = "c", .source = "", .clock = "synthetic", .depth_unit = 0.001, .packer = packer};
    assert_int_equal(t3r_recorder_begin(recorder, bag_sink(&bytes), &header), 0);
    for (uint32_t f = 0; f < 200; f++) { /* more than T3R_LIMIT_UNPACKED_FREE */
        const t3r_recorded_frame frame = {.stamp_ns = f,
                                          .format = T3R_PIXEL_GREY,
                                          .width = SIDE,
                                          .height = SIDE,
                                          .planes = {grey},
                                          .stride_bytes = {SIDE},
                                          .unposed = true,
                                          .uncalibrated = true};
        assert_int_equal(t3r_recorder_frame(recorder, &frame), 0);
    }
    uint64_t most = t3r_recorder_offset(recorder) + t3r_recorder_end_bytes(recorder);
    assert_int_equal(t3r_recorder_end(recorder), 0);
    assert_true(t3r_recorder_offset(recorder) <= most);
    t3r_recording *recording = parse(bytes.data, bytes.count);
    assert_int_equal(t3r_recording_frame_count(recording), 200);
    t3r_recording_close(recording);
    t3r_chunk_packer_close(packer);
    bag_bytes_free(&bytes);
    free(grey);
}

TEST(the_recorder_refuses_bad_arguments)
{
    assert_true(t3r_recorder_bytes() <= T3R_RECORDER_BYTES);
    uint64_t memory[T3R_RECORDER_BYTES / 8];
    t3r_recorder *recorder = (t3r_recorder *)memory;
    bag_bytes bytes;
    bag_bytes_start(&bytes);
    const t3r_recording_header good = {.camera = "a/b_1", .source = "", .clock = "x", .depth_unit = 1};
    static const char *const names[] = {
        "", "/a", "a/", "a//b", "a b", "\xc3\xa4", "a123456789b123456789c123456789d123456789e1234567"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        t3r_recording_header bad = good;
        bad.camera = names[i];
        assert_int_equal(t3r_recorder_begin(recorder, bag_sink(&bytes), &bad), -1);
    }
    static const double units[] = {0, -1, 1e-13, 65536, 1e300};
    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
        t3r_recording_header bad = good;
        bad.depth_unit = units[i];
        assert_int_equal(t3r_recorder_begin(recorder, bag_sink(&bytes), &bad), -1);
    }
    assert_int_equal(bytes.count, 0);
    assert_int_equal(t3r_recorder_begin(recorder, bag_sink(&bytes), &good), 0);
    size_t before = bytes.count;
    static const uint8_t pixels[64] = {0};
    const t3r_recorded_frame frame = {
        .format = T3R_PIXEL_NV12,
        .width = 4,
        .height = 4,
        .planes = {pixels, pixels},
        .stride_bytes = {4, 4},
        .camera = {.width = 4, .height = 4},
    };
    t3r_recorded_frame bad[11];
    for (size_t i = 0; i < 11; i++) {
        bad[i] = frame;
    }
    bad[0].stamp_ns = -1;
    bad[1].stamp_ns = INT64_C(2147483648000000000);
    bad[2].format = T3R_PIXEL_FORMAT_COUNT;
    bad[3].width = bad[3].camera.width = 5000;
    bad[4].height = bad[4].camera.height = 3;
    bad[5].planes[1] = NULL;
    bad[6].stride_bytes[1] = 3;
    bad[7].camera.width = 5;
    bad[8].camera.distortion = T3R_DISTORTION_COUNT;
    bad[9].depth = (const uint16_t *)memory;
    bad[10].planes[0] = NULL;
    for (size_t i = 0; i < 11; i++) {
        assert_int_equal(t3r_recorder_frame(recorder, &bad[i]), -1);
    }
    assert_int_equal(bytes.count, before);
    assert_int_equal(t3r_recorder_frame(recorder, &frame), 0);
    assert_int_equal(t3r_recorder_end(recorder), 0);
    t3r_recording *recording = parse(bytes.data, bytes.count);
    assert_int_equal(t3r_recording_frame_count(recording), 1);
    t3r_recording_close(recording);
    bag_bytes_free(&bytes);
}

TEST(replay_hands_out_the_frames)
{
    char path[] = "recording-test-XXXXXX";
    int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    FILE *file = fdopen(descriptor, "wb");
    assert_non_null(file);
    assert_int_equal(sample_write(t3r_file_sink(file), T3R_PIXEL_UYVY, SAMPLE_NONE), 0);
    assert_int_equal(fclose(file), 0);
    char error[256] = "";
    t3r_capture *capture = t3r_replay_open(path, error, sizeof error);
    if (capture == NULL) {
        fail_msg("%s", error);
    }
    t3r_capture_frame frame;
    for (uint32_t f = 0; f < SAMPLE_FRAMES; f++) {
        assert_int_equal(t3r_capture_next(capture, &frame), T3R_CAPTURE_FRAME);
        check_frame(&frame, f, T3R_PIXEL_UYVY);
    }
    assert_int_equal(t3r_capture_next(capture, &frame), T3R_CAPTURE_END);
    assert_int_equal(t3r_capture_next(capture, &frame), T3R_CAPTURE_END);
    assert_string_equal(t3r_capture_error(capture), "");
    t3r_capture_close(capture);

    file = fopen(path, "r+b");
    assert_non_null(file);
    assert_int_equal(fseek(file, 100, SEEK_SET), 0);
    assert_int_equal(fputc(0xff, file), 0xff);
    assert_int_equal(fclose(file), 0);
    assert_null(t3r_replay_open(path, error, sizeof error));
    assert_non_null(strstr(error, path));
    assert_non_null(strstr(error, "byte"));
    assert_int_equal(remove(path), 0);

    assert_null(t3r_replay_open(path, error, sizeof error));
    assert_non_null(strstr(error, "No such file"));
    assert_null(t3r_replay_open(".", error, sizeof error));
    assert_non_null(strstr(error, "directory"));
}

/* A pose that is set replaces the recorded one; another frame keeps its own. */
TEST(a_set_pose_wins)
{
    static const int64_t position_q32[3] = {INT64_C(5) << 40, -7, 0};
    static const int32_t rotation_q30[4] = {3, 1 << 29, -5, 1 << 28};
    bag_bytes bytes = sample(T3R_PIXEL_RGB24, SAMPLE_NONE);
    t3r_recording *recording = parse(bytes.data, bytes.count);
    t3r_capture_frame frame;
    char error[256] = "";
    assert_int_equal(t3r_recording_set_pose(recording, SAMPLE_FRAMES, position_q32, rotation_q30), -1);
    assert_int_equal(t3r_recording_set_pose(recording, 1, position_q32, rotation_q30), 0);
    assert_int_equal(t3r_recording_frame(recording, 1, &frame, error, sizeof error), T3R_CAPTURE_FRAME);
    assert_true(frame.has_pose);
    assert_memory_equal(frame.camera.position_q32, position_q32, sizeof position_q32);
    assert_memory_equal(frame.camera.rotation_q30, rotation_q30, sizeof rotation_q30);
    assert_int_equal(t3r_recording_frame(recording, 0, &frame, error, sizeof error), T3R_CAPTURE_FRAME);
    check_frame(&frame, 0, T3R_PIXEL_RGB24);
    t3r_recording_close(recording);
    bag_bytes_free(&bytes);
}
