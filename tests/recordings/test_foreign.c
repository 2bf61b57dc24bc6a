/* SPDX-License-Identifier: Apache-2.0 */
/* Recordings by other writers: big-endian CDR, other encodings, other topics, stamps that do not match, chunks. */
#include <lz4frame.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zstd.h>

#include "bag.h"
#include "mcap/crc32.h"
#include "test.h"

#define MS INT64_C(1000000)

static const char image_type[] = "sensor_msgs/msg/Image", info_type[] = "sensor_msgs/msg/CameraInfo",
                  pose_type[] = "geometry_msgs/msg/PoseStamped",
                  transform_type[] = "geometry_msgs/msg/TransformStamped";

static uint8_t pixels[4 * 4 * 3];
static const double here[3] = {1.5, -2, 0.25}, upright[4] = {0, 0, 0, 1}; /* x y z w */

static bag_image colour_at(int64_t stamp_ns)
{
    return (bag_image){stamp_ns, 4, 4, 12, "rgb8", false, pixels, sizeof pixels};
}

static bag_info info_at(int64_t stamp_ns)
{
    return (bag_info){.stamp_ns = stamp_ns,
                      .width = 4,
                      .height = 4,
                      .model = "plumb_bob",
                      .d = {0.5, -0.25, 0, 0, 0.125},
                      .d_count = 5,
                      .k = {20.5, 0, 2, 0, 21, 1.5, 0, 0, 1}};
}

static t3r_recording *parse(const bag *b)
{
    char error[256] = "";
    t3r_recording *recording = t3r_recording_parse(b->bytes.data, b->bytes.count, error, sizeof error);
    if (recording == NULL) {
        fail_msg("%s", error);
    }
    return recording;
}

static t3r_capture_frame frame_of(const t3r_recording *recording, uint32_t index)
{
    t3r_capture_frame frame;
    char error[256] = "";
    if (t3r_recording_frame(recording, index, &frame, error, sizeof error) != T3R_CAPTURE_FRAME) {
        fail_msg("%s", error);
    }
    return frame;
}

/* Checks that opening fails with both texts in the reason. */
static void refuse_file(const bag *b, const char *what, const char *where)
{
    char error[256] = "";
    t3r_recording *recording = t3r_recording_parse(b->bytes.data, b->bytes.count, error, sizeof error);
    assert_null(recording);
    if (strstr(error, what) == NULL || strstr(error, where) == NULL) {
        fail_msg("'%s' says nothing of '%s', '%s'", error, what, where);
    }
}

static void refuse_frame(const t3r_recording *recording, uint32_t index, const char *what, const char *where)
{
    t3r_capture_frame frame;
    char error[256] = "";
    assert_int_equal(t3r_recording_frame(recording, index, &frame, error, sizeof error), T3R_CAPTURE_FAILED);
    if (strstr(error, what) == NULL || strstr(error, where) == NULL) {
        fail_msg("'%s' says nothing of '%s', '%s'", error, what, where);
    }
}

TEST(either_byte_order_reads_the_same)
{
    static const uint8_t depth_little[] = {0x34, 0x12, 0, 0, 1, 0, 0xff, 0xff};
    static const uint8_t depth_big[] = {0x12, 0x34, 0, 0, 0, 1, 0xff, 0xff};
    for (uint32_t big = 0; big < 2; big++) {
        bag b;
        bag_start(&b);
        b.big_endian = big == 1;
        uint16_t image = bag_channel(&b, "/a/image", image_type), depth = bag_channel(&b, "/a/depth", image_type);
        uint16_t info = bag_channel(&b, "/a/info", info_type), pose = bag_channel(&b, "/a/pose", pose_type);
        const bag_image colour = colour_at(-5),
                        z = {-5, 2, 2, 4, "mono16", big == 1, big ? depth_big : depth_little, 8};
        const bag_info intrinsics = info_at(-5);
        bag_put_image(&b, image, &colour);
        bag_put_image(&b, depth, &z);
        bag_put_info(&b, info, &intrinsics);
        bag_put_pose(&b, pose, -5, here, (double[]){0.1, -0.2, 0.3, 0.9});
        bag_finish(&b);
        t3r_recording *recording = parse(&b);
        t3r_capture_frame frame = frame_of(recording, 0);
        assert_int_equal(frame.stamp_ns, -5);
        assert_memory_equal(frame.frame.planes[0], pixels, sizeof pixels);
        assert_memory_equal(frame.frame.depth, depth_little, sizeof depth_little);
        assert_int_equal(frame.frame.depth_unit_q40, 1099511628);
        assert_int_equal(frame.camera.fx_q16, 20 * 65536 + 32768);
        assert_int_equal(frame.camera.cy_q16, 65536 + 32768);
        assert_int_equal(frame.camera.distortion, T3R_DISTORTION_RADTAN);
        assert_int_equal(frame.camera.distortion_q24[1], -(1 << 22));
        assert_int_equal(frame.camera.distortion_q24[4], 1 << 21);
        assert_int_equal(frame.camera.position_q32[1], -(INT64_C(2) << 32));
        assert_int_equal(frame.camera.rotation_q30[0], 966367642); /* 0.9 */
        assert_int_equal(frame.camera.rotation_q30[2], -214748365);
        t3r_recording_close(recording);
        bag_free(&b);
    }
}

