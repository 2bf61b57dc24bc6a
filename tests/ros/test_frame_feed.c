/* SPDX-License-Identifier: Apache-2.0 */
/* Messages of a camera, in any order and with any content, become frames: pairs by time, bounded queues, reasons. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pictures/png_bytes.h"
#include "ros/frame_feed.h"
#include "test.h"

enum { SIDE = 16 };
#define MS INT64_C(1000000)

static uint8_t colour[SIDE][SIDE][3];
static uint8_t depth[SIDE][SIDE][2];
static float metres[SIDE][SIDE];

typedef struct heard {
    frame_feed *feed;
    uint32_t frames, warnings, held; /* held: messages that are not released yet */
    int64_t stamp_ns;
    char reason[FRAME_FEED_REASON_BYTES], world[FRAME_FEED_NAME_BYTES];
    frame_feed_topic topic;
    uint8_t first[3], first_depth[2];
    t3r_camera camera;
    frame_feed_found found; /* what locate() answers */
} heard;

static void hear_frame(void *user, int64_t stamp_ns, const char *world, const t3r_frame *frame,
                       const t3r_camera *camera, int64_t now_ns)
{
    (void)now_ns;
    heard *h = user;
    assert_true(stamp_ns > h->stamp_ns || h->frames == 0);
    assert_int_equal(frame->width, SIDE);
    assert_int_equal(frame->depth_width, SIDE);
    h->frames++;
    h->stamp_ns = stamp_ns;
    h->camera = *camera;
    strcpy(h->world, world);
    memcpy(h->first, frame->planes[0], sizeof h->first);
    memcpy(h->first_depth, frame->depth, sizeof h->first_depth);
}

static void hear_warning(void *user, frame_feed_topic topic, const char *reason)
{
    heard *h = user;
    h->warnings++;
    h->topic = topic;
    strcpy(h->reason, reason);
}

static void hear_release(void *user, void *owner)
{
    heard *h = user;
    assert_ptr_equal(owner, h);
    assert_true(h->held > 0);
    h->held--;
}

static frame_feed_found answer(void *user, int64_t stamp_ns, const char *camera, t3r_ros_pose *pose)
{
    heard *h = user;
    assert_string_equal(camera, "lens");
    assert_true(stamp_ns > 0);
    const double one = 1;
    *pose = (t3r_ros_pose){0};
    memcpy(&pose->rotation_f64[3], &one, sizeof one);
    return h->found;
}

static void begin(heard *h, bool locate, uint32_t queue)
{
    frame_feed_settings s = frame_feed_defaults();
    char error[128];
    *h = (heard){0};
    s.user = h;
    s.frame = hear_frame;
    s.warn = hear_warning;
    s.release = hear_release;
    s.locate = locate ? answer : NULL;
    s.world = locate ? "map" : "";
    s.queue = queue;
    h->feed = frame_feed_open(&s, error, sizeof error);
    assert_non_null(h->feed);
    for (int i = 0; i < SIDE * SIDE; i++) {
        memset(colour[i / SIDE][i % SIDE], 77, 3);
        depth[i / SIDE][i % SIDE][0] = 0xd0; /* 2000 */
        depth[i / SIDE][i % SIDE][1] = 0x07;
        metres[i / SIDE][i % SIDE] = 2;
    }
}

static void finish(heard *h)
{
    frame_feed_close(h->feed);
    assert_int_equal(h->held, 0);
}

/* Returns the colour or depth image of that time in milliseconds. */
static t3r_ros_image image_of(frame_feed_topic topic, int64_t ms)
{
    const bool is_colour = topic == FRAME_FEED_COLOUR;
    return (t3r_ros_image){.header = {ms * MS, {"lens", 4}},
                           .height = SIDE,
                           .width = SIDE,
                           .encoding = {is_colour ? "rgb8" : "16UC1", is_colour ? 4 : 5},
                           .step = SIDE * (is_colour ? 3 : 2),
                           .data = is_colour ? &colour[0][0][0] : &depth[0][0][0],
                           .data_bytes = SIDE * SIDE * (is_colour ? 3 : 2)};
}

