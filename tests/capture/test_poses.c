/* SPDX-License-Identifier: Apache-2.0 */
/* Trajectories: parsing, interpolation between poses, and the offset of two clocks estimated from moving pictures. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "capture/clock_offset.h"
#include "import/poses/trajectory.h"
#include "test.h"

static void parsed(const char *text, trajectory *out)
{
    char copy[1024], error[256] = "";
    snprintf(copy, sizeof copy, "%s", text);
    if (trajectory_parse(copy, "t", out, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
}

static void refused(const char *text, const char *words)
{
    char copy[1024], error[256] = "";
    trajectory t;
    snprintf(copy, sizeof copy, "%s", text);
    assert_int_equal(trajectory_parse(copy, "t", &t, error, sizeof error), -1);
    if (strstr(error, words) == NULL) {
        fail_msg("'%s' does not say '%s'", error, words);
    }
}

TEST(lines_are_read_to_the_nanosecond)
{
    trajectory t;
    parsed("# comment\n1305031102.175304001 1 2 3 0 0 0 1\n\n1305031102.1 -1 -2 -3 0.5 0.5 0.5 0.5 \r\n", &t);
    assert_string_equal(t.kind, "TUM");
    assert_int_equal(t.count, 2);
    assert_int_equal(t.poses[0].stamp_ns, 1305031102100000000); /* by stamp */
    assert_int_equal(t.poses[1].stamp_ns, 1305031102175304001);
    assert_true(t.poses[1].pose.position[2] >= 3 && t.poses[1].pose.rotation[0] >= 1);
    trajectory_free(&t);
    parsed("#timestamp, p_RS_R_x [m], ...\n1403636579763555584,1,2,3,1,0,0,0,0.1,0.2\n", &t);
    assert_string_equal(t.kind, "EuRoC");
    assert_int_equal(t.poses[0].stamp_ns, 1403636579763555584);
    assert_true(t.poses[0].pose.rotation[0] >= 1 && t.poses[0].pose.rotation[1] <= 0); /* w comes first there */
    trajectory_free(&t);
    /* of two poses at one time the first is kept */
    parsed("1 1 0 0 0 0 0 1\n1 2 0 0 0 0 0 1\n", &t);
    assert_int_equal(t.count, 1);
    trajectory_free(&t);

    refused("", "holds no pose");
    refused("x 1 2 3 0 0 0 1\n", "line 1: no time in seconds");
    refused("1 1 2 3 0 0 0\n", "line 1: not 'seconds tx");
    refused("1 1 2 3 0 0 0 1 9\n", "more than eight");
    refused("1 1 2 3 0 0 0 0\n", "without direction");
    refused("1 1 2 nan 0 0 0 1\n", "not finite");
    refused("1 1 2 4e9 0 0 0 1\n", "2^30");
    parsed("1 1 2 3 0 0 0 1\n2 1 2 3 0 0 0\n3 1 2 3 0 2 0 0\n", &t);
    assert_int_equal(t.count, 2);
    assert_int_equal(t.losses.count, 1);
    assert_true(t.poses[1].pose.rotation[2] >= 1 && t.poses[1].pose.rotation[2] <= 1); /* normalised */
    trajectory_free(&t);
    refused("99999999999 1 2 3 0 0 0 1\n", "no time");
    parsed("4000000000000000000,1,2,3,1,0,0,0\n", &t);
    assert_int_equal(t.poses[0].stamp_ns, INT64_C(4000000000000000000));
    trajectory_free(&t);
    refused("4000000000000000001,1,2,3,1,0,0,0\n", "nanoseconds");
    refused("18446744073709551617,1,2,3,1,0,0,0\n", "nanoseconds"); /* would be 1 if its overflow went unnoticed */
    refused("39999999999999999999,1,2,3,1,0,0,0\n", "nanoseconds");
}

TEST(poses_are_interpolated_within_a_bracket)
{
    trajectory t;
    parsed("1.0 0 0 0 0 0 0 1\n1.1 1 2 -4 0 0 0 -1\n2.0 5 5 5 0 0 0 1\n", &t);
    rigid pose;
    assert_true(trajectory_at(&t, 1025000000, &pose));
    assert_true(fabs(pose.position[0] - 0.25) < 1e-12 && fabs(pose.position[1] - 0.5) < 1e-12 &&
                fabs(pose.position[2] + 1) < 1e-12);
    assert_true(fabs(fabs(pose.rotation[0]) - 1) < 1e-12); /* q and -q: one rotation */
    assert_true(trajectory_at(&t, 2000000000, &pose) && pose.position[0] >= 5);
    assert_false(trajectory_at(&t, 1500000000, &pose)); /* neighbours too far apart */
    assert_false(trajectory_at(&t, 999999999, &pose));
    assert_false(trajectory_at(&t, 2000000001, &pose));
    trajectory_free(&t);
}

TEST(times_that_no_integer_holds_have_no_pose)
{
    trajectory_pose ends[2] = {{.stamp_ns = -(INT64_C(1) << 62), .pose = {{0}, {1}}},
                               {.stamp_ns = INT64_C(1) << 62, .pose = {{0}, {1}}}};
    const trajectory t = {.poses = ends, .count = 2, .kind = "bag"};
    rigid pose;
    assert_false(trajectory_at(&t, 0, &pose)); /* neighbours 2^63 ns apart */
    assert_true(trajectory_at_offset(&t, INT64_C(1) << 61, INT64_C(1) << 61, &pose));
    assert_false(trajectory_at_offset(&t, INT64_MAX, 1, &pose));
    assert_false(trajectory_at_offset(&t, INT64_MIN, -1, &pose));
}

