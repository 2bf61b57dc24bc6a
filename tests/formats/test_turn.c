/* SPDX-License-Identifier: Apache-2.0 */
/* Turns of scenes between axes: positions, shapes and harmonics turn alike. */
#include <math.h>
#include <string.h>

#include "scene/scene_turn.h"
#include "test.h"

/* Returns the sum of the harmonics in a direction. */
static double seen(double rest[HARMONICS_REST_MOST][3], const double direction[3])
{
    double values[HARMONICS_REST_MOST], sum = 0;
    harmonics_of(direction, values);
    for (uint32_t i = 0; i < HARMONICS_REST_MOST; i++) {
        sum += values[i] * rest[i][1];
    }
    return sum;
}

static void fill(double rest[HARMONICS_REST_MOST][3])
{
    for (int i = 0; i < (int)HARMONICS_REST_MOST; i++) {
        for (int channel = 0; channel < 3; channel++) {
            rest[i][channel] = sin(1 + 3 * i + channel);
        }
    }
}

static void turn_vector(const scene_turn *turn, const double in[3], double out[3])
{
    double rotation[4] = {1, 0, 0, 0}, none[HARMONICS_REST_MOST][3];
    memcpy(out, in, 3 * sizeof *out);
    scene_turn_apply(turn, out, rotation, 0, none);
}

/* A turn keeps lengths, and a direction shows the same colour before and behind it. */
static void check_turn(const scene_turn *turn)
{
    const double *m = turn->matrix;
    const double determinant =
        m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
    assert_true(fabs(determinant - (turn->mirrors ? -1 : 1)) < 1e-12);
    static const double directions[][3] = {
        {0.6, 0.8, 0}, {0, 0.6, 0.8}, {-0.48, 0.64, 0.6}, {0.36, -0.48, 0.8}, {0, 0, -1}};
    for (size_t i = 0; i < sizeof directions / sizeof directions[0]; i++) {
        double before[HARMONICS_REST_MOST][3], behind[HARMONICS_REST_MOST][3], turned[3];
        double position[3] = {directions[i][0], directions[i][1], directions[i][2]}, rotation[4] = {1, 0, 0, 0};
        fill(before);
        fill(behind);
        turn_vector(turn, directions[i], turned);
        scene_turn_apply(turn, position, rotation, 3, behind);
        assert_true(fabs(seen(before, directions[i]) - seen(behind, turned)) < 1e-12);
        assert_memory_equal(position, turned, sizeof position);
        for (int k = 0; k < 4; k++) {
            assert_true(fabs(rotation[k]) == fabs(turn->rotation[k])); /* q and -q are one turn */
        }
    }
}

TEST(turns_all_alike)
{
    for (int axes = SCENE_AXES_AS_THEY_ARE; axes <= SCENE_AXES_LAST; axes++) {
        for (int up = T3R_UP_UNKNOWN; up <= T3R_UP_MZ; up++) {
            const scene_turn turn = scene_turn_between(SCENE_AXES_AS_THEY_ARE, (scene_axes)axes, (scene_up)up);
            check_turn(&turn);
        }
    }
}

/* Angles other than between axes. */
TEST(turns_by_any_angle)
{
    static const double rotations[][4] = {
        {0.5, 0.5, -0.5, 0.5}, {0.8, 0, 0.6, 0}, {0.1, -0.7, 0.1, 0.7}, {0.36, 0.48, 0, -0.8}, {1, 0, 0, 0}};
    for (size_t i = 0; i < sizeof rotations / sizeof rotations[0]; i++) {
        const scene_turn turn = scene_turn_of(rotations[i]);
        check_turn(&turn);
    }
}

TEST(points_up)
{
    static const struct {
        const char *name;
        double up[3];
    } ups[] = {{"x", {1, 0, 0}},   {"-x", {-1, 0, 0}}, {"y", {0, 1, 0}},
               {"-y", {0, -1, 0}}, {"z", {0, 0, 1}},   {"-z", {0, 0, -1}}};
    for (size_t i = 0; i < sizeof ups / sizeof ups[0]; i++) {
        const scene_up up = scene_up_named(ups[i].name);
        assert_int_not_equal(up, T3R_UP_UNKNOWN);
        static const scene_axes written[] = {SCENE_AXES_AS_THEY_ARE, SCENE_AXES_RUB, SCENE_AXES_LUF};
        for (int k = 0; k < 3; k++) {
            const scene_turn turn = scene_turn_between(SCENE_AXES_AS_THEY_ARE, written[k], up);
            double turned[3];
            turn_vector(&turn, ups[i].up, turned);
            assert_true(turned[0] == 0 && turned[1] == 1 && turned[2] == 0);
        }
    }
    assert_int_equal(scene_up_named("w"), T3R_UP_UNKNOWN);
    assert_int_equal(scene_up_named(""), T3R_UP_UNKNOWN);
}

/* Reading and writing a file changes nothing; without --up, a scene has x right, y down and z forward. */
TEST(knows_the_axes_of_formats)
{
    const double point[3] = {1, 2, 3}, rub[3] = {1, -2, -3}, luf[3] = {-1, -2, 3}, rbu[3] = {1, 3, 2},
                 ldb[3] = {-1, 2, -3};
    for (int axes = SCENE_AXES_AS_THEY_ARE; axes <= SCENE_AXES_LAST; axes++) {
        const scene_turn to = scene_turn_between(SCENE_AXES_AS_THEY_ARE, (scene_axes)axes, T3R_UP_UNKNOWN),
                         from = scene_turn_between((scene_axes)axes, SCENE_AXES_AS_THEY_ARE, T3R_UP_UNKNOWN);
        double there[3], back[3];
        turn_vector(&to, point, there);
        turn_vector(&from, there, back);
        assert_memory_equal(back, point, sizeof back);
        const double *want = axes == SCENE_AXES_RUB   ? rub
                             : axes == SCENE_AXES_LUF ? luf
                             : axes == SCENE_AXES_RBU ? rbu
                             : axes == SCENE_AXES_LDB ? ldb
                                                      : there;
        assert_memory_equal(there, want, sizeof there);
    }
    const int64_t origin[3] = {INT64_C(1) << 61, -5, 7};
    const scene_turn turn = scene_turn_between(SCENE_AXES_AS_THEY_ARE, SCENE_AXES_RUB, T3R_UP_UNKNOWN);
    int64_t turned[3];
    scene_turn_origin(&turn, origin, turned);
    assert_true(turned[0] == origin[0] && turned[1] == 5 && turned[2] == -7);
}
