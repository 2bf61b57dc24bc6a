/* SPDX-License-Identifier: Apache-2.0 */
/* Poses estimated on the built-in room against those that it was drawn from, and pairs of which nothing can be known.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/little_endian.h"
#include "posing/estimate.h"
#include "rigid_errors.h"
#include "room/room.h"
#include "test.h"

#define SIDE 256u
#define DEGREE (3.14159265358979323846 / 180)

typedef struct shot {
    uint32_t side;
    uint8_t *rgb, *depth; /* depth in millimetres, as t3r_frame has it; NULL = none */
    t3r_camera camera;
} shot;

static shot photograph_sized(uint32_t index, uint32_t side, bool depth)
{
    size_t pixels = (size_t)side * side;
    shot s = {.side = side, .rgb = malloc(pixels * 3), .depth = depth ? malloc(pixels * 2) : NULL};
    uint16_t *mm = malloc(pixels * sizeof *mm);
    room_frame(index, side, side, 1, s.rgb, mm);
    room_camera(index, side, side, &s.camera);
    for (size_t i = 0; i < pixels && depth; i++) {
        t3r_store_le16(s.depth + 2 * i, mm[i]);
    }
    free(mm);
    return s;
}

static shot photograph(uint32_t index, bool depth)
{
    return photograph_sized(index, SIDE, depth);
}

static void discard(shot *s)
{
    free(s->rgb);
    free(s->depth);
}