TEST(metres_become_steps)
{
    static const float metres[12] = {0.0f,    1.0f,    NAN,     INFINITY, -1.0f,  0.0005f,
                                     0.0015f, 65.535f, 65.536f, 2.0004f,  1e-20f, 0.0004f};
    /* 0.0005f lies above half a step, 0.0015f above one and a half. */
    static const uint16_t steps[12] = {0, 1000, 0, 0, 0, 1, 2, 65535, 0, 2000, 0, 0};
    for (uint32_t big = 0; big < 2; big++) {
        uint8_t data[12 * 4];
        for (uint32_t i = 0; i < 12; i++) {
            uint32_t bits;
            memcpy(&bits, &metres[i], sizeof bits);
            for (uint32_t j = 0; j < 4; j++) {
                data[4 * i + j] = (uint8_t)(bits >> 8 * (big ? 3 - j : j));
            }
        }
        bag b;
        bag_start(&b);
        uint16_t image = bag_channel(&b, "/image", image_type), depth = bag_channel(&b, "/other/depth", image_type);
        const bag_image colour = colour_at(1), z = {1, 4, 3, 16, "32FC1", big == 1, data, sizeof data};
        bag_put_image(&b, image, &colour);
        bag_put_image(&b, depth, &z);
        bag_finish(&b);
        t3r_recording *recording = parse(&b);
        for (uint32_t again = 0; again < 2; again++) {
            t3r_capture_frame frame = frame_of(recording, 0);
            assert_int_equal(frame.frame.depth_stride_bytes, 8);
            for (uint32_t i = 0; i < 12; i++) {
                assert_int_equal(frame.frame.depth[2 * i] | frame.frame.depth[2 * i + 1] << 8, steps[i]);
            }
        }
        t3r_recording_close(recording);
        bag_free(&b);
    }
}