static void send(heard *h, frame_feed_topic topic, int64_t ms, int64_t now_ms)
{
    const t3r_ros_image image = image_of(topic, ms);
    h->held++;
    frame_feed_image(h->feed, topic, &image, h, now_ms * MS);
}

static t3r_ros_camera_info good_info(void)
{
    t3r_ros_camera_info info = {.height = SIDE, .width = SIDE, .distortion_model = {"plumb_bob", 9}};
    const double k[9] = {SIDE, 0, 7.5, 0, SIDE, 7.5, 0, 0, 1};
    memcpy(info.k_f64, k, sizeof k);
    return info;
}

static void send_info(heard *h)
{
    const t3r_ros_camera_info info = good_info();
    frame_feed_camera_info(h->feed, &info, 0);
}

static void send_pose(heard *h, int64_t ms, double x, const char *child, int64_t now_ms)
{
    t3r_ros_pose pose = {.header = {ms * MS, {"map", 3}}, .child_frame_id = {child, strlen(child)}};
    const double one = 1;
    memcpy(&pose.position_f64[0], &x, sizeof x);
    memcpy(&pose.rotation_f64[3], &one, sizeof one);
    frame_feed_pose(h->feed, &pose, now_ms * MS);
}

TEST(settings_are_checked)
{
    char error[128];
    frame_feed_settings s = frame_feed_defaults();
    s.queue = 1;
    assert_null(frame_feed_open(&s, error, sizeof error));
    s.queue = 33;
    assert_null(frame_feed_open(&s, error, sizeof error));
    assert_string_equal(error, "queue is outside 2..32");
    s = frame_feed_defaults();
    s.pair_ns = -1;
    assert_null(frame_feed_open(&s, error, sizeof error));
    s = frame_feed_defaults();
    s.depth_unit_q40 = 0;
    assert_null(frame_feed_open(&s, error, sizeof error));
}

/* Returns permutation number 0..23 of the topics. */
static void put_order(int number, int order[FRAME_FEED_TOPICS])
{
    int left[FRAME_FEED_TOPICS] = {0, 1, 2, 3};
    for (int i = 0; i < FRAME_FEED_TOPICS; i++) {
        const int count = FRAME_FEED_TOPICS - i, at = number % count;
        order[i] = left[at];
        left[at] = left[count - 1];
        number /= count;
    }
}

TEST(any_order_makes_a_frame)
{
    for (int number = 0; number < 24; number++) {
        int order[FRAME_FEED_TOPICS];
        heard h;
        put_order(number, order);
        begin(&h, false, 8);
        for (int i = 0; i < FRAME_FEED_TOPICS; i++) {
            assert_int_equal(h.frames, 0);
            switch (order[i]) {
            case FRAME_FEED_CAMERA_INFO:
                send_info(&h);
                break;
            case FRAME_FEED_POSE:
                send_pose(&h, 100, 0.5, "", i);
                break;
            default:
                send(&h, (frame_feed_topic)order[i], 100, i);
                break;
            }
        }
        assert_int_equal(h.frames, 1);
        assert_int_equal(h.held, 0);
        assert_int_equal(h.stamp_ns, 100 * MS);
        assert_string_equal(h.world, "map");
        assert_int_equal(h.camera.position_q32[0], INT64_C(1) << 31);
        assert_int_equal(h.camera.fx_q16, SIDE << 16);
        assert_int_equal(h.first[0], 77);
        assert_int_equal(h.warnings, 0);
        finish(&h);
    }
}

