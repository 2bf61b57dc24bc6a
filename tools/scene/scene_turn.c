/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_turn.h"

#include <math.h>
#include <string.h>

#include "geometry/quaternion.h"

/* Rotations that turn each axis to -y, which points up in scenes whose y points down. */
static const struct {
    const char *name;
    double rotation[4];
} ups[] = {
    [T3R_UP_UNKNOWN] = {"", {1, 0, 0, 0}},
    [T3R_UP_X] = {"x", {M_SQRT1_2, 0, 0, -M_SQRT1_2}},
    [T3R_UP_MX] = {"-x", {M_SQRT1_2, 0, 0, M_SQRT1_2}},
    [T3R_UP_Y] = {"y", {0, 1, 0, 0}},
    [T3R_UP_MY] = {"-y", {1, 0, 0, 0}},
    [T3R_UP_Z] = {"z", {M_SQRT1_2, M_SQRT1_2, 0, 0}},
    [T3R_UP_MZ] = {"-z", {M_SQRT1_2, -M_SQRT1_2, 0, 0}},
};

/* Returns the turn by a matrix that rotates, or rotates and mirrors. */
static scene_turn turn_of(const double matrix[9])
{
    scene_turn turn = {.mirrors = matrix_determinant(matrix) < 0};
    double proper[9];
    memcpy(turn.matrix, matrix, sizeof turn.matrix);
    for (int i = 0; i < 9; i++) {
        proper[i] = turn.mirrors ? -matrix[i] : matrix[i];
    }
    quaternion_of_rotation(proper, turn.rotation);
    turn.none = matrix[0] == 1 && matrix[4] == 1 && matrix[8] == 1;
    turn.harmonics = harmonics_turn_of(proper);
    return turn;
}

scene_turn scene_turn_of(const double rotation[4])
{
    double matrix[9];
    quaternion_matrix(rotation, matrix);
    return turn_of(matrix);
}

/* Writes the matrix from the axes of a file to x right, y down, z forward. */
static void matrix_from(scene_axes axes, double matrix[9])
{
    const bool is_turned = axes >= SCENE_AXES_LFD; /* about x, from the axes with the number 8 less */
    const unsigned bits = ((unsigned)(axes == SCENE_AXES_AS_THEY_ARE ? SCENE_AXES_RDF : axes) - 1) & 7;
    const double right = bits & 1 ? 1 : -1, down = bits & 2 ? -1 : 1, forward = bits & 4 ? 1 : -1;
    const double plain[9] = {right, 0, 0, 0, down, 0, 0, 0, forward};
    const double turned[9] = {right, 0, 0, 0, 0, forward, 0, -down, 0};
    memcpy(matrix, is_turned ? turned : plain, sizeof plain);
}

static void multiply(const double a[9], const double b[9], double out[9])
{
    for (int i = 0; i < 9; i++) {
        out[i] = a[i / 3 * 3] * b[i % 3] + a[i / 3 * 3 + 1] * b[i % 3 + 3] + a[i / 3 * 3 + 2] * b[i % 3 + 6];
    }
}

scene_turn scene_turn_between(scene_axes from, scene_axes to, scene_up up)
{
    const bool bare = to == SCENE_AXES_AS_THEY_ARE && up != T3R_UP_UNKNOWN;
    double read[9], upright[9], write[9], back[9], both[9], all[9];
    matrix_from(from, read);
    quaternion_matrix(ups[up].rotation, upright);
    matrix_from(bare ? SCENE_AXES_RUB : to, write);
    for (int i = 0; i < 9; i++) {
        back[i] = write[i % 3 * 3 + i / 3]; /* transposed: the inverse */
    }
    multiply(upright, read, both);
    multiply(back, both, all);
    for (int i = 0; i < 9; i++) {
        all[i] = nearbyint(all[i]);
    }
    return turn_of(all);
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
    for (uint32_t i = 0; turn->mirrors && i < harmonics_rest(degree); i++) {
        const bool is_odd = i < harmonics_rest(1) || i >= harmonics_rest(2); /* degrees 1 and 3 change sign */
        for (int channel = 0; is_odd && channel < 3; channel++) {
            rest[i][channel] = -rest[i][channel];
        }
    }
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

const char *scene_up_name(scene_up up)
{
    return ups[up].name;
}

scene_up scene_up_named(const char *name)
{
    for (int i = T3R_UP_X; i <= T3R_UP_MZ; i++) {
        if (strcmp(ups[i].name, name) == 0) {
            return (scene_up)i;
        }
    }
    return T3R_UP_UNKNOWN;
}