TEST(pairs_by_stamp_then_by_nearness)
{
    bag b;
    bag_start(&b);
    uint16_t pose = bag_channel(&b, "/tracker/pose", transform_type); /* the only one: it need not share the prefix */
    uint16_t image = bag_channel(&b, "/cam/rgb/image_raw", image_type);
    uint16_t depth = bag_channel(&b, "/cam/depth/image_raw", image_type);
    uint16_t info = bag_channel(&b, "/cam/rgb/camera_info", info_type);
    uint16_t other_info = bag_channel(&b, "/cam/depth/camera_info", info_type);
    uint16_t second = bag_channel(&b, "/zed/image", image_type);
    static const uint8_t z16[6][8] = {{1}, {2}, {3}, {4}, {5}, {6}};
    /* Unordered stamps. */
    static const int64_t depths[6] = {300 * MS, 100 * MS, 93 * MS, 221 * MS, 180 * MS, 420 * MS + 1};
    for (uint32_t i = 0; i < 6; i++) {
        const bag_image z = {depths[i], 2, 2, 4, "16UC1", false, z16[i], 8};
        bag_put_image(&b, depth, &z);
    }
    bag_info intrinsics = info_at(150 * MS), unused = info_at(100 * MS), uncalibrated = info_at(190 * MS);
    uncalibrated.k[0] = 0;
    bag_put_info(&b, info, &intrinsics);
    bag_put_info(&b, info, &uncalibrated);
    intrinsics.stamp_ns = 250 * MS;
    intrinsics.k[0] = 30;
    bag_put_info(&b, info, &intrinsics);
    bag_put_info(&b, other_info, &unused);
    bag_put_transform(&b, pose, 110 * MS, here, upright);
    bag_put_transform(&b, pose, 290 * MS, upright, upright);
    static const int64_t colours[4] = {100 * MS, 200 * MS, 309 * MS, 400 * MS};
    for (uint32_t i = 0; i < 4; i++) {
        const bag_image colour = colour_at(colours[i]);
        bag_put_image(&b, image, &colour);
        bag_put_image(&b, second, &colour);
    }
    bag_finish(&b);
    t3r_recording *recording = parse(&b);
    assert_int_equal(t3r_recording_frame_count(recording), 4);
    t3r_capture_frame frame = frame_of(recording, 0);
    assert_int_equal(frame.frame.depth[0], 2);                        /* the same stamp */
    assert_int_equal(frame.camera.fx_q16, 20 * 65536 + 32768);        /* none before: the first after */
    assert_int_equal(frame.camera.position_q32[0], INT64_C(3) << 31); /* 10 ms apart */
    frame = frame_of(recording, 1);
    assert_int_equal(frame.frame.depth[0], 5); /* exactly 20 ms before */
    assert_int_equal(frame.camera.fx_q16, 20 * 65536 + 32768);
    assert_false(frame.has_pose);
    frame = frame_of(recording, 2);
    assert_int_equal(frame.frame.depth[0], 1);
    assert_int_equal(frame.camera.fx_q16, 30 * 65536);
    assert_true(frame.has_pose);
    frame = frame_of(recording, 3);
    assert_null(frame.frame.depth); /* a nanosecond too far */
    t3r_pairing_info pairing = t3r_recording_pairing(recording);
    assert_int_equal(pairing.with_depth, 3);
    assert_int_equal(pairing.with_pose, 2);
    assert_int_equal(pairing.with_intrinsics, 4);
    assert_int_equal(pairing.worst_depth_gap_ns, 20 * MS);
    assert_int_equal(pairing.worst_pose_gap_ns, 19 * MS);
    assert_string_equal(t3r_recording_clock(recording), "unknown");
    assert_int_equal(t3r_recording_bits_epoch(recording), 0);
    assert_int_equal(t3r_recording_stream(recording, 4).use, T3R_USE_DEPTH_CAMERA_INFO); /* read by import only */
    assert_non_null(strstr(t3r_recording_note(recording), "/zed/image is not used"));
    t3r_recording_close(recording);
    bag_free(&b);
}

/* Opens a recording of two images; the second one's intrinsics are `info`. */
static t3r_recording *with_info(bag *b, bag_info info)
{
    bag_start(b);
    uint16_t image = bag_channel(b, "/c/image", image_type), channel = bag_channel(b, "/c/camera_info", info_type);
    const bag_image first = colour_at(10 * MS), second = colour_at(20 * MS);
    const bag_info good = info_at(10 * MS);
    info.stamp_ns = 20 * MS;
    bag_put_image(b, image, &first);
    bag_put_info(b, channel, &good);
    bag_put_image(b, image, &second);
    bag_put_info(b, channel, &info);
    bag_finish(b);
    return parse(b);
}

TEST(bad_intrinsics_name_field_and_frame)
{
    bag_info bad[16];
    static const char *const reasons[16] = {"K[0] (fx) is not a number in [8, 16384)",
                                            "K[0] (fx)",
                                            "K[4] (fy)",
                                            "K[2] (cx)",
                                            "K[5] (cy)",
                                            "K has a skew",
                                            "D has a coefficient",
                                            "D has a coefficient",
                                            "D has terms beyond",
                                            "D has terms beyond",
                                            "4 coefficients of equidistant",
                                            "distortion_model",
                                            "width x height is 8x4, that of the image 4x4",
                                            "binning",
                                            "K[0] (fx)",
                                            "K has a skew"};
    for (uint32_t i = 0; i < 16; i++) {
        bad[i] = info_at(0);
    }
    bad[0].k[0] = NAN;
    bad[1].k[0] = 16384;
    bad[2].k[4] = 7.99;
    bad[3].k[2] = -16384;
    bad[4].k[5] = -INFINITY;
    bad[5].k[1] = 0.5;
    bad[6].d[2] = NAN;
    bad[7].d[0] = 128;
    bad[8].model = "rational_polynomial";
    bad[8].d_count = 8;
    bad[8].d[6] = 1e-9;
    bad[9].d_count = 6;
    bad[9].d[5] = 1;
    bad[10].model = "equidistant";
    bad[11].model = "omnidirectional";
    bad[12].width = 8;
    bad[13].binning = 2;
    bad[14].k[0] = 1e300;
    bad[15].k[7] = -1;
    for (uint32_t i = 0; i < 16; i++) {
        bag b;
        t3r_recording *recording = with_info(&b, bad[i]);
        frame_of(recording, 0);
        refuse_frame(recording, 1, reasons[i], "frame 1, /c/camera_info at byte ");
        t3r_recording_close(recording);
        bag_free(&b);
    }
}