TEST(the_nearest_pose_counts)
{
    heard h;
    begin(&h, false, 8);
    send_info(&h);
    send_pose(&h, 92, 1, "", 0);
    send(&h, FRAME_FEED_DEPTH, 103, 1);
    send(&h, FRAME_FEED_COLOUR, 100, 2);
    assert_int_equal(h.frames, 0); /* a nearer pose may come */
    send_pose(&h, 104, 2, "lens", 3);
    assert_int_equal(h.frames, 1);
    assert_int_equal(h.camera.position_q32[0], INT64_C(2) << 32);
    send(&h, FRAME_FEED_DEPTH, 200, 4);
    send(&h, FRAME_FEED_COLOUR, 200, 5);
    send_pose(&h, 230, 3, "", 6); /* too late: none was near */
    assert_int_equal(h.frames, 1);
    assert_int_equal(h.topic, FRAME_FEED_POSE);
    assert_int_equal(frame_feed_counts_of(h.feed).refused, 1);
    send(&h, FRAME_FEED_DEPTH, 300, 7);
    send(&h, FRAME_FEED_COLOUR, 300, 8);
    send_pose(&h, 300, 3, "base_link", 9);
    assert_int_equal(h.frames, 1);
    assert_string_equal(h.reason, "the pose is of \"base_link\", the image of \"lens\"");
    finish(&h);
}

/* Encodings that are no pixel formats become colours, as in an import, and the message is released at once. */
TEST(other_encodings_are_converted)
{
    static uint8_t bgra[SIDE * SIDE * 4];
    heard h;
    begin(&h, false, 8);
    send_info(&h);
    memset(bgra, 255, sizeof bgra);
    t3r_ros_image image = image_of(FRAME_FEED_COLOUR, 100);
    image.encoding = t3r_text_of("bgra8");
    image.step = SIDE * 4;
    image.data = bgra;
    image.data_bytes = sizeof bgra;
    h.held++;
    frame_feed_image(h.feed, FRAME_FEED_COLOUR, &image, &h, 0);
    assert_int_equal(h.held, 0);
    send(&h, FRAME_FEED_DEPTH, 100, 1);
    send_pose(&h, 100, 2, "", 2);
    assert_int_equal(h.frames, 1);
    image.header.stamp_ns = 200 * MS;
    image.data_bytes--;
    h.held++;
    frame_feed_image(h.feed, FRAME_FEED_COLOUR, &image, &h, 3 * MS);
    assert_int_equal(h.held, 0);
    assert_int_equal(frame_feed_counts_of(h.feed).refused, 1);
    assert_int_equal(h.topic, FRAME_FEED_COLOUR);
    finish(&h);
}

/* A transparent pixel has no depth, also if the next image arrives before its depth does. */
TEST(transparent_pixels_have_no_depth)
{
    static uint8_t rgba[SIDE * SIDE * 4];
    heard h;
    begin(&h, false, 8);
    send_info(&h);
    memset(rgba, 255, sizeof rgba);
    t3r_ros_image image = image_of(FRAME_FEED_COLOUR, 100);
    image.encoding = t3r_text_of("rgba8");
    image.step = SIDE * 4;
    image.data = rgba;
    image.data_bytes = sizeof rgba;
    for (int turn = 0; turn < 2; turn++) {
        rgba[3] = turn == 0 ? 0 : 255; /* alpha of the first pixel */
        image.header.stamp_ns = (100 + 100 * turn) * MS;
        h.held++;
        frame_feed_image(h.feed, FRAME_FEED_COLOUR, &image, &h, 0);
    }
    for (int turn = 0; turn < 2; turn++) {
        send(&h, FRAME_FEED_DEPTH, 100 + 100 * turn, 1);
        send_pose(&h, 100 + 100 * turn, 2, "", 2);
        assert_int_equal(h.frames, 1 + turn);
        assert_int_equal(h.first_depth[0] | h.first_depth[1] << 8, turn == 0 ? 0 : 2000);
        assert_int_equal(h.first[0], turn == 0 ? 0 : 255);
    }
    send(&h, FRAME_FEED_COLOUR, 300, 3); /* one without alpha */
    send(&h, FRAME_FEED_DEPTH, 300, 3);
    send_pose(&h, 300, 2, "", 3);
    assert_int_equal(h.frames, 3);
    assert_int_equal(h.first_depth[0] | h.first_depth[1] << 8, 2000);
    finish(&h);
}

