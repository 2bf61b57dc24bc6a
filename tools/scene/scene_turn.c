/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_turn.h"

#include <math.h>
#include <string.h>

#include "geometry/quaternion.h"

/* Quaternions w x y z. */
static const double stays[4] = {1, 0, 0, 0};
static const double half_about_x[4] = {0, 1, 0, 0}; /* x, -y, -z */
static const double half_about_z[4] = {0, 0, 0, 1}; /* -x, -y, z */

/* Rotations that turn each axis to -y, which points up in scenes whose y points down. */
static const struct {
    const char *name;
    double rotation[4];
} ups[] = {
    [SCENE_UP_UNKNOWN] = {"", {1, 0, 0, 0}},
    [SCENE_UP_X] = {"x", {M_SQRT1_2, 0, 0, -M_SQRT1_2}},
    [SCENE_UP_MX] = {"-x", {M_SQRT1_2, 0, 0, M_SQRT1_2}},
    [SCENE_UP_Y] = {"y", {0, 1, 0, 0}},
    [SCENE_UP_MY] = {"-y", {1, 0, 0, 0}},
    [SCENE_UP_Z] = {"z", {M_SQRT1_2, M_SQRT1_2, 0, 0}},
    [SCENE_UP_MZ] = {"-z", {M_SQRT1_2, -M_SQRT1_2, 0, 0}},
};

static scene_turn turn_of(const double q[4], const double matrix[9])
{
    scene_turn turn = {.rotation = {q[0], q[1], q[2], q[3]}};
    memcpy(turn.matrix, matrix, sizeof turn.matrix);
    turn.none = turn.matrix[0] == 1 && turn.matrix[4] == 1;
    turn.harmonics = harmonics_turn_of(turn.matrix);
    return turn;
}

/* Returns a turn between axes: the entries of its matrix are whole numbers. */
static scene_turn axes_turn(const double q[4])
{
    double matrix[9];
    quaternion_matrix(q, matrix);
    for (int i = 0; i < 9; i++) {
        matrix[i] = nearbyint(matrix[i]);
    }
    return turn_of(q, matrix);
}

scene_turn scene_turn_of(const double rotation[4])
{
    double matrix[9];
    quaternion_matrix(rotation, matrix);
    return turn_of(rotation, matrix);
}

static const double *from_scene(scene_axes axes)
{
    return axes == SCENE_AXES_RUB ? half_about_x : axes == SCENE_AXES_LUF ? half_about_z : stays;
}

scene_turn scene_turn_between(scene_axes from, scene_axes to, scene_up up)
{
    double turned[4], all[4];
    const bool bare = to == SCENE_AXES_AS_THEY_ARE && up != SCENE_UP_UNKNOWN;
    quaternion_multiply(ups[up].rotation, from_scene(from), turned); /* a half turn is its own inverse */
    quaternion_multiply(bare ? half_about_x : from_scene(to), turned, all);
    return axes_turn(all);
}

void scene_turn_apply(const scene_turn *turn, double position[3], double rotation[4], uint32_t degree,
                      double rest[HARMONICS_REST_MOST][3])
{
    if (turn->none) {
        return;
    }
    const double p[3] = {position[0], position[1], position[2]};
    const double q[4] = {rotation[0], rotation[1], rotation[2], rotation[3]};
    matrix_apply(turn->matrix, p, position);
    quaternion_multiply(turn->rotation, q, rotation);
    harmonics_turn_apply(&turn->harmonics, degree, rest);
}

void scene_turn_origin(const scene_turn *turn, const int64_t origin_q32[3], int64_t turned_q32[3])
{
    for (int axis = 0; axis < 3; axis++) {
        turned_q32[axis] = 0;
        for (int i = 0; i < 3; i++) {
            turned_q32[axis] += (int64_t)turn->matrix[3 * axis + i] * origin_q32[i];
        }
    }
}

scene_up scene_up_named(const char *name)
{
    for (int i = SCENE_UP_X; i <= SCENE_UP_MZ; i++) {
        if (strcmp(ups[i].name, name) == 0) {
            return (scene_up)i;
        }
    }
    return SCENE_UP_UNKNOWN;
}