TEST(distortion_models_are_told_apart)
{
    bag_info infos[6];
    static const t3r_distortion expected[6] = {T3R_DISTORTION_NONE,    T3R_DISTORTION_NONE,   T3R_DISTORTION_RADTAN,
                                               T3R_DISTORTION_FISHEYE, T3R_DISTORTION_RADTAN, T3R_DISTORTION_NONE};
    for (uint32_t i = 0; i < 6; i++) {
        infos[i] = info_at(0);
    }
    infos[0].d_count = 0;
    memset(infos[1].d, 0, sizeof infos[1].d);
    infos[2].model = "rational_polynomial";
    infos[2].d_count = 8;
    infos[3].model = "equidistant";
    infos[3].d_count = 4;
    infos[4].d_count = 4;
    infos[5].model = "";
    infos[5].d_count = 0;
    for (uint32_t i = 0; i < 6; i++) {
        bag b;
        t3r_recording *recording = with_info(&b, infos[i]);
        t3r_capture_frame frame = frame_of(recording, 1);
        assert_int_equal(frame.camera.distortion, expected[i]);
        assert_int_equal(frame.camera.distortion_q24[0], expected[i] == T3R_DISTORTION_NONE ? 0 : 1 << 23);
        t3r_recording_close(recording);
        bag_free(&b);
    }
}

TEST(bad_images_and_poses_name_field_and_frame)
{
    enum { IMAGES = 9, POSES = 1 };
    bag b;
    bag_start(&b);
    uint16_t image = bag_channel(&b, "/c/image", image_type), depth = bag_channel(&b, "/c/depth", image_type);
    uint16_t pose = bag_channel(&b, "/c/pose", pose_type);
    static const char *const reasons[IMAGES + POSES] = {NULL,
                                                        "step is less",
                                                        "fewer than step x rows",
                                                        "width or height is outside",
                                                        "encoding is none of",
                                                        "odd",
                                                        "fewer than step x rows",
                                                        "width or height is outside 2..4096",
                                                        "step is less",
                                                        "position.x is not a number"};
    static const double positions[POSES][3] = {{1.5e9, 0, 0}};
    static const double rotations[POSES][4] = {{0, 0, 0, 1}};
    for (uint32_t i = 0; i < IMAGES + POSES; i++) {
        bag_image colour = colour_at((int64_t)(i + 1) * 100 * MS),
                  z = {colour.stamp_ns, 2, 2, 4, "16UC1", false, pixels, 8};
        if (i == 1) {
            colour.step = 11;
        } else if (i == 2) {
            colour.data_bytes = 47;
        } else if (i == 3) {
            colour.width = 0;
        } else if (i == 4) {
            colour.encoding = "bayer_rggb8";
        } else if (i == 5) {
            colour.encoding = "nv12";
            colour.width = 3;
        } else if (i == 6) {
            z.step = 6;
        } else if (i == 7) {
            z.height = 5000;
        } else if (i == 8) {
            z.encoding = "32FC1";
        }
        bag_put_image(&b, image, &colour);
        bag_put_image(&b, depth, &z);
        if (i >= IMAGES) {
            bag_put_pose(&b, pose, colour.stamp_ns, positions[i - IMAGES], rotations[i - IMAGES]);
        }
    }
    bag_finish(&b);
    t3r_recording *recording = parse(&b);
    frame_of(recording, 0);
    for (uint32_t i = 1; i < IMAGES + POSES; i++) {
        char where[32];
        const char *topic = i < 6 ? "image" : i < IMAGES ? "depth" : "pose";
        snprintf(where, sizeof where, "frame %u, /c/%s at byte ", i, topic);
        refuse_frame(recording, i, reasons[i], where);
    }
    t3r_recording_close(recording);
    bag_free(&b);
}