/* A lens with k4 to k6 is redrawn as a pinhole's; what it does not see is black and has no depth. */
TEST(lenses_that_no_camera_holds_are_straightened)
{
    heard h;
    begin(&h, true, 8);
    h.found = FRAME_FEED_FOUND;
    t3r_ros_camera_info info = good_info();
    const double d[8] = {0.4, 0, 0, 0, 0, 0, 0, 0.01}; /* corners are drawn farther out than the picture reaches */
    info.distortion_model = t3r_text_of("rational_polynomial");
    info.d_count = 8;
    memcpy(info.d_f64, d, sizeof d);
    frame_feed_camera_info(h.feed, &info, 0);
    send(&h, FRAME_FEED_COLOUR, 100, 0);
    send(&h, FRAME_FEED_DEPTH, 100, 0);
    assert_int_equal(h.frames, 1);
    assert_int_equal(h.camera.distortion, T3R_DISTORTION_NONE);
    assert_int_equal(h.camera.fx_q16, SIDE << 16);
    assert_int_equal(h.first[0], 0);
    assert_int_equal(h.first_depth[0] | h.first_depth[1] << 8, 0);
    info.d_f64[0] = info.d_f64[7]; /* 0.01 */
    frame_feed_camera_info(h.feed, &info, 0);
    send(&h, FRAME_FEED_COLOUR, 200, 0);
    send(&h, FRAME_FEED_DEPTH, 200, 0);
    assert_int_equal(h.first[0], 77);
    assert_int_equal(h.first_depth[0] | h.first_depth[1] << 8, 2000);
    const double folds = -900;
    memcpy(&info.d_f64[0], &folds, sizeof folds);
    frame_feed_camera_info(h.feed, &info, 0);
    send(&h, FRAME_FEED_COLOUR, 300, 0);
    send(&h, FRAME_FEED_DEPTH, 300, 0);
    assert_int_equal(h.frames, 2);
    assert_int_equal(h.topic, FRAME_FEED_CAMERA_INFO);
    assert_non_null(strstr(h.reason, "more than half of the picture"));
    finish(&h);
}

/* Images of a rectified topic have the lens of P, without the distortion of the camera. */
TEST(rectified_topics_have_the_lens_of_p)
{
    static const char *const names[] = {"/cam/image_raw", "/cam/image_rect_color", "/cam/image_rect"};
    const double p[12] = {2 * SIDE, 0, 7.5, 0, 0, 2 * SIDE, 7.5, 0, 0, 0, 1, 0}, bent = 0.25;
    for (int i = 0; i < 3; i++) {
        heard h;
        begin(&h, true, 8);
        h.found = FRAME_FEED_FOUND;
        frame_feed_colour_topic(h.feed, names[i]);
        t3r_ros_camera_info info = good_info();
        info.d_count = 5;
        memcpy(&info.d_f64[0], &bent, sizeof bent);
        if (i < 2) {
            memcpy(info.p_f64, p, sizeof p);
        }
        frame_feed_camera_info(h.feed, &info, 0);
        send(&h, FRAME_FEED_COLOUR, 100, 0);
        send(&h, FRAME_FEED_DEPTH, 100, 0);
        assert_int_equal(h.frames, i < 2);
        if (i < 2) {
            assert_int_equal(h.camera.distortion, i == 0 ? T3R_DISTORTION_RADTAN : T3R_DISTORTION_NONE);
            assert_int_equal(h.camera.fx_q16, (i == 0 ? SIDE : 2 * SIDE) << 16);
        } else {
            assert_int_equal(h.topic, FRAME_FEED_CAMERA_INFO);
            assert_string_equal(h.reason, "P is 0, but images of a rectified topic need it");
        }
        finish(&h);
    }
}