enum { WIDTH = 80, HEIGHT = 60, FRAMES = 150 };
#define FOCAL 75.0
#define DISTANCE 3.0

/* The camera's direction and position at a time, in radians and metres. */
typedef struct motion {
    double yaw, pitch, x;
} motion;

static motion hand_held(double s)
{
    return (motion){0.12 * sin(1.3 * s) + 0.05 * sin(4.1 * s + 1), 0.06 * sin(1.9 * s + 2) + 0.03 * sin(5.3 * s),
                    0.15 * sin(0.8 * s + 0.5)};
}

static motion still(double s)
{
    (void)s;
    return (motion){0.1, 0, 0};
}

static motion shaking(double s) /* periodic with 0.4 s: the swings cannot be distinguished */
{
    return (motion){0.05 * sin(s * 5 * 3.141592653589793), 0, 0};
}

/* Returns a wall of smooth noise. */
static double wall(double x, double y)
{
    double v = 128;
    for (int i = 1; i <= 6; i++) {
        v += 14 * sin(x * 0.062 * i * (1 + 0.37 * (i % 3)) + i * 1.7) * cos(y * 0.054 * i * (1 + 0.29 * (i % 4)) + i);
    }
    return v;
}

static void picture(const motion *m, uint32_t frame, uint8_t pixels[HEIGHT][WIDTH])
{
    uint32_t noise = frame * 2654435761u + 1;
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            double u = (m->x / DISTANCE + tan(m->yaw)) * FOCAL + x, v = tan(m->pitch) * FOCAL + y;
            noise = noise * 1664525u + 1013904223u;
            double value = wall(u, v) + (double)(noise >> 28) - 8;
            pixels[y][x] = value < 0 ? 0 : value > 255 ? 255 : (uint8_t)value;
        }
    }
}

/* Makes poses at 100 Hz with a clock that is ahead; x right, y down: looking right is a rotation about y, looking up
 * one about x. */
static void track(motion (*path)(double), double ahead_s, trajectory *t)
{
    t->count = 800;
    t->poses = calloc(t->count, sizeof *t->poses);
    for (size_t i = 0; i < t->count; i++) {
        double s = (double)i * 0.01 - 1;
        motion m = path(s);
        double cy = cos(m.yaw / 2), sy = sin(m.yaw / 2), cx = cos(-m.pitch / 2), sx = sin(-m.pitch / 2);
        t->poses[i] = (trajectory_pose){.stamp_ns = (int64_t)llround((s + 2 + ahead_s) * 1e9),
                                        .pose = {{m.x, 0, 0}, {cy * cx, cy * sx, sy * cx, -sy * sx}}};
    }
}

static int estimate(motion (*path)(double), double ahead_s, double around_s, clock_offset *found, char *error)
{
    static uint8_t pixels[HEIGHT][WIDTH];
    clock_motion motions[FRAMES - 1];
    clock_picture pictures[2];
    trajectory t;
    for (uint32_t i = 0; i < FRAMES; i++) {
        motion m = path(i / 30.0);
        int64_t stamp = (int64_t)llround((i / 30.0 + 2) * 1e9);
        t3r_frame frame = {.format = T3R_PIXEL_GREY,
                           .width = WIDTH,
                           .height = HEIGHT,
                           .planes = {&pixels[0][0]},
                           .stride_bytes = {WIDTH}};
        picture(&m, i, pixels);
        clock_picture_of(&frame, &pictures[i & 1]);
        if (i > 0) {
            motions[i - 1] = (clock_motion){.from_ns = stamp - 33333333, .to_ns = stamp};
            clock_motion_of(&pictures[(i & 1) ^ 1], &pictures[i & 1], &motions[i - 1]);
        }
    }
    track(path, ahead_s, &t);
    int status =
        clock_offset_estimate(motions, FRAMES - 1, &t, (int64_t)llround(around_s * 1e9), 1000000000, found, error, 256);
    trajectory_free(&t);
    return status;
}

TEST(the_offset_of_clocks_is_found)
{
    static const double ahead[] = {0, 0.037, -0.25, 0.6, 1234.5};
    for (size_t i = 0; i < sizeof ahead / sizeof ahead[0]; i++) {
        clock_offset found;
        char error[256] = "";
        double around = ahead[i] > 100 ? 1234 : 0;
        if (estimate(hand_held, ahead[i], around, &found, error) != 0) {
            fail_msg("%g: %s", ahead[i], error);
        }
        double off_ms = ((double)found.offset_ns * 1e-9 - ahead[i]) * 1e3;
        if (fabs(off_ms) > 3) {
            fail_msg("%g s: off by %g ms, explains %g", ahead[i], off_ms, found.explained);
        }
        assert_true(found.explained > 0.8);
    }
}

TEST(an_offset_that_cannot_be_told_is_not)
{
    clock_offset found;
    char error[256] = "";
    assert_int_equal(estimate(still, 0, 0, &found, error), -1);
    assert_non_null(strstr(error, "hardly moves"));
    assert_int_equal(estimate(shaking, 0, 0, &found, error), -1);
    assert_non_null(strstr(error, "not clear"));
    assert_int_equal(estimate(hand_held, 0, 50, &found, error), -1);
    assert_non_null(strstr(error, "outside the trajectory"));
}