/* The runtime takes norms of 0.5 to 1.5 as they are; others are scaled by a power of two into that range. */
TEST(rotations_of_any_length_are_read)
{
    static const struct {
        double length, stored;
    } cases[] = {{1, 1},     {0.51, 0.51},          {1.49, 1.49},        {1.6, 0.8},
                 {0.4, 0.8}, {0x1.1p-18, 0x1.1p-1}, {0x1.7p17, 0x1.7p0}, {3e-6, 0}};
    enum { COUNT = sizeof cases / sizeof cases[0] };
    bag b;
    bag_start(&b);
    uint16_t image = bag_channel(&b, "/c/image", image_type), pose = bag_channel(&b, "/c/pose", pose_type);
    for (uint32_t i = 0; i < COUNT; i++) {
        bag_image colour = colour_at((int64_t)(i + 1) * 100 * MS);
        const double length = cases[i].length, rotation[4] = {0, -0.6 * length, 0, 0.8 * length};
        bag_put_image(&b, image, &colour);
        bag_put_pose(&b, pose, colour.stamp_ns, (const double[3]){1, 2, 3}, rotation);
    }
    bag_finish(&b);
    t3r_recording *recording = parse(&b);
    for (uint32_t i = 0; i < COUNT; i++) {
        const t3r_capture_frame frame = frame_of(recording, i);
        const double w = frame.camera.rotation_q30[0] * 0x1p-30, y = frame.camera.rotation_q30[2] * 0x1p-30;
        const double length = hypot(w, y);
        assert_true(frame.has_pose && length >= 0.5 - 1e-8 && length <= 1.5 + 1e-8);
        assert_true(fabs(w / length - 0.8) < 1e-8 && fabs(y / length + 0.6) < 1e-8);
        assert_true(cases[i].stored <= 0 || fabs(length - cases[i].stored) < 1e-8);
    }
    t3r_recording_close(recording);
    bag_free(&b);
}