TEST(depth_that_does_not_fit)
{
    heard h;
    begin(&h, true, 8);
    h.found = FRAME_FEED_FOUND;
    send_info(&h);
    t3r_ros_image image = image_of(FRAME_FEED_DEPTH, 100);
    image.height = SIDE / 2;
    h.held++;
    frame_feed_image(h.feed, FRAME_FEED_DEPTH, &image, &h, 0);
    send(&h, FRAME_FEED_COLOUR, 100, 0);
    assert_int_equal(h.frames, 0);
    assert_int_equal(h.topic, FRAME_FEED_DEPTH);
    assert_string_equal(h.reason, "depth is 16x8 and colour 16x16: another aspect is not registered to colour");
    image = image_of(FRAME_FEED_DEPTH, 200);
    image.encoding = t3r_text_of("32FC1");
    image.step = SIDE * 4;
    image.data = (const uint8_t *)&metres[0][0];
    image.data_bytes = sizeof metres;
    metres[0][0] = 80;
    metres[1][1] = 70;
    h.held++;
    frame_feed_image(h.feed, FRAME_FEED_DEPTH, &image, &h, 0);
    send(&h, FRAME_FEED_COLOUR, 200, 0);
    assert_int_equal(h.frames, 1);
    assert_int_equal(h.first_depth[0] | h.first_depth[1], 0);
    assert_non_null(strstr(h.reason, "beyond 65535 steps, 2 of an image"));
    finish(&h);
}

TEST(poses_that_are_none_are_left_out)
{
    static const double bad[][2] = {{NAN, 1}, {INFINITY, 1}, {0, 0}, {0, NAN}}; /* position x, rotation w */
    heard h;
    begin(&h, false, 8);
    send_info(&h);
    for (uint32_t i = 0; i < 40; i++) {
        const double *values = bad[i / 10];
        t3r_ros_pose pose = {.header = {(100 + i) * MS, {"map", 3}}};
        memcpy(&pose.position_f64[0], &values[0], sizeof values[0]);
        memcpy(&pose.rotation_f64[3], &values[1], sizeof values[1]);
        frame_feed_pose(h.feed, &pose, i * MS);
    }
    assert_int_equal(frame_feed_counts_of(h.feed).poses_left_out, 40);
    assert_int_equal(h.warnings, 2); /* one for each reason */
    assert_int_equal(h.topic, FRAME_FEED_POSE);
    send(&h, FRAME_FEED_DEPTH, 100, 50);
    send(&h, FRAME_FEED_COLOUR, 100, 51);
    send_pose(&h, 101, 2, "", 52); /* stamps of poses that are left out do not count */
    assert_int_equal(h.frames, 1);
    assert_int_equal(h.camera.position_q32[0], INT64_C(2) << 32);
    t3r_ros_pose longer = {.header = {200 * MS, {"map", 3}}};
    const double two = 2;
    memcpy(&longer.rotation_f64[3], &two, sizeof two);
    send(&h, FRAME_FEED_DEPTH, 200, 60);
    send(&h, FRAME_FEED_COLOUR, 200, 61);
    frame_feed_pose(h.feed, &longer, 62 * MS);
    assert_int_equal(h.frames, 2);
    assert_int_equal(h.camera.rotation_q30[0], 1 << 30);
    longer.child_frame_id = (t3r_text){"lens", 4};
    assert_true(frame_feed_transform(h.feed, &longer, 63 * MS));
    longer.child_frame_id = longer.header.frame_id;
    assert_false(frame_feed_transform(h.feed, &longer, 64 * MS)); /* above itself */
    assert_int_equal(frame_feed_counts_of(h.feed).poses_left_out, 41);
    finish(&h);
}