static pose_view view_of(const shot *s)
{
    t3r_frame frame = {.format = T3R_PIXEL_RGB24,
                       .width = s->side,
                       .height = s->side,
                       .planes = {s->rgb},
                       .stride_bytes = {s->side * 3},
                       .depth = s->depth,
                       .depth_width = s->depth != NULL ? s->side : 0,
                       .depth_height = s->depth != NULL ? s->side : 0,
                       .depth_stride_bytes = s->depth != NULL ? s->side * 2 : 0,
                       .depth_unit_q40 = s->depth != NULL ? ROOM_DEPTH_UNIT_Q40 : 0};
    pose_view view;
    char error[256] = "";
    if (pose_view_make(&frame, &s->camera, &view, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
    return view;
}

static rigid given(const t3r_camera *camera)
{
    rigid out;
    for (int i = 0; i < 4; i++) {
        out.rotation[i] = ldexp(camera->rotation_q30[i], -30);
    }
    quaternion_normalise(out.rotation);
    for (int i = 0; i < 3; i++) {
        out.position[i] = ldexp((double)camera->position_q32[i], -32);
    }
    return out;
}

/* b's camera in a's */
static rigid between(const t3r_camera *a, const t3r_camera *b)
{
    rigid first = given(a), second = given(b), back = rigid_inverse(&first);
    return rigid_compose(&back, &second);
}

static int estimate(shot *shots, uint32_t count, poses_source source, rigid *poses, pose_account *accounts,
                    char error[256])
{
    pose_view views[8];
    for (uint32_t i = 0; i < count; i++) {
        views[i] = view_of(&shots[i]);
    }
    error[0] = '\0';
    int status = poses_estimate(views, count, source, NULL, poses, accounts, error, 256);
    for (uint32_t i = 0; i < count; i++) {
        pose_view_free(&views[i]);
    }
    return status;
}

static void check_pair(uint32_t a, uint32_t b, bool depth, double turn_most, double direction_most)
{
    shot shots[2] = {photograph(a, depth), photograph(b, depth)};
    rigid poses[2];
    pose_account accounts[2];
    char error[256];
    if (estimate(shots, 2, POSES_ESTIMATE, poses, accounts, error) != 0) {
        fail_msg("%u, %u: %s", a, b, error);
    }
    rigid known = between(&shots[0].camera, &shots[1].camera);
    double turn = radians_turned(&poses[1], &known) / DEGREE;
    double direction = radians_between(poses[1].position, known.position) / DEGREE;
    double scale = length_of(poses[1].position) / length_of(known.position);
    if (turn > turn_most || direction > direction_most || (depth && fabs(scale - 1) > 0.03) ||
        (!depth && fabs(length_of(poses[1].position) - 1) > 1e-9)) {
        fail_msg("%u, %u: rotation %.3f, direction %.3f degrees off, scale %.4f", a, b, turn, direction, scale);
    }
    assert_true(accounts[1].metric == depth && accounts[1].matches > 100 && accounts[1].matches <= accounts[1].tried);
    assert_true(accounts[1].turn_degrees > turn / 5 && accounts[1].direction_degrees > direction / 8);
    discard(&shots[0]);
    discard(&shots[1]);
}

TEST(test_pairs_with_depth)
{
    check_pair(0, 1, true, 0.3, 3);
    check_pair(0, 2, true, 0.3, 2);
    check_pair(5, 1, true, 0.3, 2);
    check_pair(0, 5, true, 0.3, 2);
}

TEST(test_pairs_from_colour)
{
    check_pair(0, 1, false, 0.5, 4);
    check_pair(0, 2, false, 0.5, 4);
    check_pair(5, 2, false, 0.7, 4);
    check_pair(1, 4, false, 0.7, 4);
}

/* Small pictures are enlarged: too few features would be found otherwise. */
TEST(test_small_pictures)
{
    shot shots[2] = {photograph_sized(0, SIDE / 2, false), photograph_sized(3, SIDE / 2, false)};
    pose_view view = view_of(&shots[0]);
    assert_true(view.features.enlarged == 4 && view.features.count > 500);
    pose_view_free(&view);
    rigid poses[2], known = between(&shots[0].camera, &shots[1].camera);
    pose_account accounts[2];
    char error[256];
    if (estimate(shots, 2, POSES_ESTIMATE_COLOUR, poses, accounts, error) != 0) {
        fail_msg("%s", error);
    }
    double turn = radians_turned(&poses[1], &known) / DEGREE;
    double direction = radians_between(poses[1].position, known.position) / DEGREE;
    assert_true(turn < 0.6 && direction < 2.2); /* at their own size 0.9 and 2.6 */
    assert_true(accounts[1].turn_degrees > turn / 5 && accounts[1].direction_degrees > direction / 8);
    discard(&shots[0]);
    discard(&shots[1]);
}

/* Lengths of colour alone agree among views, by features that a third one shares. */
TEST(test_chain)
{
    enum { COUNT = 5 };
    for (int depth = 0; depth < 2; depth++) {
        shot shots[COUNT];
        rigid poses[COUNT], again[COUNT];
        pose_account accounts[COUNT];
        char error[256];
        for (uint32_t i = 0; i < COUNT; i++) {
            shots[i] = photograph(2 * i, depth == 1);
        }
        assert_int_equal(estimate(shots, COUNT, POSES_ESTIMATE, poses, accounts, error), 0);
        rigid last = between(&shots[0].camera, &shots[COUNT - 1].camera);
        double scale = depth == 1 ? 1 : length_of(last.position) / length_of(poses[COUNT - 1].position);
        for (uint32_t i = 1; i < COUNT; i++) {
            rigid known = between(&shots[0].camera, &shots[i].camera);
            double off = 0;
            for (int k = 0; k < 3; k++) {
                off += pow(scale * poses[i].position[k] - known.position[k], 2);
            }
            if (radians_turned(&poses[i], &known) > 1.0 * DEGREE || sqrt(off) > 0.06 * length_of(last.position)) {
                fail_msg("view %u: rotation %.3f degrees, place %.4f of %.4f off", i,
                         radians_turned(&poses[i], &known) / DEGREE, sqrt(off), length_of(last.position));
            }
            assert_true(accounts[i].from < COUNT && accounts[i].from != i);
        }
        assert_int_equal(estimate(shots, COUNT, POSES_ESTIMATE, again, accounts, error), 0);
        assert_memory_equal(poses, again, sizeof poses);
        for (uint32_t i = 0; i < COUNT; i++) {
            discard(&shots[i]);
        }
    }
}

/* From colour, depth only sets the scale. */
TEST(test_depth_for_scale)
{
    shot with[2] = {photograph(0, true), photograph(3, true)},
         without[2] = {photograph(0, false), photograph(3, false)};
    rigid a[2], b[2];
    pose_account accounts[2];
    char error[256];
    assert_int_equal(estimate(with, 2, POSES_ESTIMATE_COLOUR, a, accounts, error), 0);
    assert_false(accounts[1].metric);
    assert_int_equal(estimate(without, 2, POSES_ESTIMATE, b, accounts, error), 0);
    assert_memory_equal(a[1].rotation, b[1].rotation, sizeof a[1].rotation);
    assert_true(radians_between(a[1].position, b[1].position) < 1e-7);
    rigid known = between(&with[0].camera, &with[1].camera);
    assert_true(fabs(length_of(a[1].position) / length_of(known.position) - 1) < 0.05);
    for (int i = 0; i < 2; i++) {
        discard(&with[i]);
        discard(&without[i]);
    }
}

/* A camera held upright: its picture turned by a quarter. */
TEST(test_turned_camera)
{
    shot shots[2] = {photograph(0, false), photograph(3, false)};
    rigid known = between(&shots[0].camera, &shots[1].camera), poses[2];
    uint8_t *turned = malloc(SIDE * SIDE * 3);
    for (uint32_t y = 0; y < SIDE; y++) {
        for (uint32_t x = 0; x < SIDE; x++) {
            memcpy(turned + 3 * (x * SIDE + (SIDE - 1 - y)), shots[1].rgb + 3 * (y * SIDE + x), 3);
        }
    }
    free(shots[1].rgb);
    shots[1].rgb = turned;
    /* the new picture's x is the old one's -y, its y the old one's x */
    const rigid roll = rotation_about((const double[3]){0, 0, -90 * DEGREE}), expected = rigid_compose(&known, &roll);
    pose_account accounts[2];
    char error[256];
    if (estimate(shots, 2, POSES_ESTIMATE, poses, accounts, error) != 0) {
        fail_msg("%s", error);
    }
    assert_true(radians_turned(&poses[1], &expected) < 1.0 * DEGREE);
    assert_true(radians_between(poses[1].position, expected.position) < 5 * DEGREE);
    discard(&shots[0]);
    discard(&shots[1]);
}

/* ---- what cannot be told ---------------------------------------------------------------------------------------- */

static void refuse(shot *shots, poses_source source, const char *why)
{
    rigid poses[2];
    pose_account accounts[2];
    char error[256];
    int status = estimate(shots, 2, source, poses, accounts, error);
    if (status == 0 || strstr(error, why) == NULL || strstr(error, "frame 1 cannot be posed from frame 0") == NULL) {
        fail_msg("status %d, '%s' does not say '%s'", status, error, why);
    }
}

/* Turns the camera by q alone: each new pixel takes the picture's colour along the turned ray. */
static void turn_picture(shot *s, const double q[4])
{
    uint8_t *out = malloc(SIDE * SIDE * 3);
    double f = ldexp(s->camera.fx_q16, -16), c = (SIDE - 1) / 2.0;
    for (uint32_t y = 0; y < SIDE; y++) {
        for (uint32_t x = 0; x < SIDE; x++) {
            const double ray[3] = {(x - c) / f, (y - c) / f, 1};
            double p[3];
            quaternion_rotate(q, ray, p);
            double u = fmin(fmax(f * p[0] / p[2] + c, 0), SIDE - 2), v = fmin(fmax(f * p[1] / p[2] + c, 0), SIDE - 2);
            uint32_t left = (uint32_t)u, top = (uint32_t)v;
            for (uint32_t k = 0; k < 3; k++) {
                const uint8_t *at = s->rgb + 3 * (top * SIDE + left) + k;
                double a = at[0] + (u - left) * (at[3] - at[0]);
                double b = at[3 * SIDE] + (u - left) * (at[3 * SIDE + 3] - at[3 * SIDE]);
                out[3 * (y * SIDE + x) + k] = (uint8_t)(a + (v - top) * (b - a) + 0.5);
            }
        }
    }
    free(s->rgb);
    s->rgb = out;
}

TEST(test_turning_alone_is_refused)
{
    shot shots[2] = {photograph(0, false), photograph(0, false)};
    refuse(shots, POSES_ESTIMATE, "no parallax");
    turn_picture(&shots[1], rotation_about((const double[3]){0.02, 0.08, 0.03}).rotation);
    refuse(shots, POSES_ESTIMATE, "no parallax");
    discard(&shots[0]);
    discard(&shots[1]);
}

/* With depth a turn is a pose like any other. */
TEST(test_standing_still_with_depth)
{
    shot shots[2] = {photograph(0, true), photograph(0, true)};
    rigid poses[2];
    pose_account accounts[2];
    char error[256];
    assert_int_equal(estimate(shots, 2, POSES_ESTIMATE, poses, accounts, error), 0);
    assert_true(radians_turned(&poses[1], &rigid_identity) < 1e-3 * DEGREE && length_of(poses[1].position) < 1e-4);
    discard(&shots[0]);
    discard(&shots[1]);
}

TEST(test_other_places_are_refused)
{
    shot shots[2] = {photograph(0, true), photograph(1, true)};
    uint32_t noise = 1;
    for (size_t i = 0; i < SIDE * SIDE * 3; i++) {
        noise = noise * 1664525u + 1013904223u;
        shots[1].rgb[i] = (uint8_t)(noise >> 24);
    }
    refuse(shots, POSES_ESTIMATE, "features");
    refuse(shots, POSES_ESTIMATE_COLOUR, "features");
    memset(shots[1].rgb, 100, SIDE * SIDE * 3);
    refuse(shots, POSES_ESTIMATE, "only 0 features match");
    discard(&shots[0]);
    discard(&shots[1]);
}

/* A depth camera that gives nothing in one view leaves colour and the other's scale; false depth is not believed. */
TEST(test_missing_and_false_depth)
{
    shot shots[2] = {photograph(0, true), photograph(2, true)};
    rigid poses[2], known = between(&shots[0].camera, &shots[1].camera);
    pose_account accounts[2];
    char error[256];
    memset(shots[1].depth, 0, SIDE * SIDE * 2);
    assert_int_equal(estimate(shots, 2, POSES_ESTIMATE, poses, accounts, error), 0);
    assert_false(accounts[1].metric);
    assert_true(fabs(length_of(poses[1].position) / length_of(known.position) - 1) < 0.05);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        t3r_store_le16(shots[1].depth + 2 * (size_t)i, 900);
    }
    refuse(shots, POSES_ESTIMATE, "agree on a motion");
    discard(&shots[0]);
    discard(&shots[1]);
}