TEST(malformed_messages_are_left_out)
{
    static const struct {
        const char *type;
        const char *bytes;
        size_t count;
        const char *reason;
    } messages[] = {
        {image_type, "", 0, "not plain CDR"},
        {image_type, "\0\7\0\0", 4, "not plain CDR"},
        {image_type, "\0\1\0\0\1\0\0\0\1\0\0", 11, "header is malformed"},
        {image_type, "\0\1\0\0\0\0\0\0\0\312\232\073\1\0\0\0\0", 17, "nanosec"},
        {image_type, "\0\1\0\0\0\0\0\0\0\0\0\0\2\0\0\0ab", 18, "header is malformed"}, /* no zero after the text */
        {image_type, "\0\1\0\0\0\0\0\0\0\0\0\0\377\377\377\377\0", 17, "header is malformed"},
        {image_type, "\0\1\0\0\0\0\0\0\0\0\0\0\0\0\0\0\2\0\0\0\2\0\0\0\0\0\0\0\0\0\0\0\2\0\0\0\377\377\377\377\0", 41,
         "data is cut short"},
        {info_type, "\0\1\0\0\0\0\0\0\0\0\0\0\0\0\0\0\2\0\0\0\2\0\0\0\0\0\0\0\21\0\0\0\0\0\0\0", 36, "more than 16"},
        {info_type, "\0\1\0\0\0\0\0\0\0\0\0\0\0\0\0\0\2\0\0\0\2\0\0\0\0\0\0\0\0\0\0\0", 32, "cut short"},
        {pose_type, "\0\1\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 20, "position or orientation is cut short"},
        {transform_type, "\0\1\0\0\0\0\0\0\0\0\0\0\0\0\0\0\1\0\0\0x", 21, "child_frame_id"},
    };
    for (size_t i = 0; i < sizeof messages / sizeof messages[0]; i++) {
        bag b;
        bag_start(&b);
        uint16_t channel = bag_channel(&b, "/x/y", messages[i].type);
        bag_message(&b, channel, 1, messages[i].bytes, messages[i].count);
        bag_finish(&b);
        t3r_recording *recording = parse(&b);
        const t3r_stream_info stream = t3r_recording_stream(recording, 0);
        assert_int_equal(stream.left_out, 1);
        assert_non_null(strstr(stream.fault, messages[i].reason));
        assert_non_null(
            strstr(t3r_recording_note(recording), "/x/y: 1 of its messages are left out, the first at byte "));
        t3r_recording_close(recording);
        bag_free(&b);
    }
}

TEST(wrong_records_are_refused)
{
    static const struct {
        uint8_t opcode;
        const char *bytes;
        size_t count;
        const char *reason;
    } records[] = {
        {T3R_MCAP_MESSAGE, "\1\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 22, "channel was not defined"},
        {T3R_MCAP_MESSAGE, "\1\0", 2, "a field reaches past"},
        {T3R_MCAP_CHANNEL, "\1\0\5\0\0\0\0\0\0\0\0\0\0\0\0\0", 16, "schema was not defined"},
        {T3R_MCAP_CHANNEL, "\1\0\0\0\377\377\377\377", 8, "a field reaches past"},
        {T3R_MCAP_SCHEMA, "\1\0\1\0\0\0", 6, "a field reaches past"},
        {T3R_MCAP_SCHEMA, "\50\0\1\0\0\0x\0\0\0\0\0\0\0\0", 15, "id is taken by another schema"},
        {T3R_MCAP_CHANNEL, "\50\0\50\0\1\0\0\0x\0\0\0\0\0\0\0\0", 17, "id is taken by another channel"},
        {T3R_MCAP_METADATA, "\0\0\0\0\5\0\0\0\1\0\0\0k", 13, "a field reaches past"},
        {T3R_MCAP_ATTACHMENT, "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\2\0\0\0\0\0\0\0hi\1\2\3\4", 38,
         "CRC does not match"},
        {T3R_MCAP_ATTACHMENT, "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\377\0\0\0\0\0\0\0", 32,
         "a field reaches past"},
        {T3R_MCAP_HEADER, "\0\0\0\0\0\0\0\0", 8, "not the first record"},
        {T3R_MCAP_FOOTER, "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 20, "no DataEnd record"},
        {0, "", 0, "no opcode"},
        {T3R_MCAP_CHUNK, "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\3\0\0\0bz2\0\0\0\0\0\0\0\0", 43,
         "compression 'bz2' is not supported"},
    };
    for (size_t i = 0; i < sizeof records / sizeof records[0]; i++) {
        bag b;
        bag_start(&b);
        bag_channel(&b, "/x/y", "foreign/msg/Type");
        t3r_mcap_record(&b.out, records[i].opcode, records[i].count);
        t3r_mcap_put_raw(&b.out, records[i].bytes, records[i].count);
        bag_finish(&b);
        refuse_file(&b, records[i].reason, " at byte ");
        bag_free(&b);
    }
}

TEST(unknown_records_and_topics_are_passed_over)
{
    bag b;
    bag_start(&b);
    t3r_mcap_record(&b.out, 0x90, 3);
    t3r_mcap_put_raw(&b.out, "abc", 3);
    uint16_t channel = bag_channel(&b, "/x/\n\xff", "foreign/msg/Type");
    bag_message(&b, channel, 5, "??", 2);
    uint16_t bayer = bag_channel(&b, "/raw/image", "sensor_msgs/Image");
    bag_image raw = colour_at(1);
    raw.encoding = "bayer_rggb16";
    bag_put_image(&b, bayer, &raw);
    bag_metadata(&b, "other", "triplets", "x");
    bag_finish(&b);
    t3r_recording *recording = parse(&b);
    assert_int_equal(t3r_recording_frame_count(recording), 0);
    assert_int_equal(t3r_recording_stream_count(recording), 2);
    t3r_stream_info stream = t3r_recording_stream(recording, 0);
    assert_string_equal(stream.topic, "/x/??");
    assert_int_equal(stream.messages, 1);
    assert_int_equal(stream.first_ns, 5);
    assert_non_null(strstr(t3r_recording_note(recording), "encoding 'bayer_rggb16' is not supported"));
    assert_non_null(strstr(t3r_recording_note(recording), "no colour images"));
    t3r_recording_close(recording);
    bag_free(&b);
}

TEST(metadata_are_checked)
{
    static const char *const bad[][4] = {
        {"trim3r", "depth_unit", "0", "depth_unit"},           {"trim3r", "depth_unit", "1e-3", "depth_unit"},
        {"trim3r", "depth_unit", "-1", "depth_unit"},          {"trim3r", "depth_unit", "65536", "depth_unit"},
        {"trim3r", "bits_epoch", "0", "bits_epoch"},           {"trim3r", "bits_epoch", "4294967296", "bits_epoch"},
        {"trim3r", "bits_epoch", "1x", "bits_epoch"},          {"trim3r_triplets", "triplets", "0,1", "triplets"},
        {"trim3r_triplets", "triplets", "0,1,2;", "triplets"}, {"trim3r_triplets", "triplets", "0,1,2,3", "triplets"},
        {"trim3r_triplets", "triplets", "0,,2", "triplets"},   {"trim3r_triplets", "triplets", "a,b,c", "triplets"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        bag b;
        bag_start(&b);
        bag_metadata(&b, bad[i][0], bad[i][1], bad[i][2]);
        bag_finish(&b);
        refuse_file(&b, bad[i][3], "metadata at byte ");
        bag_free(&b);
    }
    bag b;
    bag_start(&b);
    uint16_t image = bag_channel(&b, "/c/image", image_type);
    bag_metadata(&b, "trim3r_triplets", "triplets", "0,1,2;0,1,1;1,2,0");
    const bag_image first = colour_at(1), second = colour_at(2);
    bag_put_image(&b, image, &first);
    bag_put_image(&b, image, &second);
    bag_finish(&b);
    t3r_recording *recording = parse(&b);
    assert_int_equal(t3r_recording_triplet_count(recording), 1);
    assert_int_equal(t3r_recording_triplet(recording, 0).target, 1);
    assert_non_null(strstr(t3r_recording_note(recording), "2 of its 3 triplets name frames"));
    t3r_recording_close(recording);
    bag_free(&b);
}

/* ---- chunks ---- */

typedef struct chunk {
    const char *compression;
    bag_bytes records, packed;
    uint64_t uncompressed;
    uint32_t crc;
} chunk;

/* Makes a chunk of schema, channel and `frames` images, packed. */
static chunk make_chunk(const char *compression, uint32_t frames)
{
    bag b;
    bag_start(&b);
    size_t head = b.bytes.count;
    uint16_t image = bag_channel(&b, "/c/image", image_type);
    for (uint32_t i = 0; i < frames; i++) {
        const bag_image colour = colour_at((int64_t)i + 1);
        bag_put_image(&b, image, &colour);
    }
    chunk c = {.compression = compression, .uncompressed = b.bytes.count - head};
    bag_bytes_start(&c.records);
    bag_bytes_start(&c.packed);
    bag_append(&c.records, b.bytes.data + head, b.bytes.count - head);
    bag_free(&b);
    c.crc = t3r_crc32(0, c.records.data, c.records.count);
    size_t room = LZ4F_compressFrameBound(c.records.count, NULL) + ZSTD_compressBound(c.records.count);
    uint8_t *out = malloc(room);
    size_t count = 0;
    if (strcmp(compression, "lz4") == 0) {
        count = LZ4F_compressFrame(out, room, c.records.data, c.records.count, NULL);
    } else if (strcmp(compression, "zstd") == 0) {
        count = ZSTD_compress(out, room, c.records.data, c.records.count, 3);
    } else {
        count = c.records.count;
        memcpy(out, c.records.data, count);
    }
    bag_append(&c.packed, out, count);
    free(out);
    return c;
}

static void put_chunk(bag *b, const chunk *c)
{
    t3r_mcap_record(&b->out, T3R_MCAP_CHUNK, 8 + 8 + 8 + 4 + 4 + strlen(c->compression) + 8 + c->packed.count);
    t3r_mcap_put_u64(&b->out, 1);
    t3r_mcap_put_u64(&b->out, 2);
    t3r_mcap_put_u64(&b->out, c->uncompressed);
    t3r_mcap_put_u32(&b->out, c->crc);
    t3r_mcap_put_text(&b->out, t3r_text_of(c->compression));
    t3r_mcap_put_u64(&b->out, c->packed.count);
    t3r_mcap_put_raw(&b->out, c->packed.data, c->packed.count);
}

static void chunk_free(chunk *c)
{
    bag_bytes_free(&c->records);
    bag_bytes_free(&c->packed);
}

static const char *const compressions[3] = {"", "lz4", "zstd"};

TEST(chunks_are_read)
{
    for (uint32_t i = 0; i < 3; i++) {
        chunk c = make_chunk(compressions[i], 3), repeated = make_chunk(compressions[i], 2);
        bag b;
        bag_start(&b);
        put_chunk(&b, &c);
        put_chunk(&b, &repeated);
        bag_finish(&b);
        t3r_recording *recording = parse(&b);
        assert_string_equal(t3r_recording_note(recording), "");
        assert_int_equal(t3r_recording_frame_count(recording), 5);
        t3r_capture_frame frame = frame_of(recording, 4);
        assert_memory_equal(frame.frame.planes[0], pixels, sizeof pixels);
        t3r_recording_close(recording);
        bag_free(&b);
        chunk_free(&c);
        chunk_free(&repeated);
    }
}

TEST(broken_chunks_are_refused)
{
    for (uint32_t i = 0; i < 3; i++) {
        for (uint32_t way = 0; way < 6; way++) {
            chunk c = make_chunk(compressions[i], 3);
            const char *reason = "Chunk record at byte ";
            if (way == 0) {
                c.crc ^= 1;
                reason = "CRC does not match its records";
            } else if (way == 1) {
                c.uncompressed++;
            } else if (way == 2) {
                c.uncompressed--;
            } else if (way == 3) {
                c.packed.count--;
            } else if (way == 4) {
                c.uncompressed = UINT64_MAX - 7;
                reason = i > 0 ? "may unpack to 134" : reason; /* 128 MiB and a little more */
            } else {
                c.uncompressed = 127u << 20;
                reason = i > 0 ? "more than its data can hold" : reason;
            }
            bag b;
            bag_start(&b);
            put_chunk(&b, &c);
            bag_finish(&b);
            refuse_file(&b, reason, "byte");
            bag_free(&b);
            chunk_free(&c);
        }
    }
    chunk c = make_chunk("", 1); /* a record that reaches past its chunk's end */
    c.records.data[1] = 0xff;
    c.packed.data[1] = 0xff;
    c.crc = t3r_crc32(0, c.records.data, c.records.count);
    c.packed.data[2] = 0xff;
    c.crc = 0;
    bag b;
    bag_start(&b);
    put_chunk(&b, &c);
    bag_finish(&b);
    refuse_file(&b, "reaches past the chunk's end", "byte 0 of the chunk at byte ");
    bag_free(&b);
    chunk_free(&c);
}

TEST(a_cut_chunk_reads_to_its_last_whole_message)
{
    for (uint32_t i = 0; i < 3; i++) {
        chunk c = make_chunk(compressions[i], 3);
        bag b;
        bag_start(&b);
        put_chunk(&b, &c);
        uint32_t most = 0;
        for (size_t count = 8; count < b.bytes.count; count++) {
            uint8_t *cut = malloc(count);
            memcpy(cut, b.bytes.data, count);
            char error[256] = "";
            t3r_recording *recording = t3r_recording_parse(cut, count, error, sizeof error);
            if (recording == NULL) {
                fail_msg("cut at %zu: %s", count, error);
            }
            uint32_t frames = t3r_recording_frame_count(recording);
            assert_true(frames >= most);
            assert_non_null(strstr(t3r_recording_note(recording), "cut off"));
            for (uint32_t f = 0; f < frames; f++) {
                t3r_capture_frame frame = frame_of(recording, f);
                assert_memory_equal(frame.frame.planes[0], pixels, sizeof pixels);
            }
            most = frames;
            t3r_recording_close(recording);
            free(cut);
        }
        assert_true(most >= (i == 0 ? 2 : 0));
        bag_free(&b);
        chunk_free(&c);
    }
}

static int fill(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < sizeof pixels; i++) {
        pixels[i] = (uint8_t)(i * 37 + 11);
    }
    return 0;
}

ALL_TESTS_WITH(fill, NULL)