TEST(patience_ends)
{
    heard h;
    begin(&h, true, 8);
    send_info(&h);
    send(&h, FRAME_FEED_DEPTH, 100, 0);
    send(&h, FRAME_FEED_COLOUR, 100, 0);
    frame_feed_tick(h.feed, 499 * MS);
    assert_int_equal(h.held, 2);
    h.found = FRAME_FEED_FOUND;
    frame_feed_tick(h.feed, 499 * MS);
    assert_int_equal(h.frames, 1);
    h.found = FRAME_FEED_NOT_YET;
    send(&h, FRAME_FEED_DEPTH, 200, 500);
    send(&h, FRAME_FEED_COLOUR, 200, 500);
    frame_feed_tick(h.feed, 1000 * MS);
    assert_int_equal(h.held, 0);
    assert_int_equal(h.topic, FRAME_FEED_POSE);
    send(&h, FRAME_FEED_COLOUR, 300, 1000);
    frame_feed_tick(h.feed, 1500 * MS);
    assert_int_equal(h.held, 0);
    assert_int_equal(h.topic, FRAME_FEED_DEPTH);
    assert_int_equal(frame_feed_counts_of(h.feed).refused, 2);
    finish(&h);
}

TEST(queues_are_bounded)
{
    for (uint32_t queue = 2; queue <= 32; queue += 10) {
        heard h;
        begin(&h, true, queue);
        send_info(&h);
        for (int i = 1; i < 200; i++) { /* never a pose, and time does not advance */
            send(&h, FRAME_FEED_COLOUR, i * 33, 0);
            send(&h, FRAME_FEED_DEPTH, i * 33, 0);
            assert_true(h.held <= 2 * queue + 2);
        }
        h.found = FRAME_FEED_FOUND;
        frame_feed_tick(h.feed, 0);
        assert_true(h.frames > 0 && h.frames <= queue + 1);
        for (int i = 200; i < 300; i++) {
            send(&h, FRAME_FEED_DEPTH, i * 33, 0); /* and none of colour */
        }
        assert_true(h.held <= queue);
        const frame_feed_counts counts = frame_feed_counts_of(h.feed);
        assert_int_equal(counts.images, 199);
        assert_int_equal(counts.frames + counts.refused, 199);
        finish(&h);
    }
}

TEST(time_goes_on)
{
    heard h;
    begin(&h, true, 8);
    h.found = FRAME_FEED_FOUND;
    send_info(&h);
    send(&h, FRAME_FEED_COLOUR, 5000, 0);
    send(&h, FRAME_FEED_COLOUR, 5000, 0); /* twice */
    assert_string_equal(h.reason, "the stamp is not after the previous message's");
    assert_int_equal(h.held, 1);
    send(&h, FRAME_FEED_COLOUR, 1000, 1); /* the clock was set back */
    assert_non_null(strstr(h.reason, "time went back"));
    assert_int_equal(h.held, 1);
    h.stamp_ns = 0;
    send(&h, FRAME_FEED_DEPTH, 1000, 2);
    assert_int_equal(h.frames, 1);
    assert_int_equal(h.warnings, 2);
    finish(&h);
}

TEST(wrong_messages_have_a_reason)
{
    heard h;
    begin(&h, true, 8);
    h.found = FRAME_FEED_FOUND;
    send(&h, FRAME_FEED_COLOUR, 100, 0);
    send(&h, FRAME_FEED_DEPTH, 100, 0);
    frame_feed_tick(h.feed, 499 * MS);
    assert_int_equal(h.warnings, 0); /* the first may be on its way */
    frame_feed_tick(h.feed, 500 * MS);
    assert_int_equal(h.topic, FRAME_FEED_CAMERA_INFO);
    assert_string_equal(h.reason, "there is none yet");
    t3r_ros_camera_info info = good_info();
    info.header.frame_id = (t3r_text){"other", 5};
    frame_feed_camera_info(h.feed, &info, 0);
    send(&h, FRAME_FEED_COLOUR, 200, 0);
    send(&h, FRAME_FEED_DEPTH, 200, 0);
    assert_string_equal(h.reason, "header.frame_id is \"other\", that of the colour image \"lens\"");
    info = good_info();
    info.width++;
    frame_feed_camera_info(h.feed, &info, 0);
    send(&h, FRAME_FEED_COLOUR, 250, 0);
    send(&h, FRAME_FEED_DEPTH, 250, 0);
    assert_string_equal(h.reason, "width x height is 17x16, that of the image 16x16");
    assert_int_equal(h.frames, 0);
    send_info(&h);
    t3r_ros_image image = image_of(FRAME_FEED_DEPTH, 300); /* metres become steps of the unit */
    image.encoding = (t3r_text){"32FC1", 5};
    image.step = SIDE * 4;
    image.data = (const uint8_t *)&metres[0][0];
    image.data_bytes = sizeof metres;
    h.held++;
    frame_feed_image(h.feed, FRAME_FEED_DEPTH, &image, &h, 0);
    send(&h, FRAME_FEED_COLOUR, 300, 0);
    assert_int_equal(h.frames, 1);
    assert_int_equal(h.first_depth[0] | h.first_depth[1] << 8, 2000);
    finish(&h);
}

TEST(lines_are_held_back)
{
    heard h;
    begin(&h, true, 8);
    for (int i = 0; i < 100; i++) { /* three seconds of frames without intrinsics */
        send(&h, FRAME_FEED_DEPTH, 1 + i * 30, i * 30);
        send(&h, FRAME_FEED_COLOUR, 1 + i * 30, i * 30);
    }
    h.found = FRAME_FEED_FOUND;
    frame_feed_tick(h.feed, 4000 * MS);
    const uint32_t before = h.warnings;
    assert_true(before <= 2); /* no pose, no intrinsics */
    frame_feed_warn(h.feed, FRAME_FEED_CAMERA_INFO, "frame 7 is odd", 4001 * MS);
    frame_feed_warn(h.feed, FRAME_FEED_CAMERA_INFO, "frame 18 is odd", 4002 * MS);
    frame_feed_warn(h.feed, FRAME_FEED_CAMERA_INFO, "frame 19 is odd", 9001 * MS);
    assert_int_equal(h.warnings, before + 2);
    assert_non_null(strstr(h.reason, "frame 19 is odd (1 more"));
    finish(&h);
}

TEST(compressed_images_are_decoded)
{
    heard h;
    size_t count;
    begin(&h, true, 8);
    h.found = FRAME_FEED_FOUND;
    send_info(&h);
    uint8_t *png = png_bytes(SIDE, SIDE, 3, &colour[0][0][0], &count);
    assert_non_null(png);
    t3r_ros_compressed image = {.header = {100 * MS, {"lens", 4}},
                                .format = {"rgb8; png compressed rgb8", 25},
                                .data = png,
                                .data_bytes = (uint32_t)count};
    h.held++;
    frame_feed_compressed(h.feed, FRAME_FEED_COLOUR, &image, &h, 0);
    assert_int_equal(h.held, 0); /* its bytes are not needed any more */
    send(&h, FRAME_FEED_DEPTH, 100, 1);
    assert_int_equal(h.frames, 1);
    assert_int_equal(h.first[1], 77);
    for (uint32_t cut = 0; cut < count; cut += 7) {
        image.header.stamp_ns += 30 * MS;
        image.data_bytes = cut;
        h.held++;
        frame_feed_compressed(h.feed, FRAME_FEED_COLOUR, &image, &h, 2);
        assert_int_equal(h.held, 0);
    }
    assert_int_equal(h.frames, 1);
    assert_int_equal(h.topic, FRAME_FEED_COLOUR);
    free(png);
    finish(&h);
}
